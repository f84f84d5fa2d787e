// Which moments become rows of the figure.
#include "sim/report/moments.hpp"

#include <gtest/gtest.h>

namespace constrictor::report {
namespace {

TEST(FigureRows, KeepTheFirstFindingAndTheLastRepetition) {
  const auto moment = [](std::int64_t tick, std::uint8_t event, std::uint8_t colour) {
    Moment m;
    m.tick = tick;
    m.event = event;
    m.colour = colour;
    return m;
  };
  const auto rows = figure_rows(
      {moment(1, msg::kEventObjectFound, msg::kColourGreen), moment(2, msg::kEventObjectGrasped, msg::kColourGreen),
       moment(3, msg::kEventObjectFound, msg::kColourGreen), moment(4, msg::kEventObjectGrasped, msg::kColourGreen),
       moment(5, msg::kEventObjectGrasped, msg::kColourRed)});
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].tick, 1);
  EXPECT_EQ(rows[1].tick, 4);
  EXPECT_EQ(rows[2].tick, 5);
}

TEST(FigureRows, AnEndJustAfterARowBecomesAPartOfIt) {
  const auto moment = [](double time_s, std::uint8_t event) {
    Moment m;
    m.time_s = time_s;
    m.event = event;
    return m;
  };
  const auto rows = merge_end({moment(10.0, msg::kEventDroppingDone), moment(10.1, msg::kEventNone)});
  ASSERT_EQ(rows.size(), 1U) << "both rows would show the same pictures";
  EXPECT_TRUE(rows[0].ends);
  const auto apart = merge_end({moment(10.0, msg::kEventDroppingDone), moment(13.0, msg::kEventNone)});
  ASSERT_EQ(apart.size(), 2U);
  EXPECT_FALSE(apart[0].ends);
  EXPECT_EQ(merge_end({moment(0.5, msg::kEventNone)}).size(), 1U) << "a run without events has one row";
}

}  // namespace
}  // namespace constrictor::report
