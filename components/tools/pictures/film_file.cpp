#include "pictures/film_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace constrictor::pictures {
namespace {

namespace fs = std::filesystem;

// OpenCV does not say that FFmpeg could not write. The end of the file, its index, needs some room, too.
constexpr std::uintmax_t kLeastSpace_bytes = 16 << 20;
constexpr int kBeyond = 32;  // pixels: FFmpeg reads a little beyond the end of a row

}  // namespace

FilmFile::FilmFile(const fs::path& file, double rate_hz, int width, int height)
    : file_(file),
      part_(file),
      width_(width),
      height_(height),
      rows_(cv::Mat::zeros(height + kBeyond, width + kBeyond, CV_8UC3)) {
  part_.replace_extension(fmt::format(".{}.part{}", ::getpid(), file.extension().string()));
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "8", 0);  // only what is fatal: FFmpeg's notes are not for users
  ::setenv("OPENCV_FFMPEG_WRITER_LOGLEVEL", "8", 0);
  for (const auto& [fourcc, name] : {std::pair{cv::VideoWriter::fourcc('a', 'v', 'c', '1'), "H.264"},
                                     std::pair{cv::VideoWriter::fourcc('m', 'p', '4', 'v'), "MPEG-4"}}) {
    codec_ = name;
    if (writer_.open(part_.string(), cv::CAP_FFMPEG, fourcc, rate_hz, cv::Size(width, height))) return;
  }
  throw std::runtime_error(
      fmt::format("{}: FFmpeg cannot write an MP4 film of {} x {} pixels with {:g} frames in a second there",
                  part_.string(), width, height, rate_hz));
}

FilmFile::~FilmFile() {
  writer_.release();
  std::error_code ignored;
  fs::remove(part_, ignored);
}

bool FilmFile::add(const std::uint8_t* bgra) {
  if (frames_ % 10 == 0) {
    std::error_code error;
    const auto space = fs::space(part_.has_parent_path() ? part_.parent_path() : fs::path("."), error);
    if (!error && space.available < kLeastSpace_bytes) return false;
  }
  // OpenCV's matrix does not change the pixels.
  const cv::Mat pixels(height_, width_, CV_8UC4, const_cast<std::uint8_t*>(bgra));
  cv::Mat bgr = rows_(cv::Rect(0, 0, width_, height_));
  cv::cvtColor(pixels, bgr, cv::COLOR_BGRA2BGR);
  writer_.write(bgr);
  ++frames_;
  return true;
}

bool FilmFile::finish() {
  writer_.release();
  if (frames_ == 0) return false;
  cv::VideoCapture check(part_.string(), cv::CAP_FFMPEG);
  const double found = check.isOpened() ? check.get(cv::CAP_PROP_FRAME_COUNT) : 0.0;
  cv::Mat first;
  if (found != static_cast<double>(frames_) || !check.read(first) || first.cols != width_ || first.rows != height_)
    throw std::runtime_error(
        fmt::format("{}: found {:g} of {} frames after writing: is the disk full, or a quota reached?", part_.string(),
                    found, frames_));
  fs::rename(part_, file_);
  return true;
}

}  // namespace constrictor::pictures
