// An operator and an external planner send 10,000 requests at the same time, over DDS, to a running robot. `input`
// never obeys both. unit/input/two_writers.hpp checks the order of the messages that `input` wrote.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <random>
#include <thread>

#include "client/request_writer.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/run_token.hpp"
#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"
#include "unit/input/two_writers.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

constexpr unsigned kSeed = 20261121;
constexpr std::uint64_t kEach = 5000;
constexpr std::uint64_t kUnanswered = 9;  // most unanswered requests of a source; `input` latches up to twelve
constexpr double kMaxSpeed_rad_s = 4.0;   // of Mamba's joints (components/lib/robot/mamba.yaml)

template <class T>
dds::Reader<T> reader(dds_entity_t participant, const Topic<T>& topic) {
  return dds::Reader<T>::member(participant, std::string(topic.name));
}

/// A client with a participant, a writer of requests and a thread of its own.
class Program {
 public:
  Program(std::uint32_t domain, std::string name, std::uint8_t level, std::string token)
      : participant_(dds_create_participant(domain, nullptr, nullptr), "dds_create_participant"),
        writer_(participant_.get(), 0),
        answers_(reader(participant_.get(), topics::kRequestAnswer)),
        name_(std::move(name)),
        level_(level),
        token_(std::move(token)),
        random_(kSeed + level) {}
  ~Program() {
    give_up_ = true;
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] bool heard() const { return writer_.heard() && answers_.writers() > 0; }
  void start() {
    thread_ = std::thread([this] { send_requests(); });
  }
  [[nodiscard]] std::uint64_t answered() const { return answered_; }
  [[nodiscard]] const std::vector<msg::Request>& asked() const { return asked_; }  ///< complete after all answers

 private:
  msg::Request next() {
    msg::Request r{};
    r.robot_id = 1;
    dds::set_text(r.source, name_);
    r.header.sequence_number = asked_.size() + 1;
    r.level = level_;
    dds::set_text(r.token, token_);
    const bool operates = level_ == msg::kAuthorityOperator;
    r.kind = random_() % 8 == 0 ? msg::kRequestTask : msg::kRequestMotion;
    if (operates && random_() % 20 == 0) r.kind = msg::kRequestRelease;
    r.task = msg::kTaskRotate;
    r.parameters.direction = operates ? msg::kDirectionLeft : msg::kDirectionRight;
    r.parameters.timeout_s = 1.0;
    r.motion = msg::kMotionDrive;
    r.speed_m_s = operates ? 0.6 : -0.6;
    return r;
  }
  void send_requests() {
    while (!give_up_ && answered_ < kEach) {
      answers_.take([this](const msg::RequestAnswer& m) { answered_ += name_ == m.source; });
      if (asked_.size() < kEach && asked_.size() - answered_ < kUnanswered) {
        asked_.push_back(next());
        writer_.write(asked_.back());
      } else {
        std::this_thread::sleep_for(1ms);
      }
    }
  }
  dds::Entity participant_;
  RequestWriter writer_;
  dds::Reader<msg::RequestAnswer> answers_;
  std::string name_;
  std::uint8_t level_;
  std::string token_;
  std::mt19937 random_;
  std::vector<msg::Request> asked_;
  std::atomic<std::uint64_t> answered_{0};
  std::atomic<bool> give_up_{false};
  std::thread thread_;
};

class TwoWritersOverDds : public CliFixture {
 protected:
  /// Expects that no setpoint moves faster than its joint can, except to the measured angle at a takeover, and that no
  /// joint exceeds its maximum speed.
  static void expect_smooth(const std::map<std::int64_t, msg::JointCommand>& commands,
                            const std::map<std::int64_t, msg::JointState>& joints) {
    constexpr double kStep_rad = kMaxSpeed_rad_s * 0.02 + 1e-6;
    int judged = 0;
    for (auto b = commands.begin(); b != commands.end(); ++b) {
      const auto a = commands.find(b->first - 1);
      const auto state = joints.find(b->first);
      if (a == commands.end() || state == joints.end()) continue;
      ++judged;
      for (int j = 0; j < b->second.joint_count; ++j) {
        const double now_rad = b->second.position_rad[j];
        const double from_before_rad = std::abs(now_rad - a->second.position_rad[j]);
        ASSERT_LE(std::min(from_before_rad, std::abs(now_rad - state->second.position_rad[j])), kStep_rad)
            << "tick " << b->first << " joint " << j;
        ASSERT_LE(std::abs(state->second.velocity_rad_s[j]), kMaxSpeed_rad_s) << "tick " << b->first << " joint " << j;
      }
    }
    EXPECT_GT(judged, 200);
  }
};

