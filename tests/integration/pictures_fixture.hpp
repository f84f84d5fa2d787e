// The recordings from which the tests of `constrictor figure` and `constrictor film` make pictures.
#pragma once

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class Pictures : public CliFixture {
 protected:
  /// A run of 0.8 s, recorded once for all tests: its report directory.
  static const fs::path& run(const std::string& images) {
    static const TemporaryFolder kFolder;
    static std::map<std::string, fs::path> runs;
    auto& made = runs[images];
    if (!made.empty()) return made;
    made = kFolder.path() / images;
    Process process({program("constrictor"), "run", "case_study", "--max-sim-time", "0.8", "--in-process", "--report",
                     made.string(), "--record", "--images", images},
                    {{"XDG_RUNTIME_DIR", kFolder.path().string()}});
    EXPECT_TRUE(process.wait(60s).has_value());
    return made;
  }
  [[nodiscard]] std::string out(const std::string& name) const { return (dir_ / name).string(); }
  [[nodiscard]] std::string content(const std::string& name) const {
    std::ifstream stream(dir_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  [[nodiscard]] bool says(const std::string& text) const { return output_.find(text) != std::string::npos; }
  /// All frames, as FFmpeg decodes them.
  [[nodiscard]] std::vector<cv::Mat> frames_of(const std::string& name) const {
    cv::VideoCapture film(out(name), cv::CAP_FFMPEG);
    std::vector<cv::Mat> frames;
    for (cv::Mat frame; film.read(frame);) frames.push_back(frame.clone());
    return frames;
  }
  static double difference(const cv::Mat& a, const cv::Mat& b) {
    return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total());
  }
};

}  // namespace constrictor::testing
