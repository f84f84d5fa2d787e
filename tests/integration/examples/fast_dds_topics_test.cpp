// `constrictor topic` on topics that a process on Fast DDS writes. It announces no type information, as the contract in
// idl/CLIENTS.md prescribes for programs of others.
#include "cyclone/domain_claim.hpp"
#include "example_run.hpp"

namespace constrictor::testing {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

class FastDdsTopics : public ExampleRun {
 protected:
  /// Runs `constrictor topic` in the domain of the plant, and returns its standard output as JSON.
  json topic(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {std::string(CONSTRICTOR_PREFIX) + "/bin/constrictor", "topic"});
    arguments.insert(arguments.end(), {"--json", "--run", std::to_string(claim_.domain())});
    Process process(std::move(arguments));
    const auto status = process.wait(30s);
    output_ = process.output() + process.errors();
    EXPECT_EQ(status, 0) << output_;
    return json::parse(process.output(), nullptr, false);
  }

  static constexpr int kJoints = 22;
  const DomainClaim claim_;
  // It writes 100 samples in a second of each of its two topics.
  Process plant_{
      {example("fastdds_plant"), "--domain", std::to_string(claim_.domain()), "--joints", std::to_string(kJoints)}};
  std::string output_;
};

TEST_F(FastDdsTopics, EchoShowsTheFieldsOfATopicOfTheTable) {
  const json state = topic({"echo", "hardware/joint_state", "--count", "1", "--full"});
  ASSERT_TRUE(state.is_object()) << output_;
  EXPECT_EQ(state["robot_id"], 1);
  EXPECT_EQ(state["joint_count"], kJoints);
  EXPECT_GT(state["sequence_number"], 0);
  EXPECT_EQ(state["fault"], "");
  const json imu = topic({"echo", "hardware/imu_state", "--count", "1"});
  ASSERT_TRUE(imu.is_object()) << output_;
  EXPECT_EQ(imu["orientation"], json::parse(R"({"w":1.0,"x":0.0,"y":0.0,"z":0.0})"));
  EXPECT_EQ(imu["linear_acceleration_m_s2"]["z"], 9.81);
}

TEST_F(FastDdsTopics, HzMeasuresSeveralTopics) {
  const json rates = topic({"hz", "hardware/joint_state", "hardware/imu_state", "--for", "1"});
  ASSERT_EQ(rates.size(), 2u) << output_;
  for (const json& rate : rates) {
    EXPECT_GT(rate["rate_hz"].get<double>(), 20.0) << rate;  // fewer on a busy machine
    EXPECT_LT(rate["rate_hz"].get<double>(), 110.0) << rate;
  }
}

TEST_F(FastDdsTopics, BwMeasuresTheBytesOfAMessage) {
  // By the rules of CDR: 4 bytes before the message; the key (2, aligned to 8); 3 numbers of 8; 10 doubles.
  constexpr int kImu_bytes = 4 + 8 + 3 * 8 + 10 * 8;
  const json bytes = topic({"bw", "hardware/imu_state", "--for", "1"});
  ASSERT_TRUE(bytes.is_object()) << output_;
  EXPECT_EQ(bytes["least_bytes"], kImu_bytes) << bytes;
  EXPECT_EQ(bytes["greatest_bytes"], kImu_bytes) << bytes;
  EXPECT_GT(bytes["bytes_per_s"].get<double>(), 20.0 * kImu_bytes) << bytes;
  EXPECT_LT(bytes["bytes_per_s"].get<double>(), 110.0 * kImu_bytes) << bytes;
}

TEST_F(FastDdsTopics, ListHasTheTopic) {
  const json topics = topic({"list"});
  const auto named = std::find_if(topics.begin(), topics.end(),
                                  [](const json& entry) { return entry["topic"] == "hardware/joint_state"; });
  ASSERT_NE(named, topics.end()) << output_;
}

}  // namespace
}  // namespace constrictor::testing
