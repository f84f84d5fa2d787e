// Explores every interleaving of deliveries, steps and ticks of a small run. In some cases a member crashes at any
// point, and any number of its last messages are lost; in others the run is reset. Every interleaving must end with the
// result that the in-process run computes.
#include <gtest/gtest.h>

#include <span>
#include <unordered_set>

#include "barrier/local_run.hpp"
#include "constrictor/reflect.hpp"
#include "constrictor/sha256.hpp"
#include "queue_world.hpp"

namespace constrictor {
namespace {

using namespace testing::toys;

// Runs of two and three ticks with a crash take minutes: they have the label `long`. The quick tests run one tick.
#ifdef CONSTRICTOR_EXPLORE_LONG
constexpr std::int64_t kTicksWithCrash = 2;
constexpr std::int64_t kTicksWithCrashOfControl = 3;
constexpr std::int64_t kTicksWithCrashOfPlant = 3;
#else
constexpr std::int64_t kTicksWithCrash = 1;
constexpr std::int64_t kTicksWithCrashOfControl = 1;
constexpr std::int64_t kTicksWithCrashOfPlant = 1;
#endif

struct Case {
  std::vector<ComponentFactory> factories;
  std::int64_t ticks = 3;
  std::set<std::string> mortal;
  int crashes = 0;
  int resets = 0;
  bool from_start = true;  ///< explore the orders of the start as well
};

struct Outcome {
  std::size_t states = 0;
  std::size_t ends = 0;
};

/// A depth-first search over sequences of actions. Each state is reached by performing all of its actions again,
/// because members cannot be copied.
class Explorer {
 public:
  explicit Explorer(const Case& c) : case_(c) {
    Setup setup;
    LocalRun reference(c.factories, setup);
    finish(reference);
    expected_hashes_ = reference.output_hashes();
    expected_plant_ = static_cast<ToyPlant&>(reference.component("physics")).value();
    if (c.resets > 0) {
      setup.seed = 5;
      LocalRun after(c.factories, setup);
      finish(after);
      after_reset_hashes_ = after.output_hashes();
    }
  }

  Outcome run() {
    explore();
    return outcome_;
  }

 private:
  void finish(LocalRun& run) const {
    run.advance(case_.ticks);
    run.end_run();
    run.advance(1);
  }

  void explore() {
    QueueWorld world(case_.factories, case_.ticks, case_.mortal.contains("physics"));
    if (!case_.from_start) world.settle();
    int crashes = 0;
    int resets = 0;
    for (const auto& action : path_) {
      world.apply(action);
      crashes += action.kind == QueueWorld::Action::kCrash;
      resets += action.kind == QueueWorld::Action::kReset;
    }
    if (!seen_.insert(key(world.fingerprint() + "#" + std::to_string(crashes) + std::to_string(resets))).second) return;
    ++outcome_.states;
    // Without a reset there are no messages of an earlier epoch, so no message may be refused.
    if (resets == 0) {
      ASSERT_EQ(world.refused(), 0u);
    }
    if (world.finished()) return check(world, resets);
    const auto actions =
        world.actions(crashes < case_.crashes ? case_.mortal : std::set<std::string>{}, resets < case_.resets);
    ASSERT_FALSE(actions.empty()) << "deadlock after " << path_.size() << " actions: " << world.fingerprint();
    for (const auto& action : actions) {
      path_.push_back(action);
      explore();
      path_.pop_back();
      if (::testing::Test::HasFatalFailure()) return;
    }
  }

  /// Half of a SHA-256 of a fingerprint. It saves memory, because a fingerprint is some hundred times as long.
  static std::string key(const std::string& fingerprint) {
    Sha256 hash;
    hash.update(std::as_bytes(std::span(fingerprint)));
    const auto digest = hash.finish();
    return {reinterpret_cast<const char*>(digest.data()), digest.size() / 2};
  }

  void check(const QueueWorld& world, int resets) {
    ++outcome_.ends;
    if (resets > 0) {
      ASSERT_EQ(world.output_hashes(), after_reset_hashes_);
      return;
    }
    ASSERT_EQ(world.plant_value(), expected_plant_);
    ASSERT_EQ(world.output_hashes(), expected_hashes_);
  }

  const Case& case_;
  std::vector<QueueWorld::Action> path_;
  std::unordered_set<std::string> seen_;
  Outcome outcome_;
  std::map<std::string, std::array<std::uint8_t, 32>> expected_hashes_;
  std::map<std::string, std::array<std::uint8_t, 32>> after_reset_hashes_;
  double expected_plant_ = 0;
};

Outcome explore(const Case& c) {
  const Outcome outcome = Explorer(c).run();
  std::printf("%zu states, %zu ends\n", outcome.states, outcome.ends);
  EXPECT_GT(outcome.ends, 0u);
  return outcome;
}

TEST(BarrierExploration, EveryOrderOfThreeMembersGivesTheSameResult) {
  const auto outcome = explore({{plant(), navigation(), control()}, 3, {}, 0, 0});
  EXPECT_GT(outcome.states, 100u);
}

TEST(BarrierExploration, SlowerMemberWithLatencyGivesTheSameResult) {
  explore({{plant(), navigation({2, 2}), control()}, 3, {}, 0, 0});
}

TEST(BarrierExploration, ACrashOfNavigationAnywhereGivesTheSameResult) {
  explore({{plant(), navigation(), control()}, kTicksWithCrash, {"navigation"}, 1, 0, false});
}

TEST(BarrierExploration, ACrashOfControlAnywhereGivesTheSameResult) {
  explore({{plant(), navigation(), control()}, kTicksWithCrashOfControl, {"control"}, 1, 0, false});
}

#ifdef CONSTRICTOR_EXPLORE_LONG
TEST(BarrierExploration, ACrashOfASlowerMemberAnywhereGivesTheSameResult) {
  explore({{plant(), navigation({2, 2}), control()}, kTicksWithCrash, {"navigation"}, 1, 0, false});
}
#endif

TEST(BarrierExploration, ACrashOfTheOnlyMemberWithinThreeTicksGivesTheSameResult) {
  explore({{plant(), control()}, 3, {"control"}, 1, 0, false});
}

// The plant's process dies with the conductor, at every point of the protocol.
TEST(BarrierExploration, ACrashOfThePlantAnywhereGivesTheSameResult) {
  explore({{plant(), control()}, kTicksWithCrashOfPlant, {"physics"}, 1, 0, false});
}

TEST(BarrierExploration, ACrashOfThePlantDuringTheStartGivesTheSameResult) {
  explore({{plant(), control()}, 1, {"physics"}, 1, 0});
}

#ifdef CONSTRICTOR_EXPLORE_LONG
TEST(BarrierExploration, ACrashOfThePlantWhileTheRunIsResetGivesTheResultOfANewRun) {
  explore({{plant(), control()}, 1, {"physics"}, 1, 1, false});
}
#endif

TEST(BarrierExploration, ACrashDuringTheStartGivesTheSameResult) {
  explore({{plant(), control()}, 1, {"control"}, 1, 0});
}

TEST(BarrierExploration, AResetAnywhereGivesTheResultOfANewRun) { explore({{plant(), control()}, 2, {}, 0, 1}); }

TEST(BarrierExploration, AResetWhileAMemberRestartsGivesTheResultOfANewRun) {
  explore({{plant(), control()}, 1, {"control"}, 1, 1, false});
}

}  // namespace
}  // namespace constrictor
