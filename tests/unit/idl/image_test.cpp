// The check of an image's pixels that all of its readers share.
#include "constrictor/image.hpp"

#include <gtest/gtest.h>

#include <array>

namespace constrictor {
namespace {

class ImageViolation : public ::testing::Test {
 protected:
  ImageViolation() {
    image_.width = 4;
    image_.height = 2;
    image_.data = {24, 24, pixels_.data(), false};
  }
  std::array<std::uint8_t, 24> pixels_{};
  msg::CameraImage image_{};
};

TEST_F(ImageViolation, IsEmptyForWholePixels) { EXPECT_EQ(image_violation(image_), ""); }

TEST_F(ImageViolation, NamesMissingAndSuperfluousBytes) {
  image_.data._length = 23;
  EXPECT_EQ(image_violation(image_), "data: found 23 bytes, accepted 4 x 2 x 3 = 24");
  image_.data._length = 24;
  image_.height = 1;
  EXPECT_EQ(image_violation(image_), "data: found 24 bytes, accepted 4 x 1 x 3 = 12");
}

TEST_F(ImageViolation, NamesALengthWithoutBytes) {
  image_.data._buffer = nullptr;
  EXPECT_EQ(image_violation(image_), "data: found 24 bytes, accepted 4 x 2 x 3 = 24 bytes in memory");
}

TEST_F(ImageViolation, NamesAnEmptySize) {
  image_.width = 0;
  image_.data._length = 0;
  EXPECT_EQ(image_violation(image_), "size: found 0 x 2 pixels, accepted 1 x 1 or more");
}

}  // namespace
}  // namespace constrictor
