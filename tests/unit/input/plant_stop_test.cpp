// The emergency stop that the plant itself obeys, with the component `input`, which follows it and clears it.
#include <gtest/gtest.h>

#include "barrier/local_run.hpp"
#include "component/plant_stop.hpp"
#include "input/input.hpp"
#include "requests.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {
namespace {

class StoppablePlant : public testing::PlantBase {
 public:
  explicit StoppablePlant(Wiring& wiring) : stop_(wiring, {400}) {}
  void sample(const Tick& tick) override { stop_.sample(tick); }
  void step(const Tick&) override { stopped = stop_.in_force(); }
  bool stopped = false;

 private:
  PlantStop stop_;
};

ComponentFactory plant() {
  return {"physics", [](Wiring& wiring, const Setup&) { return std::make_unique<StoppablePlant>(wiring); }};
}

class PlantStopTest : public ::testing::Test {
 protected:
  PlantStopTest() {
    run_.subscribe(topics::kStopState,
                   std::function<void(const msg::StopState&)>([this](const auto& state) { states_.push_back(state); }));
    run_.subscribe(topics::kStopCleared, std::function<void(const msg::StopCleared&)>(
                                             [this](const auto& cleared) { cleared_.push_back(cleared); }));
    run_.advance(5);
  }
  void order_stop(const std::string& source) { run_.member("physics").stop_orders()->add(source); }
  void clear_stop() { clients_->add(request("operator", kOperator, msg::kRequestClearStop, ++number_), writer(1)); }
  [[nodiscard]] bool stopped() { return dynamic_cast<StoppablePlant&>(run_.component("physics")).stopped; }
  [[nodiscard]] const msg::Authority& authority() { return *run_.latest(topics::kAuthority); }

  std::uint64_t number_ = 0;
  std::shared_ptr<ClientRequests> clients_ = std::make_shared<ClientRequests>();
  LocalRun run_{{plant(), make_input_factory(clients_)}, constrictor::Setup{}};
  std::vector<msg::StopState> states_;
  std::vector<msg::StopCleared> cleared_;
};

TEST_F(PlantStopTest, IsObeyedAndPublishedWithTheTickAtWhichItArrived) {
  EXPECT_FALSE(stopped());
  const std::int64_t tick = run_.tick();
  order_stop("somebody");
  run_.advance(1);
  EXPECT_TRUE(stopped());
  ASSERT_FALSE(states_.empty());
  EXPECT_TRUE(states_.back().stopped);
  EXPECT_EQ(states_.back().header.tick, tick);
  EXPECT_EQ(states_.back().since_tick, tick);
  EXPECT_EQ(states_.back().number, 1u);
  EXPECT_STREQ(states_.back().source, "somebody");
  EXPECT_TRUE(authority().emergency_stop) << "input follows in the same tick";
  EXPECT_EQ(authority().header.tick, tick);
  EXPECT_STREQ(authority().source, "somebody");
}

TEST_F(PlantStopTest, StaysInForceUntilAnOperatorClearsIt) {
  order_stop("somebody");
  run_.advance(300);
  EXPECT_TRUE(stopped());
  clients_->add(request("planner_7", kExternal, msg::kRequestClearStop, 1), writer(2));
  run_.advance(3);
  EXPECT_TRUE(stopped()) << "an external planner is no operator";
  EXPECT_TRUE(cleared_.empty());
  clear_stop();
  run_.advance(3);
  EXPECT_FALSE(stopped());
  EXPECT_FALSE(authority().emergency_stop);
  ASSERT_EQ(cleared_.size(), 1u);
  EXPECT_EQ(cleared_.back().number, 1u);
  EXPECT_STREQ(cleared_.back().source, "operator");
  EXPECT_FALSE(states_.back().stopped);
  EXPECT_EQ(states_.back().number, 1u);
}

// An operator clears a stop without information on another stop that arrives in the same tick.
TEST_F(PlantStopTest, AStopThatArrivesWithTheClearingOfAnEarlierOneStaysInForce) {
  order_stop("first");
  run_.advance(10);
  for (int delay = 0; delay < 3; ++delay) {  // before, with and after the tick in which input clears
    clear_stop();
    run_.advance(delay);
    order_stop("second");
    run_.advance(10);
    EXPECT_TRUE(stopped()) << delay;
    EXPECT_TRUE(authority().emergency_stop) << delay;
  }
}

TEST_F(PlantStopTest, CountsEveryOrderAndLatchesOneEachTick) {
  for (int i = 0; i < 1000; ++i) order_stop("flood");
  run_.advance(1);
  EXPECT_EQ(states_.back().received, 1000u);
  EXPECT_EQ(states_.back().number, 1u);
  order_stop("\x1b]0;title\x07");
  run_.advance(1);
  EXPECT_EQ(states_.back().number, 2u);
  EXPECT_STREQ(states_.back().source, "?]0;title?");
  order_stop("");
  run_.advance(1);
  EXPECT_STREQ(states_.back().source, "?");
  EXPECT_EQ(states_.back().received, 1002u);
}

TEST_F(PlantStopTest, IsPublishedEveryFiftyTicksAndOnChange) {
  ASSERT_EQ(states_.size(), 1u);
  run_.advance(195);  // to tick 200
  EXPECT_EQ(states_.size(), 4u);
  for (const auto& state : states_) EXPECT_FALSE(state.stopped);
}

TEST_F(PlantStopTest, APlannedStopIsLatchedAtItsTick) {
  run_.advance(400 - run_.tick());
  EXPECT_FALSE(stopped());
  run_.advance(1);
  EXPECT_TRUE(stopped());
  EXPECT_EQ(states_.back().since_tick, 400);
}

TEST_F(PlantStopTest, OutlivesARestartOfInput) {
  order_stop("somebody");
  run_.advance(10);
  run_.restart("input");
  run_.advance(10);
  EXPECT_TRUE(stopped());
  EXPECT_TRUE(authority().emergency_stop);
  clear_stop();
  run_.advance(5);
  EXPECT_FALSE(stopped());
}

}  // namespace
}  // namespace constrictor
