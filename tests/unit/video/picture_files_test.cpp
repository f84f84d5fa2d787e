#include "video/picture_files.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "support/temporary_folder.hpp"

namespace constrictor::video {
namespace {

using testing::TemporaryFolder;

class PictureFilesTest : public ::testing::Test {
 protected:
  [[nodiscard]] PictureFiles open(const std::string& name, bool repeat) const {
    return {parse_source(name, folder_.path(), folder_.path()), repeat};
  }
  void picture(const std::string& name, int grey) const {
    ASSERT_TRUE(cv::imwrite((folder_.path() / name).string(), cv::Mat(16, 16, CV_8UC3, cv::Scalar::all(grey))));
  }
  static int grey_of(const cv::Mat& picture) { return picture.empty() ? -1 : picture.at<cv::Vec3b>(8, 8)[1]; }

  const TemporaryFolder folder_;
};

TEST_F(PictureFilesTest, ShowsAFolderInTheOrderOfNamesAndNothingElse) {
  picture("b.png", 20);
  picture("a.png", 10);
  std::ofstream(folder_.path() / "notes.txt") << "no picture";
  PictureFiles once = open(".", false);
  EXPECT_EQ(grey_of(once.at(0)), 10);
  EXPECT_EQ(grey_of(once.at(1)), 20);
  EXPECT_TRUE(once.at(2).empty());
  PictureFiles again = open(".", true);
  EXPECT_EQ(grey_of(again.at(5)), 20);
}

TEST_F(PictureFilesTest, ShowsAVideoByNumberAlsoBackwards) {
  const auto file = (folder_.path() / "film.avi").string();
  {
    cv::VideoWriter writer(file, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10.0, {64, 64});
    ASSERT_TRUE(writer.isOpened());
    for (int i = 0; i < 5; ++i) writer.write(cv::Mat(64, 64, CV_8UC3, cv::Scalar::all(40 * i + 20)));
  }
  PictureFiles video = open("film.avi", false);
  for (const int i : {0, 3, 3, 1, 4}) EXPECT_NEAR(grey_of(video.at(i)), 40 * i + 20, 4) << i;
  EXPECT_TRUE(video.at(5).empty());
  PictureFiles endless = open("film.avi", true);
  EXPECT_NEAR(grey_of(endless.at(7)), 40 * 2 + 20, 4);
}

TEST_F(PictureFilesTest, RefusesWhatNobodyCanSee) {
  EXPECT_THROW(static_cast<void>(open(".", false)), VideoError) << "an empty folder";
  std::ofstream(folder_.path() / "film.mp4") << "this is no video";
  EXPECT_THROW(static_cast<void>(open("film.mp4", false)), VideoError);
  std::ofstream(folder_.path() / "broken.png") << "\x89PNG\r\n\x1a\n broken";
  EXPECT_THROW(static_cast<void>(open("broken.png", false)), VideoError);
}

}  // namespace
}  // namespace constrictor::video
