// The commands `topic echo`, `hz`, `bw`, `find` and `pub` with real processes.
#include <signal.h>

#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "introspection_fixture.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

TEST_F(Introspection, EchoWithACountBeginsWithTheNewestSampleThatTheWriterKeeps) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  const dds::Domain domain(claim.domain());
  const dds::Writer<msg::TaskStatus> writer(domain.participant(), "task/status", 16);
  msg::TaskStatus status{};
  for (status.header.tick = 1; status.header.tick <= 10; ++status.header.tick) writer.write(status);
  EXPECT_EQ(command({"topic", "echo", "task/status", "-n", "1", "--field", "header.tick", "--run", number}), 0);
  EXPECT_EQ(output_, "10\n");
  // Without a count, the samples that are kept come first.
  Process echo = start({"topic", "echo", "task/status", "--field", "header.tick", "--run", number});
  EXPECT_TRUE(echo.wait_for("9\n10\n", 20s)) << echo.output() << echo.errors();
  EXPECT_EQ(echo.output(), "1\n2\n3\n4\n5\n6\n7\n8\n9\n10\n");
  echo.signal(SIGINT);
  EXPECT_EQ(echo.wait(10s), 0);
}

// `constrictor task` names a goal by the number that its source gave it.
TEST_F(Introspection, EchoNamesGoalsAsTheTaskCommandDoes) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  const dds::Domain domain(claim.domain());
  const dds::Writer<msg::TaskStatus> writer(domain.participant(), "task/status", 16);
  msg::TaskStatus status{};
  status.goal_id = 844'424'930'131'970;  // 3 * 2^48 + 2
  static_assert(msg::kAuthorityOperator == 3);
  writer.write(status);
  const std::vector<std::string> echo = {"topic", "echo", "task/status", "-n", "1", "--run", number};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), echo.begin(), echo.end());
    return more;
  };
  EXPECT_EQ(command(echo), 0);
  EXPECT_NE(output_.find("\ngoal_id: 844424930131970, goal 2\n"), std::string::npos) << output_;
  // Scripts and filters use the whole id.
  EXPECT_EQ(command(with({"--field", "goal_id"})), 0);
  EXPECT_EQ(output_, "844424930131970\n");
  EXPECT_EQ(command(with({"--filter", "goal_id == 844424930131970", "--json"})), 0);
  EXPECT_EQ(json::parse(output_, nullptr, false)["goal_id"], status.goal_id) << output_;
}

TEST_F(Introspection, EchoFiltersRoundsAndSummarises) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  const dds::Domain domain(claim.domain());
  const dds::Writer<msg::ObjectPercepts> percepts(domain.participant(), "perception/objects", 16);
  msg::ObjectPercepts message{};
  message.blob_count = 2;
  message.blobs[0].colour = msg::kColourRed;
  message.blobs[1].range_m = 1.23456;
  for (message.header.tick = 1; message.header.tick <= 9; ++message.header.tick) {
    message.blobs[1].colour = message.header.tick == 4 ? msg::kColourGreen : msg::kColourBlue;
    percepts.write(message);
  }
  Process echo = start({"topic", "echo", "perception/objects", "--filter", "blobs.*.colour == green", "--precision",
                        "2", "--run", number});
  EXPECT_TRUE(echo.wait_for("range_m: 1.23\n", 20s)) << echo.output() << echo.errors();
  EXPECT_TRUE(echo.wait_for("---\n", 20s));
  EXPECT_NE(echo.output().find("  tick: 4\n"), std::string::npos) << echo.output();
  EXPECT_EQ(echo.output().find("  tick: 5\n"), std::string::npos) << echo.output();
  echo.signal(SIGINT);
  EXPECT_EQ(echo.wait(10s), 0);
  EXPECT_EQ(command({"topic", "echo", "perception/objects", "-n", "1", "--no-arr", "--run", number}), 0);
  EXPECT_NE(output_.find("\nblobs: <2 values>\n"), std::string::npos) << output_;
  EXPECT_EQ(command({"topic", "echo", "perception/objects", "--filter", "blob_cnt > 1", "--run", number}), 64);
  EXPECT_NE(output_.find("there is no field 'blob_cnt', did you mean 'blob_count'?"), std::string::npos) << output_;
  EXPECT_EQ(command({"topic", "echo", "perception/objects", "--filter", "blob_count >", "--run", number}), 64);
  EXPECT_EQ(command({"topic", "echo", "perception/objects", "--field", "header.tik", "--run", number}), 64);
  EXPECT_NE(output_.find("found 'tik', accepted "), std::string::npos) << output_;
  EXPECT_NE(output_.find(", did you mean 'tick'?"), std::string::npos) << output_;

  const dds::Writer<msg::CameraImage> images(domain.participant(), "camera/image", 4);
  std::vector<std::uint8_t> pixels(2 * 3 * 3, 200);
  msg::CameraImage image{};
  image.width = 2;
  image.height = 3;
  image.data = {18, 18, pixels.data(), false};
  images.write(image);
  const json summary = json_of({"topic", "echo", "camera/image", "-n", "1", "--run", number});
  EXPECT_EQ(summary["data"]["bytes"], 18) << output_;
  EXPECT_EQ(summary["data"]["encoding"], "RGB, 8 bit, rows from the top");
  EXPECT_EQ(summary["data"]["sha256"].get<std::string>().size(), 64u);
  const json whole = json_of({"topic", "echo", "camera/image", "-n", "1", "--full", "--run", number});
  EXPECT_EQ(whole["data"], json(std::vector<int>(18, 200)));
}

