#include "planner/mission_state.hpp"

namespace constrictor {
namespace {

using enum MissionState;

constexpr EventTransition kNothing{};
constexpr EventTransition kGraspLost{msg::kEventObjectGraspLost, kSearchObject};

// clang-format off
constexpr std::array<StateRow, kMissionStates> kTable{{
    // state              name                        task                    holding succeeded            failed
    {kSearchLineOrObject, "search line or object",    msg::kTaskNone,         false, kSearchLineOrObject, kSearchLineOrObject, {kNothing, kNothing}},
    {kFollowLine,         "follow line",              msg::kTaskFollowLine,   false, kSearchObject,       kSearchLineOrObject, {EventTransition{msg::kEventLineLost, kSearchLineOrObject}, kNothing}},
    {kSearchObject,       "search object",            msg::kTaskSearchObject, false, kTrackObject,        kSearchLineOrObject, {kNothing, kNothing}},
    {kTrackObject,        "track object",             msg::kTaskTrackObject,  false, kPregrasp,           kSearchObject,       {EventTransition{msg::kEventObjectLost, kSearchObject}, kNothing}},
    {kPregrasp,           "pregrasp",                 msg::kTaskPregrasp,     false, kGrasp,              kSearchObject,       {EventTransition{msg::kEventObjectPregraspLost, kSearchObject}, kNothing}},
    {kGrasp,              "grasp",                    msg::kTaskGrasp,        false, kSearchLine,         kSearchObject,       {kGraspLost, EventTransition{msg::kEventObjectPregraspLost, kSearchObject}}},
    {kSearchLine,         "search line",              msg::kTaskNone,         true,  kSearchLine,         kSearchLine,         {kGraspLost, kNothing}},
    {kTransport,          "follow line to drop zone", msg::kTaskFollowLine,   true,  kSearchLine,         kSearchLine,         {kGraspLost, EventTransition{msg::kEventLineLost, kSearchLine}}},
    {kDrop,               "drop",                     msg::kTaskDrop,         true,  kTurnRound,          kSearchLine,         {kGraspLost, kNothing}},
    {kTurnRound,          "turn round",               msg::kTaskRotate,       false, kSearchLineOrObject, kSearchLineOrObject, {kNothing, kNothing}},
    {kTurnBack,           "turn back",                msg::kTaskRotate,       true,  kSearchLine,         kSearchLine,         {kGraspLost, kNothing}},
    {kDone,               "done",                     msg::kTaskNone,         false, kDone,               kDone,               {kNothing, kNothing}},
    {kFailed,             "failed",                   msg::kTaskNone,         false, kFailed,             kFailed,             {kNothing, kNothing}},
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
