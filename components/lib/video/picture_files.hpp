// Pictures from a file or a folder, by number: the same pictures at the same ticks in each run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "video/video_source.hpp"

namespace cv {
class VideoCapture;
}

namespace constrictor::video {

class PictureFiles {
 public:
  /// A source that is not live(). Throws VideoError if nothing in it can be read.
  PictureFiles(const VideoSource& source, bool repeat);
  ~PictureFiles();

  /// Picture `index`, from 0, BGR with 8 bit for each channel, valid until the next call; empty after the last one.
  /// Throws VideoError if the picture cannot be read.
  const cv::Mat& at(std::int64_t index);

 private:
  const cv::Mat& picture(std::int64_t index);
  const cv::Mat& video_frame(std::int64_t index);
  void open_video();

  VideoSource source_;
  bool repeat_;
  std::vector<std::filesystem::path> pictures_;  ///< empty: the source is a video
  std::unique_ptr<cv::VideoCapture> video_;
  std::int64_t read_ = 0;     ///< frames of the video that were read since it was opened
  std::int64_t length_ = -1;  ///< frames of the video; -1: not known yet
  std::int64_t shown_ = -1;
  cv::Mat bgr_;
};

}  // namespace constrictor::video
