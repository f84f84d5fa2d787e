// A right plant passes; each of many faults of drivers is found, and the first check that fails names it.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "conform/plant_conformance.hpp"
#include "robot/robot_model.hpp"
#include "support/faulty_joints.hpp"
#include "support/joint_faults.hpp"
#include "support/project.hpp"

namespace constrictor::conform {
namespace {

using constrictor::testing::FaultyJoints;

/// A plant in this process, with two samples in each period. It has sessions, stops and epochs.
class Doubled final : public PlantPort {
 public:
  Doubled(std::size_t joints, const std::string& fault) : joints_of_plant_(joints, fault), modules_(joints + 1) {}
  [[nodiscard]] Abilities abilities() const override { return {true, true, true, true}; }
  void advance(const std::vector<PlantCommand>& commands) override {
    if (interrupt_at > 0 && ++advances_ == interrupt_at) throw Interrupted();
    joints_.clear();
    imus_.clear();
    contacts_.clear();
    for (const auto& command : commands) {
      const bool proper = command.origin == PlantCommand::Origin::kProper;
      if (proper) ++number_;
      const bool old = command.origin == PlantCommand::Origin::kOld;
      joints_of_plant_.take(command, command.origin == PlantCommand::Origin::kStranger ? 99 : session_,
                            old      ? 1
                            : proper ? number_
                                     : 1'000'000 + number_,
                            now_s_);
    }
    // A busy plant at times takes a command in a step of 0.1 ms, because it was late before, and is late again.
    const bool late = busy && ++advances_ % 5 == 0;
    for (const double passed_s : late ? std::array{0.0001, 0.0199} : std::array{0.01, 0.01}) {
      now_s_ += passed_s;
      joints_of_plant_.move(now_s_, passed_s);
      JointSample sample;
      if (joints_of_plant_.measure(now_s_, sample)) {
        sample.arrival_s = now_s_;
        joints_.push_back(sample);
        incarnation_ = sample.session;
      }
    }
    ImuSample imu;
    imu.orientation = {1.0, 0.0, 0.0, 0.0};
    imu.acceleration_m_s2 = {0.0, 0.0, joints_of_plant_.has("gravity_down") ? -9.81 : 9.81};
    imus_.push_back(imu);
    contacts_.push_back({joints_of_plant_.has("few_modules") ? 3 : static_cast<int>(modules_), 0, true});
  }
  [[nodiscard]] double now_s() const override { return now_s_; }
  [[nodiscard]] std::uint64_t session() const override { return session_; }
  [[nodiscard]] std::uint64_t number() const override { return number_; }
  void begin_session() override {
    ++session_;
    number_ = 0;
  }
  void order_stop() override { joints_of_plant_.stopped = true; }
  void clear_stop() override { joints_of_plant_.stopped = false; }
  [[nodiscard]] bool stopped() const override { return joints_of_plant_.stopped; }
  void begin_epoch() override {
    if (!joints_of_plant_.has("loses_epoch")) {
      ++epoch_;
      joints_of_plant_.forget_session();
    }
    begin_session();
  }
  [[nodiscard]] std::uint32_t epoch() const override { return epoch_; }
  [[nodiscard]] std::string restart() override {
    if (!obstacle.empty()) return obstacle;
    joints_of_plant_.restart();
    return {};
  }
  [[nodiscard]] std::uint64_t incarnation() const override { return incarnation_; }
  std::string obstacle;  ///< why it cannot be restarted
  long interrupt_at = 0;
  bool busy = false;

