// Pictures of recordings without images, which are computed again.
#include "integration/pictures_fixture.hpp"

namespace constrictor::testing {
namespace {

TEST_F(Pictures, ImagesThatWereNotRecordedAreComputedAgain) {
  for (const char* images : {"on", "recompute", "off"}) {
    EXPECT_EQ(command({"figure", run(images).string(), "--at", "0.6", "-o", out(std::string(images) + ".png")}), 0)
        << output_;
  }
  EXPECT_GT(content("on.png").size(), 50'000U);
  EXPECT_TRUE(content("on.png") == content("recompute.png"));
  EXPECT_TRUE(content("on.png") == content("off.png"));
  // The frames of the films are equal, too; H.264 has no room for chance.
  for (const char* images : {"on", "off"})
    EXPECT_EQ(command({"film", run(images).string(), "--fps", "10", "-o", out(std::string(images) + ".mp4")}), 0)
        << output_;
  const auto recorded = frames_of("on.mp4"), computed = frames_of("off.mp4");
  ASSERT_EQ(recorded.size(), 9U);
  ASSERT_EQ(computed.size(), 9U);
  for (std::size_t i = 0; i < recorded.size(); ++i) EXPECT_EQ(difference(recorded[i], computed[i]), 0.0) << i;
}

}  // namespace
}  // namespace constrictor::testing
