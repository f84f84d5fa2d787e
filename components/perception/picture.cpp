#include "perception/picture.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "perception/perception_config.hpp"

namespace constrictor::perception {
namespace {

const std::array<cv::Vec3b, msg::kColourCount> kPaint{
    {{128, 128, 128}, {60, 200, 60}, {220, 60, 60}, {60, 110, 230}, {220, 200, 60}}};

cv::Point rounded(const Eigen::Vector2d& p) {
  return {static_cast<int>(std::lround(p.x() - 0.5)), static_cast<int>(std::lround(p.y() - 0.5))};
}

void draw_line(cv::Mat& picture, const GroundCamera& camera, const msg::LinePercept& line) {
  std::vector<cv::Point> points;
  for (int i = 0; i < line.point_count; ++i) {
    if (const auto p = camera.pixel(Eigen::Vector2d(line.x_m[i], line.y_m[i]))) points.push_back(rounded(*p));
  }
  cv::polylines(picture, points, false, cv::Scalar(255, 255, 255), 1, cv::LINE_8);
  if (!line.visible) return;
  if (const auto p = camera.pixel(Eigen::Vector2d(line.lookahead_m, line.offset_m))) {
    cv::circle(picture, rounded(*p), 4, cv::Scalar(255, 160, 0), 1, cv::LINE_8);
  }
  if (line.end_visible && !points.empty()) {
    cv::drawMarker(picture, points.back(), cv::Scalar(255, 0, 255), cv::MARKER_TILTED_CROSS, 9, 1, cv::LINE_8);
  }
}

void draw_blob(cv::Mat& picture, const msg::Blob& blob) {
  const cv::Vec3b paint = kPaint[blob.colour];
  const cv::Scalar colour(paint[0], paint[1], paint[2]);
  cv::rectangle(picture, cv::Point(blob.u_min, blob.v_min), cv::Point(blob.u_max, blob.v_max), colour, 1, cv::LINE_8);
  const char* kind = blob.kind == msg::kBlobObject ? "object" : blob.kind == msg::kBlobZone ? "zone" : "?";
  std::array<char, 48> text{};
  if (std::isfinite(blob.range_m)) {
    std::snprintf(text.data(), text.size(), "%s %.2f m", kind, blob.range_m);
  } else {
    std::snprintf(text.data(), text.size(), "%s", kind);
  }
  const int above = blob.v_min > 10 ? blob.v_min - 3 : std::min(blob.v_max + 10, picture.rows - 2);
  cv::putText(picture, text.data(), {std::min<int>(blob.u_min, picture.cols - 70), above}, cv::FONT_HERSHEY_PLAIN, 0.7,
              cv::Scalar(255, 255, 255), 1, cv::LINE_8);
}

}  // namespace

cv::Mat draw_percepts(const cv::Mat& rgb, const cv::Mat& labels, const GroundCamera& camera,
                      const msg::LinePercept& line, const msg::ObjectPercepts& objects) {
  cv::Mat picture(rgb.size(), CV_8UC3);
  for (int v = 0; v < rgb.rows; ++v) {
    const cv::Vec3b* in = rgb.ptr<cv::Vec3b>(v);
    const std::uint8_t* label = labels.ptr<std::uint8_t>(v);
    cv::Vec3b* out = picture.ptr<cv::Vec3b>(v);
    for (int u = 0; u < rgb.cols; ++u) {
      for (int c = 0; c < 3; ++c) {
        out[u][c] =
            static_cast<std::uint8_t>(label[u] == 0 ? in[u][c] * 2 / 5 : (in[u][c] + 2 * kPaint[label[u]][c]) / 4);
      }
    }
  }
  const double left = camera.horizon_row(0.0), right = camera.horizon_row(rgb.cols);
  if (std::abs(left) < 1e4 && std::abs(right) < 1e4) {
    cv::line(picture, {0, static_cast<int>(left)}, {rgb.cols - 1, static_cast<int>(right)}, cv::Scalar(90, 90, 110), 1,
             cv::LINE_8);
  }
  for (int i = 0; i < objects.blob_count; ++i) draw_blob(picture, objects.blobs[i]);
  draw_line(picture, camera, line);
  return picture;
}

}  // namespace constrictor::perception
