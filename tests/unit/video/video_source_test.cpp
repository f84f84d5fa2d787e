#include "video/video_source.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.hpp"
#include "video/video_device.hpp"

namespace constrictor::video {
namespace {

using testing::TemporaryFolder;

std::string refusal_of(const std::string& text, const std::filesystem::path& folder) {
  try {
    static_cast<void>(parse_source(text, folder, folder));
  } catch (const VideoError& error) {
    return error.what();
  }
  return {};
}

TEST(VideoSource, TellsTheKindsApart) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "film.mp4") << "x";
  const auto kind = [&](const std::string& text) { return parse_source(text, folder.path(), "/run").kind; };
  EXPECT_EQ(kind("/dev/video3"), SourceKind::kDevice);
  EXPECT_EQ(kind("http://10.0.0.7:8080/stream"), SourceKind::kNetwork);
  EXPECT_EQ(kind("RTSP://cam/1"), SourceKind::kNetwork);
  EXPECT_EQ(kind("v4l2src ! videoconvert ! appsink"), SourceKind::kPipeline);
  EXPECT_EQ(kind("film.mp4"), SourceKind::kFile);
  EXPECT_EQ(kind("."), SourceKind::kFolder);
  EXPECT_EQ(kind("camera.url"), SourceKind::kAddress);
  EXPECT_EQ(parse_source("camera.url", folder.path(), "/run").path, "/run/camera.url");
  EXPECT_FALSE(parse_source("film.mp4", folder.path(), "/run").live());
}

TEST(VideoSource, RefusesWhatItCannotRead) {
  const TemporaryFolder folder;
  EXPECT_NE(refusal_of("", folder.path()).find("accepted /dev/videoN"), std::string::npos);
  EXPECT_NE(refusal_of("ftp://host/file", folder.path()).find("found 'ftp://host/file'"), std::string::npos);
  EXPECT_NE(refusal_of("no_such.mp4", folder.path()).find("no such file"), std::string::npos);
}

TEST(VideoSource, NeverShowsAPassword) {
  EXPECT_EQ(without_password("rtsp://me:secret@cam/1?a=b@c"), "rtsp://***@cam/1?a=b@c");
  EXPECT_EQ(without_password("http://cam/a@b"), "http://cam/a@b");
  EXPECT_EQ(parse_source("rtsp://me:secret@cam/1", "/", "/").name(), "rtsp://***@cam/1");
  EXPECT_EQ(refusal_of("ftp://me:secret@cam/1", "/").find("secret"), std::string::npos);
}

TEST(VideoSource, ReadsTheAddressFromAFileOfTheRun) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "camera.url";
  EXPECT_THROW(static_cast<void>(read_address(file)), VideoError);
  std::ofstream(file) << "http://127.0.0.1:8080/stream \r\nmore\n";
  EXPECT_EQ(read_address(file), "http://127.0.0.1:8080/stream");
  std::ofstream(file) << "file:///etc/passwd\n";
  EXPECT_THROW(static_cast<void>(read_address(file)), VideoError);
}

TEST(VideoDevice, SaysWhyADeviceCannotBeOpened) {
  const TemporaryFolder folder;
  const auto reason = [](const VideoSource& source) -> std::string {
    try {
      static_cast<void>(opencv_video(source, {})());
    } catch (const VideoError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(reason({SourceKind::kDevice, "", "/dev/no_such_video"}).find("No such file"), std::string::npos);
  std::ofstream(folder.path() / "file") << "x";
  EXPECT_NE(reason({SourceKind::kDevice, "", folder.path() / "file"}).find("accepted a V4L2 device"),
            std::string::npos);
  EXPECT_NE(reason({SourceKind::kDevice, "", "/dev/null"}).find("cannot be opened"), std::string::npos);
  EXPECT_NE(reason({SourceKind::kNetwork, "http://127.0.0.1:9/none", {}}).find("cannot be opened"), std::string::npos);
  EXPECT_NE(reason({SourceKind::kPipeline, "no_such_element ! appsink", {}}).find("gst-launch"), std::string::npos);
}

}  // namespace
}  // namespace constrictor::video
