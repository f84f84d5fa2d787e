// A film in an MP4 file, written by FFmpeg through OpenCV.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/videoio.hpp>
#include <string>

namespace constrictor::pictures {

/// The film is written into a file beside `file` (name.part.mp4) and gets its name when it is complete: an older film
/// stays until then.
class FilmFile {
 public:
  /// H.264 if FFmpeg has an encoder for it, else MPEG-4. Throws std::runtime_error if neither can be written there.
  FilmFile(const std::filesystem::path& file, double rate_hz, int width, int height);
  /// Removes an incomplete film.
  ~FilmFile();
  FilmFile(const FilmFile&) = delete;
  FilmFile& operator=(const FilmFile&) = delete;

  /// Adds a frame of 4 bytes for each pixel: blue, green, red, unused. Returns false, and adds nothing, if the disk is
  /// so full that the film could not be completed any more.
  [[nodiscard]] bool add(const std::uint8_t* bgra);
  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] const std::string& codec() const { return codec_; }
  /// Completes the film and checks that it opens with all its frames. Throws std::runtime_error. Without a frame,
  /// nothing is left and the function returns false.
  [[nodiscard]] bool finish();

 private:
  std::filesystem::path file_, part_;
  int width_, height_;
  cv::Mat rows_;  ///< a frame, with black pixels beyond the end of its rows
  std::string codec_;
  cv::VideoWriter writer_;
  std::uint64_t frames_ = 0;
};

}  // namespace constrictor::pictures