TEST_F(TwoWritersOverDds, InputNeverObeysBothInTenThousandRequests) {
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  write("blind.yaml",  // a run without camera and perception
        case_study_manifest(20, kBlindProcesses));
  Process launcher =
      start({"run", "--manifest", (dir_ / "blind.yaml").string(), "--report", (dir_ / "r").string(), "--pace", "4x"});
  ASSERT_TRUE(launcher.wait_for("simulated", 30s)) << launcher.output() << launcher.errors();
  const dds::Domain observer(domain());
  const auto authority = reader(observer.participant(), topics::kAuthority);
  const auto answers = reader(observer.participant(), topics::kRequestAnswer);
  const auto tasks = reader(observer.participant(), topics::kTaskCommand);
  const auto motions = reader(observer.participant(), topics::kMotionCommand);
  const auto commands = reader(observer.participant(), topics::kJointCommand);
  const auto joints = reader(observer.participant(), topics::kJointState);
  TwoWriters judged;
  std::map<std::int64_t, msg::JointCommand> command_at;
  std::map<std::int64_t, msg::JointState> joints_at;
  std::map<std::string, std::uint64_t> newest;  // by topic, to check that the observer missed no sample
  std::uint64_t missed = 0;
  const auto hear = [&](const char* topic, const auto& source) {
    source.take([&](const auto& m) {
      std::uint64_t& last = newest[topic];
      if (last > 0 && m.header.sequence_number > last + 1) missed += m.header.sequence_number - last - 1;
      last = m.header.sequence_number;
      judged.add(m);
    });
  };
  const auto poll = [&] {
    hear("answers", answers);
    hear("tasks", tasks);
    hear("motions", motions);
    hear("authority", authority);
    commands.take([&](const msg::JointCommand& m) { command_at[m.header.tick] = m; });
    joints.take([&](const msg::JointState& m) { joints_at[m.header.tick] = m; });
  };
  const std::string token = read_token_file(dir_ / "constrictor" / ("run-" + std::to_string(domain()) + ".token"));
  Program planner(domain(), "machine", msg::kAuthorityExternal, token);
  Program pilot(domain(), "pilot", msg::kAuthorityOperator, token);
  ASSERT_TRUE(eventually([&] {
    poll();
    return planner.heard() && pilot.heard() && newest["authority"] > 0 && !joints_at.empty();
  }));
  const auto began = std::chrono::steady_clock::now();
  const std::int64_t from = joints_at.rbegin()->first;
  planner.start();
  pilot.start();
  ASSERT_TRUE(eventually(
      [&] {
        poll();
        return planner.answered() == kEach && pilot.answered() == kEach;
      },
      60s))
      << planner.answered() << " and " << pilot.answered() << " answered";
  const std::int64_t to = joints_at.rbegin()->first;
  ASSERT_TRUE(eventually([&] {
    poll();
    return joints_at.rbegin()->first > to + 5;
  }));
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  for (const Program* program : {&planner, &pilot}) {
    for (const auto& r : program->asked()) judged.add_request(r);
  }
  ASSERT_EQ(missed, 0u) << "the observer was too slow to judge";
  judged.check();
  std::printf(
      "%d requests in %ld ticks, %.1f s: obeyed %d of the operator, %d of the planner (%d refused); %d ticks obeyed "
      "both, with a release between\n",
      judged.answered, static_cast<long>(to - from), wall_s, judged.of_operator, judged.of_external,
      judged.refused_to_external, judged.ticks_of_both);
  EXPECT_EQ(judged.answered, static_cast<int>(2 * kEach));
  EXPECT_GT(judged.of_operator, 1000);
  EXPECT_GT(judged.of_external, 100);
  EXPECT_GT(judged.refused_to_external, 1000);
  expect_smooth(command_at, joints_at);
  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
  EXPECT_EQ(launcher.wait(15s), 128 + SIGTERM);
}

}  // namespace
}  // namespace constrictor::testing
