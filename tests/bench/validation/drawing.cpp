#include "bench/validation/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace constrictor::validation {

cv::Mat make_canvas(int width, int height) {
  return {height * kScale, width * kScale, CV_8UC3, cv::Scalar(255, 255, 255)};
}

cv::Mat reduced(const cv::Mat& canvas) {
  cv::Mat figure;
  cv::resize(canvas, figure, {canvas.cols / kScale, canvas.rows / kScale}, 0, 0, cv::INTER_AREA);
  return figure;
}

cv::Point scaled(double x, double y) {
  return {static_cast<int>(std::lround(x * kScale)), static_cast<int>(std::lround(y * kScale))};
}

cv::Rect scaled_rect(int x, int y, int width, int height) {
  return {x * kScale, y * kScale, width * kScale, height * kScale};
}

void text(cv::Mat& canvas, const std::string& words, double x, double y, double size, const cv::Scalar& colour,
          bool bold, Align align) {
  const double font_scale = 0.5 * size * kScale;
  const int thickness = std::max(1, static_cast<int>(std::lround((bold ? 1.6 : 1.0) * size * kScale * 0.75)));
  int baseline = 0;
  const int font = bold ? cv::FONT_HERSHEY_DUPLEX : cv::FONT_HERSHEY_SIMPLEX;
  const cv::Size extent = cv::getTextSize(words, font, font_scale, thickness, &baseline);
  cv::Point origin = scaled(x, y);
  if (align == Align::kCentre) origin.x -= extent.width / 2;
  if (align == Align::kRight) origin.x -= extent.width;
  cv::putText(canvas, words, origin, font, font_scale, colour, thickness, cv::LINE_AA);
}

std::string fitted(std::string words, double size, double width) {
  const auto too_wide = [&](const std::string& candidate) {
    int baseline = 0;
    const cv::Size extent = cv::getTextSize(candidate, cv::FONT_HERSHEY_SIMPLEX, 0.5 * size * kScale, 1, &baseline);
    return extent.width > width * kScale;
  };
  if (!too_wide(words)) return words;
  while (!words.empty() && too_wide(words + "...")) words.pop_back();
  return words + "...";
}

std::string number(double value, int decimals) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  return buffer;
}

}  // namespace constrictor::validation
