#include "sim/camera/camera_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "component/random.hpp"

namespace constrictor {
namespace {

constexpr double kFullIntensity = 255.0 * 255.0;
constexpr int kInstants = 7;  // of an exposure

Eigen::Isometry3d extrapolated(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, double share) {
  const Eigen::AngleAxisd turn(now.linear() * before.linear().transpose());
  Eigen::Isometry3d later = now;
  later.linear() = Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix() * now.linear();
  later.translation() += share * (now.translation() - before.translation());
  return later;
}

}  // namespace

bool image_is_dropped(double dropped_share, std::uint64_t seed, std::int64_t tick) {
  if (dropped_share <= 0.0) return false;
  return Random(seed + static_cast<std::uint64_t>(tick), "dropped images").uniform() < dropped_share;
}

std::vector<double> exposure_instants(double exposure_s) {
  if (exposure_s <= 0.0) return {0.0};
  std::vector<double> instants;
  // The middles of equal parts of the exposure.
  for (int i = 0; i < kInstants; ++i) instants.push_back(exposure_s * ((i + 0.5) / kInstants - 0.5));
  return instants;
}

ScenePoses extrapolated(const ScenePoses& before, const ScenePoses& now, double share) {
  ScenePoses later = now;
  for (std::size_t i = 0; i < now.X_WModule.size(); ++i)
    later.X_WModule[i] = extrapolated(before.X_WModule[i], now.X_WModule[i], share);
  for (std::size_t i = 0; i < now.X_WObject.size(); ++i)
    later.X_WObject[i] = extrapolated(before.X_WObject[i], now.X_WObject[i], share);
  return later;
}

bool ImageErrors::change_single_frames() const {
  return config_.blur_pixels > 0.0 || config_.gain != 1.0 || config_.red_gain != 1.0 || config_.blue_gain != 1.0 ||
         config_.contrast != 1.0;
}

void ImageErrors::begin(std::size_t frames) {
  frames_ = frames;
  sums_.clear();
}

void ImageErrors::expose(const std::vector<std::uint8_t>& rgb) {
  sums_.resize(rgb.size(), 0);
  for (std::size_t i = 0; i < rgb.size(); ++i) sums_[i] += static_cast<std::uint32_t>(rgb[i]) * rgb[i];
}

void ImageErrors::finish(int width, std::vector<std::uint8_t>& rgb) {
  intensities_.resize(sums_.size());
  std::transform(sums_.begin(), sums_.end(), intensities_.begin(),
                 [this](std::uint32_t sum) { return static_cast<std::uint16_t>((sum + frames_ / 2) / frames_); });
  if (config_.blur_pixels > 0.0) {
    const int rows = static_cast<int>(intensities_.size()) / (3 * width);
    cv::Mat image(rows, width, CV_16UC3, intensities_.data());
    cv::GaussianBlur(image, image, cv::Size(), config_.blur_pixels, config_.blur_pixels, cv::BORDER_REPLICATE);
  }
  const std::array<double, 3> gains{config_.gain * config_.red_gain, config_.gain, config_.gain * config_.blue_gain};
  rgb.resize(intensities_.size());
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const double value = std::sqrt(std::min(gains[i % 3] * intensities_[i], kFullIntensity));
    const double shown = 127.5 + config_.contrast * (value - 127.5);
    rgb[i] = static_cast<std::uint8_t>(std::clamp(std::floor(shown + 0.5), 0.0, 255.0));
  }
}

}  // namespace constrictor
