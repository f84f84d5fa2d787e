// Faults between real processes. The plant must not obey joint commands that are not finite, have the wrong number of
// joints, belong to another epoch or are old; without commands it must hold the posture. Wrong configuration files must
// be refused before the run starts.
#include <cmath>

#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"
#include "support/project.hpp"
#include "support/swaying_control.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

constexpr double kMaxSpeed_rad_s = 4.0;  // of Mamba's joints (components/lib/robot/mamba.yaml)
constexpr std::int64_t kTicks = 400;

/// An observer that keeps every message about joints, ground truth and the status of the members.
class Watcher {
 public:
  explicit Watcher(std::uint32_t domain)
      : domain_(domain),
        joints_(reader<msg::JointState>(std::string(topics::kJointState.name))),
        world_(reader<msg::WorldState>(std::string(topics::kWorldState.name))),
        commands_(reader<msg::JointCommand>(std::string(topics::kJointCommand.name))),
        status_(dds::Reader<msg::ComponentStatus>::observer(domain_.participant(), "component_status", 16)) {}
  void poll() {
    joints_.take([this](const msg::JointState& m) { joints[m.header.tick] = m; });
    world_.take([this](const msg::WorldState& m) { hashes[m.header.tick].assign(m.state_hash, m.state_hash + 32); });
    commands_.take([this](const msg::JointCommand& m) { command = m; });
    status_.take([this](const msg::ComponentStatus& m) { status[m.component] = m; });
  }
  [[nodiscard]] std::int64_t tick() const { return joints.empty() ? -1 : joints.rbegin()->first; }
  [[nodiscard]] dds_entity_t participant() const { return domain_.participant(); }

  std::map<std::int64_t, msg::JointState> joints;
  std::map<std::int64_t, std::vector<std::uint8_t>> hashes;
  std::map<std::string, msg::ComponentStatus> status;
  msg::JointCommand command{};

 private:
  template <class T>
  [[nodiscard]] dds::Reader<T> reader(const std::string& topic) const {
    return dds::Reader<T>::member(domain_.participant(), topic);
  }
  dds::Domain domain_;
  dds::Reader<msg::JointState> joints_;
  dds::Reader<msg::WorldState> world_;
  dds::Reader<msg::JointCommand> commands_;
  dds::Reader<msg::ComponentStatus> status_;
};

class Faults : public CliFixture {
 protected:
  /// Runs a robot to the end of the run and observes it. Its control (swaying_control) moves one joint, and has `fault`
  /// from tick kFaultFrom to kFaultTo. `meanwhile` is called again and again while the run goes on.
  void run(
      const std::string& fault, const std::function<void(Watcher&)>& meanwhile = [](Watcher&) {}) {
    write("sway.yaml",
          "plant: physics\nrobot: components/lib/robot/mamba.yaml\nscenario: sim/scenarios/line.yaml\npatience_s: "
          "20\nprocesses:\n"
          "  - {components: [physics]}\n  - {components: [control], program: swaying_control, environment: "
          "['CONSTRICTOR_FAULT=" +
              fault + "']}\n");
    Process launcher = start({"run", "--manifest", (dir_ / "sway.yaml").string(), "--report", (dir_ / "r").string(),
                              "--pace", "2x", "--max-sim-time", std::to_string(0.02 * kTicks)});
    ASSERT_TRUE(eventually([&] { return domain() != 0 || !launcher.running(); }));
    watcher_ = std::make_unique<Watcher>(domain());
    ASSERT_TRUE(eventually(
        [&] {
          watcher_->poll();
          meanwhile(*watcher_);
          return !launcher.running();
        },
        60s));
    watcher_->poll();
    EXPECT_EQ(launcher.wait(1s), exit_status::kFailed) << launcher.output() << launcher.errors();
    ASSERT_GE(watcher_->tick(), kTicks - 2) << launcher.output() << launcher.errors();
    ASSERT_LT(watcher_->joints.begin()->first, kFaultFrom - 20) << "the observer joined the run too late";
  }
  [[nodiscard]] double angle_rad(std::int64_t tick) const {
    return watcher_->joints.at(tick).position_rad[kSwayingJoint];
  }
  /// Range of the joint's angle [rad] from tick `from` to before tick `to`.
  [[nodiscard]] double range_rad(std::int64_t from, std::int64_t to) const {
    double least = 1e9, most = -1e9;
    for (std::int64_t k = from; k < to; ++k) {
      least = std::min(least, angle_rad(k));
      most = std::max(most, angle_rad(k));
    }
    return most - least;
  }
  /// Number of messages that a component has refused in the whole run, from the run's report; -1 if the report does not
  /// contain the component.
  [[nodiscard]] long refused(const std::string& name) const {
    const nlohmann::json json = report("r");
    for (const auto& process : json["processes"]) {
      if (process["name"] == name) return process["refused"];
    }
    return -1;
  }
  /// Expects that the joint held its angle during the fault, followed the commands again after it, and that no joint
  /// was ever faster than its maximum.
  void expect_held() const {
    // The plant obeys a command for at most five ticks (sim/physics/physics.yaml). After 20 ticks the joint is at rest.
    EXPECT_LT(range_rad(kFaultFrom + 20, kFaultTo), 0.02);
    const double asked_rad = std::abs(sway_rad(kFaultTo) - sway_rad(kFaultFrom + 20));
    EXPECT_GT(asked_rad, 0.1) << "the commanded angle must change during the fault, or this test proves nothing";
    EXPECT_GT(range_rad(kFaultTo + 40, kTicks - 2), 1.5 * kSwayHalf_rad)
        << "the joint did not move again after the fault";
    double fastest_rad_s = 0.0;
    for (const auto& [tick, state] : watcher_->joints) {
      for (int j = 0; j < state.joint_count; ++j) {
        ASSERT_TRUE(std::isfinite(state.position_rad[j]) && std::isfinite(state.torque_nm[j])) << "tick " << tick;
        fastest_rad_s = std::max(fastest_rad_s, std::abs(state.velocity_rad_s[j]));
      }
    }
    EXPECT_LE(fastest_rad_s, kMaxSpeed_rad_s);
  }
  [[nodiscard]] std::string last_refusal(const std::string& component) const {
    const auto found = watcher_->status.find(component);
    return found == watcher_->status.end() ? "(no status received)" : found->second.last_refusal;
  }

