#include "camera_setup/command_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "configuration/whole_file.hpp"

namespace constrictor::camera_setup {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr auto kFrameBound = 5000ms;  // longest wait for a frame of a live source

}  // namespace

bool stopped() { return g_signal != 0; }

FrameReader reader_of(const Options& options) {
  return {video::parse_source(options.source, fs::current_path(), fs::current_path()), options.device};
}

std::optional<cv::Mat> next(FrameReader& reader) {
  auto picture = reader.next(kFrameBound, stopped);
  for (const auto& one : reader.news()) fmt::print(stderr, "{}\n", one.text);
  if (!picture && reader.live() && !stopped())
    throw video::VideoError(fmt::format(
        "{} for {} s: {}", reader.counters().openings == 0 ? "the source could not be opened" : "no frame",
        kFrameBound.count() / 1000,
        reader.counters().failures > 0
            ? "the reason is above; is the name of --source right, and is the camera switched on and connected?"
            : "the source does not answer; does another program use it, and does a player such as ffplay show it?"));
  return picture;
}

void require_writable(const fs::path& file) {
  if (fs::is_directory(file)) throw Failed(fmt::format("--out: found the folder {}, accepted a file", file.string()));
  const NewFile probe = NewFile::of_this_process(file);  // removes its part
  errno = 0;
  if (!std::ofstream(probe.part()))
    throw Failed(fmt::format("--out: cannot write {}: {}; does its folder exist, and may you write there?",
                             file.string(), std::strerror(errno)));
}

std::string wrong_picture_name(const std::string& file) {
  static const std::vector<std::string> kEndings = {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp"};
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end() && cv::haveImageWriter(ending)) return {};
  return fmt::format("found '{}', accepted a name with one of the endings {}", file, fmt::join(kEndings, ", "));
}

void write(const fs::path& file, const std::string& text) {
  try {
    write_whole(file, text);
  } catch (const std::runtime_error& error) {
    throw Failed(error.what());
  }
  fmt::print("wrote {}\n", file.string());
}

}  // namespace constrictor::camera_setup