TEST_F(Introspection, MeasuresSeveralTopicsInWallTimeAndInTheRobotsTime) {
  Process run = toys();
  const auto paused = [&] { return json_of({"topic", "echo", "run_state", "-n", "1"}).value("paused", false); };
  const json rates = json_of({"topic", "hz", "joint_state", "run_state", "--for", "1.2"});
  ASSERT_EQ(rates.size(), 2u) << output_;
  EXPECT_EQ(rates[0]["topic"], "joint_state");
  // The plant writes a sample at each tick of 20 ms, however fast or slow this machine makes the ticks.
  EXPECT_NEAR(rates[0]["robot_rate_hz"].get<double>(), 50.0, 1e-6);
  EXPECT_GT(rates[0]["rate_hz"].get<double>(), 10.0);
  EXPECT_TRUE(rates[1]["robot_rate_hz"].is_null()) << "run_state has no header: " << rates[1];
  const json bytes = json_of({"topic", "bw", "joint_state", "--for", "0.5"});
  EXPECT_NEAR(bytes["bytes_per_robot_s"].get<double>(), 50.0 * bytes["least_bytes"].get<double>(), 1e-3) << bytes;
  EXPECT_EQ(command({"topic", "hz", "joint_state", "joint_sate"}), 70);

  EXPECT_EQ(command({"topic", "find", "JointState"}), 0);
  EXPECT_EQ(output_, "joint_state\n");
  EXPECT_EQ(json_of({"topic", "find", "constrictor::msg::JointState"})[0]["topic"], "joint_state");
  EXPECT_EQ(command({"topic", "find", "JointStat"}), 1);
  EXPECT_NE(output_.find("did you mean 'JointState'?"), std::string::npos) << output_;

  // What belongs to the run is refused; a command of a client is checked by the run.
  EXPECT_EQ(command({"topic", "pub", "joint_command", "{joint_count: 23}"}), 70);
  EXPECT_NE(output_.find("belongs to control of the run"), std::string::npos) << output_;
  EXPECT_EQ(command({"topic", "pub", "barrier/tick"}), 70);
  EXPECT_EQ(command({"topic", "pub", "run_control/v2", "{command: paus}"}), 64);
  EXPECT_NE(output_.find("command: found \"paus\", accepted pause, resume"), std::string::npos) << output_;
  EXPECT_EQ(command({"topic", "pub", "run_control/v2", "{command: pause, token: guessed}"}), 0);
  const json refused = json_of({"topic", "echo", "run_control/answer", "-n", "1"});
  EXPECT_NE(refused["refusal"].get<std::string>().find("token"), std::string::npos) << refused;
  EXPECT_FALSE(paused()) << output_;
  EXPECT_EQ(command({"topic", "pub", "run_control/v2", R"({"command": "pause"})"}), 0) << output_;
  EXPECT_TRUE(eventually(paused)) << output_;
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

TEST_F(Introspection, PublishesOnATopicOfAnotherProgram) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  EXPECT_EQ(command({"topic", "pub", "posture", "{}", "--run", number}), 70);
  EXPECT_NE(output_.find("a new topic needs the name of its type (--type TYPE)"), std::string::npos) << output_;
  EXPECT_EQ(command({"topic", "pub", "posture", "{}", "--type", "JointState", "--wait", "0.3", "--run", number}), 1);
  EXPECT_NE(output_.find("no reader of 'posture'"), std::string::npos) << output_;
  const dds::Domain domain(claim.domain());
  const auto reader = dds::Reader<msg::JointState>::member(domain.participant(), "posture");
  std::vector<msg::JointState> got;
  const auto arrived = [&](std::size_t count) {
    return eventually([&] {
      reader.take([&](const msg::JointState& state) { got.push_back(state); });
      return got.size() >= count;
    });
  };
  // The type is that of the reader.
  write("message.yaml", "robot_id: 3\nposition_rad: [0.25, -1]\n");
  EXPECT_EQ(command({"topic", "pub", "posture", "--file", (dir_ / "message.yaml").string(), "--run", number}), 0)
      << output_;
  EXPECT_EQ(output_, "published on posture for 1 reader\n");
  ASSERT_TRUE(arrived(1));
  EXPECT_EQ(got[0].robot_id, 3);
  EXPECT_EQ(got[0].joint_count, 2);
  EXPECT_EQ(got[0].position_rad[1], -1.0);
  EXPECT_EQ(command({"topic", "pub", "posture", "{robot_id: 4}", "--rate", "50", "--count", "5", "--run", number}), 0);
  EXPECT_TRUE(arrived(6));
  EXPECT_EQ(got.size(), 6u);
  EXPECT_EQ(command({"topic", "pub", "posture", "{joint_count: 65}", "--run", number}), 64);
  EXPECT_NE(output_.find("joint_count: found 65, accepted a whole number from 0 to 64"), std::string::npos) << output_;
  EXPECT_EQ(command({"topic", "pub", "posture", "{joint_count: 1}", "--check", "--run", number}), 0);
  EXPECT_NE(output_.find("joint_count: 1\nposition_rad: [0.0]\n"), std::string::npos) << output_;
  EXPECT_EQ(got.size(), 6u);
}

}  // namespace
}  // namespace constrictor::testing
