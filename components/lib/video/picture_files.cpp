#include "video/picture_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

namespace constrictor::video {
namespace {

constexpr int kLargest = 4096;  // [pixel] width and height

/// The pictures of a folder in the order of their names; no other file belongs to them.
std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file() && cv::haveImageReader(entry.path().string())) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

PictureFiles::PictureFiles(const VideoSource& source, bool repeat) : source_(source), repeat_(repeat) {
  if (source.kind == SourceKind::kFolder) {
    pictures_ = pictures_in(source.path);
    if (pictures_.empty())
      throw VideoError(
          fmt::format("{}: found no picture, accepted a folder with files such as PNG or JPEG", source.path.string()));
  } else if (cv::haveImageReader(source.path.string())) {
    pictures_.push_back(source.path);
  } else {
    open_video();
  }
  if (at(0).empty())
    throw VideoError(
        fmt::format("{}: found a video without a frame, accepted one that ffplay can show", source_.path.string()));
}

PictureFiles::~PictureFiles() = default;

void PictureFiles::open_video() {
  video_ = std::make_unique<cv::VideoCapture>(source_.path.string(), cv::CAP_FFMPEG);
  read_ = 0;
  if (!video_->isOpened())
    throw VideoError(fmt::format("{}: found neither a picture nor a video, accepted a file that ffplay can show",
                                 source_.path.string()));
}

const cv::Mat& PictureFiles::picture(std::int64_t index) {
  const auto count = static_cast<std::int64_t>(pictures_.size());
  if (index >= count && !repeat_) return bgr_ = cv::Mat();
  const auto& file = pictures_[static_cast<std::size_t>(index % count)];
  if (index == shown_) return bgr_;
  bgr_ = cv::imread(file.string(), cv::IMREAD_COLOR);
  if (bgr_.empty() || bgr_.cols > kLargest || bgr_.rows > kLargest)
    throw VideoError(
        fmt::format("{}: cannot be read as a picture of at most {} x {} pixels", file.string(), kLargest, kLargest));
  return bgr_;
}

const cv::Mat& PictureFiles::video_frame(std::int64_t index) {
  if (repeat_ && length_ > 0) index %= length_;
  if (length_ >= 0 && index >= length_) return bgr_ = cv::Mat();
  if (index < read_ && index + 1 != read_) open_video();  // frames can only be read in their order
  while (read_ <= index) {
    if (!video_->read(bgr_) || bgr_.empty()) {
      length_ = read_;
      if (repeat_ && length_ > 0) return video_frame(index);
      return bgr_ = cv::Mat();
    }
    ++read_;
  }
  return bgr_;
}

const cv::Mat& PictureFiles::at(std::int64_t index) {
  const cv::Mat& found = pictures_.empty() ? video_frame(index) : picture(index);
  shown_ = index;
  return found;
}

}  // namespace constrictor::video
