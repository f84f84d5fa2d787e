// The order in which objects are delivered, as the report judges it.
#include "sim/report/ledger.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace constrictor::report {
namespace {

/// A green and a red object, which lie on their zones unless the robot holds them, and a robot of one module.
class LedgerTest : public ::testing::Test {
 protected:
  LedgerTest() {
    scene_->object_count = scene_->zone_count = 2;
    scene_->module_radius_m = 0.035;
    for (std::size_t i = 0; i < 2; ++i) {
      scene_->objects[i].colour = colours_[i];
      scene_->objects[i].size_m = {0.08, 0.08, 0.15};
      scene_->zones[i] = {colours_[i], 0.0, places_m_[i], 0.3};
      world_->object_poses[i].position_m = {0.0, places_m_[i], 0.0};
    }
    world_->object_count = 2;
    world_->module_count = 1;
    ledger_.start(*scene_);
  }

  /// The robot carries an object to its zone while the planner announces this entry of the mission.
  void carry(std::size_t object, std::uint16_t announced) {
    world_->module_poses[0].position_m = {0.1, places_m_[object], 0.0};
    announce(announced);  // in a run, the status of the task is known before its events
    report(msg::kEventObjectGrasped, object);
    announce(announced);
  }
  void drop(std::size_t object) { report(msg::kEventDroppingDone, object); }
  void lose(std::size_t object) { report(msg::kEventObjectGraspLost, object); }
  [[nodiscard]] std::string shortfall() const { return ledger_.shortfall(*scene_, *world_); }

  static constexpr std::size_t kGreen = 0, kRed = 1;

 private:
  void announce(std::uint16_t index) {
    msg::MissionStatus mission{};
    mission.object_count = 2;
    mission.object_index = index;
    mission.colour = colours_[index];
    ledger_.on_mission(mission, true);
  }
  void report(std::uint8_t event, std::size_t object) {
    msg::TaskEvent message{};
    message.event = event;
    message.colour = colours_[object];
    message.goal_id = static_cast<std::uint64_t>(msg::kAuthorityPlanner) << 48;
    world_->header.tick += 100;
    ledger_.on_event(message, *scene_, *world_);
  }

  std::array<std::uint8_t, 2> colours_{msg::kColourGreen, msg::kColourRed};
  std::array<double, 2> places_m_{1.0, -1.0};
  std::unique_ptr<msg::SceneDescription> scene_ = std::make_unique<msg::SceneDescription>();
  std::unique_ptr<msg::WorldState> world_ = std::make_unique<msg::WorldState>();
  ObjectLedger ledger_;
};

TEST_F(LedgerTest, TheOrderOfTheMissionSucceeds) {
  carry(kGreen, 0);
  drop(kGreen);
  carry(kRed, 1);
  EXPECT_EQ(shortfall(), "red is grasped but not dropped");
  drop(kRed);
  EXPECT_EQ(shortfall(), "");
}

TEST_F(LedgerTest, AnotherOrderThanThePlannerAnnouncedDoesNot) {
  carry(kRed, 0);
  drop(kRed);
  carry(kGreen, 1);
  drop(kGreen);
  EXPECT_NE(shortfall().find("out of order"), std::string::npos) << shortfall();
}

TEST_F(LedgerTest, AnObjectThatWasPutAsideMayComeLast) {
  carry(kGreen, 0);
  lose(kGreen);
  carry(kRed, 1);
  drop(kRed);
  carry(kGreen, 0);
  drop(kGreen);
  EXPECT_EQ(shortfall(), "");
}

TEST_F(LedgerTest, AnObjectThatIsBroughtBackToItsZoneKeepsItsPlaceInTheOrder) {
  carry(kGreen, 0);
  drop(kGreen);
  carry(kRed, 1);
  drop(kRed);
  for (const std::uint16_t announced : {std::uint16_t{1}, std::uint16_t{0}}) {
    carry(kGreen, announced);
    drop(kGreen);
    EXPECT_EQ(shortfall(), "") << "announced as " << announced;
  }
}

}  // namespace
}  // namespace constrictor::report