 private:
  FaultyJoints joints_of_plant_;
  std::size_t modules_;
  double now_s_ = 100.0;
  std::uint64_t session_ = 1, number_ = 0;
  std::uint32_t epoch_ = 1;
  long advances_ = 0;
  std::uint64_t incarnation_ = 0;
};

Report examine_plant(const std::string& fault, long interrupt_at = 0, bool busy = false) {
  const RobotModel robot = load_robot(testing::robot_path("mamba"));
  PlantProfile profile;
  profile.adapt_to(robot);
  Doubled plant(robot.joints.size(), fault);
  plant.interrupt_at = interrupt_at;
  plant.busy = busy;
  Report report(plant_checks());
  try {
    PlantConformance(plant, robot, profile, report).run();
  } catch (const Interrupted&) {}
  return report;
}

std::string text_of(const Report& report) {
  std::string text;
  for (const auto& check : report.checks()) text += conform::text_of(check) + "\n";
  return text;
}

TEST(PlantConformance, ARightPlantPassesEveryCheck) {
  const Report report = examine_plant("");
  EXPECT_TRUE(report.conforms()) << text_of(report);
  EXPECT_EQ(report.count(Verdict::kPassed), plant_checks().size()) << text_of(report);
}

TEST(PlantConformance, ARightPlantOnABusyMachinePasses) {
  const Report report = examine_plant("", 0, /*busy=*/true);
  EXPECT_TRUE(report.conforms()) << text_of(report);
}

TEST(PlantConformance, APlantThatNobodyCanRestartIsNotRestarted) {
  const RobotModel robot = load_robot(testing::robot_path("mamba"));
  PlantProfile profile;
  profile.adapt_to(robot);
  Doubled plant(robot.joints.size(), "");
  plant.obstacle = "nobody can restart it";
  Report report(plant_checks());
  PlantConformance(plant, robot, profile, report).run();
  EXPECT_TRUE(report.conforms()) << text_of(report);
  EXPECT_EQ(report.check("restart").verdict, Verdict::kSkipped);
  EXPECT_EQ(report.check("restart").found, "nobody can restart it");
}

class FindsTheFault : public ::testing::TestWithParam<testing::NamedFault> {};

TEST_P(FindsTheFault, AndNamesIt) {
  const Report report = examine_plant(GetParam().fault);
  EXPECT_FALSE(report.conforms());
  const auto first = std::find_if(report.checks().begin(), report.checks().end(),
                                  [](const Check& check) { return check.verdict == Verdict::kFailed; });
  ASSERT_NE(first, report.checks().end()) << text_of(report);
  EXPECT_EQ(first->name, GetParam().check) << text_of(report);
  EXPECT_NE(first->found.find(GetParam().found), std::string::npos) << first->found;
  EXPECT_FALSE(first->todo.empty());
  EXPECT_EQ(report.count(Verdict::kNotChecked), 0u) << text_of(report);
}

INSTANTIATE_TEST_SUITE_P(Drivers, FindsTheFault, ::testing::ValuesIn(testing::kJointFaults),
                         [](const auto& test) { return std::string(test.param.fault); });

TEST(PlantConformance, AnInterruptLeavesTheRestNotChecked) {
  const Report report = examine_plant("", 300);
  EXPECT_GT(report.count(Verdict::kPassed), 5u);
  EXPECT_GT(report.count(Verdict::kNotChecked), 5u);
  EXPECT_FALSE(report.conforms());
  EXPECT_NE(summary_of(report).find("not checked: "), std::string::npos);
}

TEST(PlantConformance, IsWrittenAsJson) {
  const nlohmann::ordered_json json = to_json(examine_plant("sign"));
  EXPECT_FALSE(json["conforms"].get<bool>());
  EXPECT_EQ(json["checks"].size(), plant_checks().size());
  for (const auto& check : json["checks"]) {
    if (check["name"] == "sign") {
      EXPECT_EQ(check["result"], "fail");
    }
  }
}

TEST(PlantProfile, RefusesWhatDoesNotFitTheRobot) {
  const RobotModel robot = load_robot(testing::robot_path("mamba"));
  PlantProfile profile;
  profile.joint_count = 7;
  EXPECT_THROW(profile.adapt_to(robot), ConfigurationError);
  PlantProfile other;
  other.joints = {3.0, 23.0};
  EXPECT_THROW(other.adapt_to(robot), ConfigurationError);
}

}  // namespace
}  // namespace constrictor::conform
