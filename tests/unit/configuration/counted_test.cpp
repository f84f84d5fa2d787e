// Numbers of things agree with their nouns.
#include "configuration/counted.hpp"

#include <gtest/gtest.h>

namespace constrictor {
namespace {

TEST(Counted, OneThingIsSingularAndEveryOtherNumberIsPlural) {
  EXPECT_EQ(counted(1, "topic"), "1 topic");
  EXPECT_EQ(counted(0, "topic"), "0 topics");
  EXPECT_EQ(counted(2, "topic"), "2 topics");
  EXPECT_EQ(counted(1, "process", "processes"), "1 process");
  EXPECT_EQ(counted(12, "process", "processes"), "12 processes");
}

}  // namespace
}  // namespace constrictor
