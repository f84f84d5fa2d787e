#include "planner/mission_state.hpp"

namespace constrictor {
namespace {

using enum MissionState;
using Losses = std::array<EventTransition, 2>;

constexpr EventTransition kObject{msg::kEventObjectLost, kSearchObject};
constexpr EventTransition kPregrasped{msg::kEventObjectPregraspLost, kSearchObject};
constexpr EventTransition kGrasped{msg::kEventObjectGraspLost, kSearchObject};
constexpr EventTransition kLine{msg::kEventLineLost, kSearchLineOrObject};
constexpr EventTransition kLineWithObject{msg::kEventLineLost, kSearchLine};

// clang-format off
constexpr std::array<StateRow, kMissionStates> kTable{{
    // state              name                        task                    holding
    //                        succeeded            failed               losses
    {kSearchLineOrObject, "search line or object",    msg::kTaskNone,         false,
                              kSearchLineOrObject, kSearchLineOrObject, {}},
    {kFollowLine,         "follow line",              msg::kTaskFollowLine,   false,
                              kSearchObject,       kSearchLineOrObject, Losses{kLine}},
    {kSearchObject,       "search object",            msg::kTaskSearchObject, false,
                              kTrackObject,        kSearchLineOrObject, {}},
    {kTrackObject,        "track object",             msg::kTaskTrackObject,  false,
                              kPregrasp,           kSearchObject,       Losses{kObject}},
    {kPregrasp,           "pregrasp",                 msg::kTaskPregrasp,     false,
                              kGrasp,              kSearchObject,       Losses{kPregrasped}},
    {kGrasp,              "grasp",                    msg::kTaskGrasp,        false,
                              kSearchLine,         kSearchObject,       Losses{kGrasped, kPregrasped}},
    {kSearchLine,         "search line",              msg::kTaskNone,         true,
                              kSearchLine,         kSearchLine,         Losses{kGrasped}},
    {kTransport,          "follow line to drop zone", msg::kTaskFollowLine,   true,
                              kSearchLine,         kSearchLine,         Losses{kGrasped, kLineWithObject}},
    {kDrop,               "drop",                     msg::kTaskDrop,         true,
                              kInspect,            kSearchLine,         Losses{kGrasped}},
    {kInspect,            "inspect drop",             msg::kTaskSearchObject, false,
                              kInspect,            kInspect,            {}},
    {kApproachAnew,       "approach anew",            msg::kTaskExplore,      false,
                              kSearchObject,       kSearchObject,       {}},
    {kTurnRound,          "turn round",               msg::kTaskRotate,       false,
                              kSearchLineOrObject, kSearchLineOrObject, {}},
    {kTurnBack,           "turn back",                msg::kTaskRotate,       true,
                              kSearchLine,         kSearchLine,         Losses{kGrasped}},
    {kDone,               "done",                     msg::kTaskNone,         false,
                              kDone,               kDone,               {}},
    {kFailed,             "failed",                   msg::kTaskNone,         false,
                              kFailed,             kFailed,             {}},
}};
// clang-format on

constexpr bool in_order() {
  for (std::size_t i = 0; i < kTable.size(); ++i) {
    if (kTable[i].state != static_cast<MissionState>(i)) return false;
  }
  return true;
}
static_assert(in_order(), "the table is indexed by state");

}  // namespace

const StateRow& row_of(MissionState state) { return kTable[static_cast<std::size_t>(state)]; }

}  // namespace constrictor
