// Our PNG files against OpenCV's own reader and writer.
#include "sim/report/png.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "support/temporary_folder.hpp"

namespace constrictor::report {
namespace {

/// Every pixel has its own colour, and width x 3 is no multiple of 4.
cv::Mat colourful_image() {
  cv::Mat image(7, 5, CV_8UC3);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column)
      image.at<cv::Vec3b>(row, column) = {static_cast<unsigned char>(30 * row), static_cast<unsigned char>(50 * column),
                                          static_cast<unsigned char>(255 - row * column)};
  }
  return image;
}

bool equal(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

TEST(Png, EncodedImagesAreReadBackByOpenCvWithoutALoss) {
  const std::string bytes = encode_png(colourful_image());
  const cv::Mat read = cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
  EXPECT_TRUE(equal(read, colourful_image()));
}

TEST(Png, PartsOfAnImageAreEncodedByTheirOwnRows) {
  const cv::Mat part = colourful_image()(cv::Rect(1, 2, 3, 4));
  const std::string bytes = encode_png(part);
  const cv::Mat read = cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
  EXPECT_TRUE(equal(read, part.clone()));
}

TEST(Png, FilesThatOpenCvWroteAreReadWithoutALoss) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "image.png";
  cv::imwrite(file.string(), colourful_image());
  EXPECT_TRUE(equal(read_png(file), colourful_image()));
}

TEST(Png, MissingAndDamagedFilesGiveAnEmptyImage) {
  const testing::TemporaryFolder folder;
  EXPECT_TRUE(read_png(folder.path() / "missing.png").empty());
  EXPECT_TRUE(read_png("").empty());
  const std::string bytes = encode_png(colourful_image());
  std::ofstream(folder.path() / "text.png") << "this is no PNG file";
  EXPECT_TRUE(read_png(folder.path() / "text.png").empty());
  std::ofstream(folder.path() / "half.png", std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  EXPECT_TRUE(read_png(folder.path() / "half.png").empty());
}

}  // namespace
}  // namespace constrictor::report