  std::unique_ptr<Watcher> watcher_;
};

TEST_F(Faults, ACommandWithNanIsRefusedAsAWholeAndThePostureIsHeld) {
  run("nan");
  ASSERT_FALSE(HasFatalFailure());
  expect_held();
  EXPECT_EQ(refused("control"), kFaultTo - kFaultFrom) << "the runtime of control must refuse to publish it";
  EXPECT_EQ(refused("physics"), 0);
  EXPECT_NE(last_refusal("control").find("joint_command.position_rad"), std::string::npos) << last_refusal("control");
}

TEST_F(Faults, ACommandWithAnotherJointCountIsRefusedAsAWholeAndThePostureIsHeld) {
  run("count");
  ASSERT_FALSE(HasFatalFailure());
  expect_held();
  EXPECT_EQ(refused("physics"), kFaultTo - kFaultFrom);
  EXPECT_NE(last_refusal("physics").find("joint_command: "), std::string::npos) << last_refusal("physics");
}

TEST_F(Faults, WithoutNewCommandsThePostureIsHeld) {
  run("silence");
  ASSERT_FALSE(HasFatalFailure());
  expect_held();
  EXPECT_EQ(refused("control") + refused("physics"), 0) << "there was no message to refuse";
}

// Another writer on the same topic sends commands of another epoch, and repeats an old command of this run. It has not
// announced itself as `control`, so that its commands are refused whatever they contain.
TEST_F(Faults, CommandsOfAnotherEpochAndRepeatedOldCommandsChangeNothing) {
  run("");
  ASSERT_FALSE(HasFatalFailure());
  ASSERT_EQ(range_rad(kFaultFrom, kFaultTo) > 0.1, true) << "without a fault the joint moves";
  const std::vector<std::uint8_t> expected = watcher_->hashes.at(kTicks - 2);
  watcher_.reset();  // this process may have only one participant in a domain
  std::optional<dds::Writer<msg::JointCommand>> intruder;
  msg::JointCommand old{};
  std::int64_t written_at = 0;
  int written = 0;
  run("", [&](Watcher& watcher) {
    if (watcher.tick() < 20) return;
    if (!intruder) {
      intruder.emplace(watcher.participant(), std::string(topics::kJointCommand.name), 8);
      old = watcher.command;
      old.position_rad[kSwayingJoint] = -1.0;
    }
    if (watcher.tick() < written_at + 10 || intruder->readers() < 1) return;
    written_at = watcher.tick();
    msg::JointCommand other = watcher.command;
    other.header.epoch += 1;
    other.position_rad[kSwayingJoint] = -1.0;
    intruder->write(other);
    intruder->write(old);
    ++written;
  });
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_EQ(watcher_->hashes.at(kTicks - 2), expected);
  EXPECT_GT(written, 5);
  EXPECT_GT(refused("physics"), 5);
  EXPECT_EQ(last_refusal("physics"),
            "joint_command.writer: found a process that has not announced itself as this member");
}

TEST_F(Faults, AWrongConfigurationIsRefusedBeforeTheRunStartsWithFileLineKeyFoundAndAccepted) {
  struct Case {
    const char *component, *line, *wrong;
    std::vector<std::string> said;  ///< words that the error must contain
    long lines_on = 0;              ///< how far the line of the error is below the replaced line
  };
  const std::vector<Case> cases = {
      {"navigation", "  seat_time_s: 1", "  seat_time_s: 1\n  seat_tme_s: 1", {"seat_tme_s", "seat_time_s"}, 1},
      {"navigation", "  found_after_images: 3", "  found_after: 3", {"line_tracker.found_after", "found_after_images"}},
      {"navigation", "found_after_images: 3", "found_after_images: three", {"found_after_images", "three"}},
      {"navigation", "seat_timeout_s: 20", "seat_timeout_s: -20", {"seat_timeout_s", "-20"}},
      {"planner", "sequence: ", "sequence: [mauve] # ", {"sequence", "mauve", "green"}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.wrong);
    std::ifstream file(testing::source_path(std::string("components/") + c.component + "/" + c.component + ".yaml"));
    std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto at = text.find(c.line);
    ASSERT_NE(at, std::string::npos) << c.line;
    const auto number = c.lines_on + 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    write("bad.yaml", text.replace(at, std::string(c.line).size(), c.wrong));
    EXPECT_EQ(command({"run", "short", "--config", std::string(c.component) + "=" + (dir_ / "bad.yaml").string(),
                       "--report", (dir_ / "r").string()}),
              exit_status::kConfiguration);
    EXPECT_NE(output_.find(std::string(c.component) + ": "), std::string::npos) << output_;
    EXPECT_FALSE(std::filesystem::exists(dir_ / "r")) << "nothing may be started";
    EXPECT_NE(output_.find("bad.yaml:" + std::to_string(number)), std::string::npos) << output_;
    for (const std::string& word : c.said)
      EXPECT_NE(output_.find(word), std::string::npos) << word << " in: " << output_;
    EXPECT_NE(output_.find("accepted"), std::string::npos) << output_;
  }
}

}  // namespace
}  // namespace constrictor::testing
