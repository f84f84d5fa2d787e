// The source of pictures, as one text.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace constrictor::video {

/// A source that cannot be used. The message says what was found, what is accepted and what to do.
class VideoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class SourceKind {
  kDevice,    ///< V4L2: "/dev/video0"
  kNetwork,   ///< "http://...", "rtsp://...", read with FFmpeg
  kPipeline,  ///< of GStreamer: "v4l2src ! videoconvert ! appsink"
  kAddress,   ///< a file NAME.url whose first line is the address of a network source
  kFolder,    ///< of pictures
  kFile,      ///< a video or a picture
};

struct VideoSource {
  SourceKind kind = SourceKind::kFile;
  std::string text;            ///< address or pipeline
  std::filesystem::path path;  ///< of a device, a folder or a file; absolute

  /// Frames arrive when they want. The other sources are read at the times of the run.
  [[nodiscard]] bool live() const { return kind != SourceKind::kFolder && kind != SourceKind::kFile; }
  /// The name of the source for people, without the password of an address.
  [[nodiscard]] std::string name() const;
};

/// Understands the text of a source. Relative paths of NAME.url files are in `run_folder`, other relative paths in
/// `folder`. Throws VideoError if the file or folder does not exist, or if the address has no known scheme; a device
/// and a file NAME.url may appear later.
[[nodiscard]] VideoSource parse_source(const std::string& text, const std::filesystem::path& folder,
                                       const std::filesystem::path& run_folder);

/// The address in a file NAME.url. Throws VideoError.
[[nodiscard]] std::string read_address(const std::filesystem::path& file);

/// An address without user and password.
[[nodiscard]] std::string without_password(const std::string& address);

}  // namespace constrictor::video
