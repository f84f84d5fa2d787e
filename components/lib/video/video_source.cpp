#include "video/video_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string_view>

namespace constrictor::video {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> kSchemes = {"http", "https", "rtsp", "rtsps", "rtp", "udp", "tcp"};
constexpr const char* kAccepted =
    "/dev/videoN, an address (http, https, rtsp, rtsps, rtp, udp, tcp), a pipeline of GStreamer that ends in appsink, "
    "a file NAME.url, a video, a picture, or a folder of pictures";

/// The scheme of "http://...", in small letters; empty: there is none.
std::string scheme_of(const std::string& text) {
  const auto end = text.find("://");
  if (end == std::string::npos) return {};
  std::string scheme = text.substr(0, end);
  std::transform(scheme.begin(), scheme.end(), scheme.begin(), [](unsigned char c) { return std::tolower(c); });
  return scheme;
}

bool known_scheme(const std::string& scheme) {
  return std::find(kSchemes.begin(), kSchemes.end(), scheme) != kSchemes.end();
}

}  // namespace

std::string without_password(const std::string& address) {
  const auto scheme = address.find("://");
  if (scheme == std::string::npos) return address;
  const auto host = scheme + 3;
  const auto path = address.find_first_of("/?#", host);
  const auto at = address.substr(0, path).rfind('@');
  return at == std::string::npos || at < host ? address : address.substr(0, host) + "***@" + address.substr(at + 1);
}

std::string VideoSource::name() const { return text.empty() ? path.string() : without_password(text); }

std::string read_address(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!stream || !std::getline(stream, line))
    throw VideoError(
        fmt::format("{}: found no text, accepted a file whose first line is the address of a stream", file.string()));
  while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) line.pop_back();
  if (!known_scheme(scheme_of(line)))
    throw VideoError(fmt::format("{}: found '{}', accepted an address such as http://127.0.0.1:8080/stream",
                                 file.string(), without_password(line)));
  return line;
}

VideoSource parse_source(const std::string& text, const fs::path& folder, const fs::path& run_folder) {
  if (text.empty()) throw VideoError(fmt::format("source: found no text, accepted {}", kAccepted));
  VideoSource source;
  if (text.find('!') != std::string::npos && text.find("appsink") != std::string::npos) {
    source.kind = SourceKind::kPipeline;
    source.text = text;
    return source;
  }
  if (const std::string scheme = scheme_of(text); !scheme.empty()) {
    if (!known_scheme(scheme))
      throw VideoError(fmt::format("source: found '{}', accepted {}", without_password(text), kAccepted));
    source.kind = SourceKind::kNetwork;
    source.text = text;
    return source;
  }
  source.path = text;
  if (source.path.extension() == ".url") {
    source.kind = SourceKind::kAddress;
    if (source.path.is_relative()) source.path = run_folder / source.path;
    return source;
  }
  if (source.path.is_relative()) source.path = folder / source.path;
  if (text.starts_with("/dev/")) {
    source.kind = SourceKind::kDevice;
    return source;
  }
  if (!fs::exists(source.path))
    throw VideoError(fmt::format("source: found '{}', and no such file; accepted {}", source.path.string(), kAccepted));
  source.kind = fs::is_directory(source.path) ? SourceKind::kFolder : SourceKind::kFile;
  return source;
}

}  // namespace constrictor::video
