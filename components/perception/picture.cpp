#include "perception/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "constrictor/colours.hpp"
#include "perception/perception_config.hpp"

namespace constrictor::perception {
namespace {

const std::array<cv::Vec3b, msg::kColourCount> kPaint = [] {
  std::array<cv::Vec3b, msg::kColourCount> paint;
  for (std::uint8_t colour = 0; colour < msg::kColourCount; ++colour)
    std::copy_n(look_of(colour).screen.begin(), 3, paint[colour].val);
  return paint;
}();

void dim_row(const std::uint8_t* in, std::uint8_t* out, int bytes) {
  // With numbers of 16 bits the compiler can use vector instructions.
  for (int i = 0; i < bytes; ++i) {
    out[i] = static_cast<std::uint8_t>(static_cast<std::uint16_t>(2 * in[i]) / std::uint16_t{5});
  }
}

/// Paints the pixels that have a colour.
void paint_row(const cv::Vec3b* in, const std::uint8_t* labels, cv::Vec3b* out, int pixels) {
  for (int u = 0; u < pixels; ++u) {
    std::uint64_t eight = 1;  // labels; most are 0
    if (u + 8 <= pixels) std::memcpy(&eight, labels + u, sizeof eight);
    if (eight == 0) {
      u += 7;
      continue;
    }
    if (labels[u] == msg::kColourUnknown || labels[u] == kDazzled) continue;
    for (int c = 0; c < 3; ++c) out[u][c] = static_cast<std::uint8_t>((in[u][c] + 2 * kPaint[labels[u]][c]) / 4);
  }
}

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

std::string label_of(const msg::Blob& blob) {
  const char* kind = blob.kind == msg::kBlobObject ? "object" : blob.kind == msg::kBlobZone ? "zone" : "?";
  std::array<char, 48> text{};
  if (std::isfinite(blob.range_m)) {
    std::snprintf(text.data(), text.size(), "%s %.2f m", kind, blob.range_m);
  } else {
    std::snprintf(text.data(), text.size(), "%s", kind);
  }
  return text.data();
}

/// A place of this size inside `image` that touches none of the `taken` ones: as near as possible above or below
/// `wanted`. If there is none, `wanted` inside the image.
cv::Rect free_place(cv::Rect wanted, const cv::Rect& image, const std::vector<cv::Rect>& taken) {
  const int right = image.x + image.width - wanted.width, bottom = image.y + image.height - wanted.height;
  wanted.x = std::max(std::min(wanted.x, right), image.x);
  wanted.y = std::max(std::min(wanted.y, bottom), image.y);
  const auto is_free = [&](const cv::Rect& place) {
    return std::none_of(taken.begin(), taken.end(), [&](const cv::Rect& other) { return (place & other).area() > 0; });
  };
  for (int shift = 0; shift < image.height; ++shift) {
    for (const int y : {wanted.y - shift, wanted.y + shift}) {
      const cv::Rect place(wanted.x, y, wanted.width, wanted.height);
      if (y >= image.y && y <= bottom && is_free(place)) return place;
    }
  }
  return wanted;
}

void draw_blobs(cv::Mat& picture, const msg::ObjectPercepts& objects) {
  constexpr double kSize = 0.7;
  const int cut = picture.rows / 24;  // figures and films cut this much off an image of 4:3
  const cv::Rect inside(0, cut, picture.cols, picture.rows - 2 * cut);
  std::vector<cv::Rect> labels;
  for (int i = 0; i < objects.blob_count; ++i) {
    const msg::Blob& blob = objects.blobs[i];
    const cv::Vec3b& paint = kPaint[blob.colour];
    cv::rectangle(picture, cv::Point(blob.u_min, blob.v_min), cv::Point(blob.u_max, blob.v_max),
                  cv::Scalar(paint[0], paint[1], paint[2]), 1, cv::LINE_8);
  }
  for (int i = 0; i < objects.blob_count; ++i) {
    const msg::Blob& blob = objects.blobs[i];
    const std::string text = label_of(blob);
    int below = 0;  // the baseline
    const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_PLAIN, kSize, 1, &below);
    const int height = size.height + below;
    const int above = blob.v_min - 1 - height;
    const cv::Rect wanted(blob.u_min, above >= inside.y ? above : blob.v_max + 2, size.width + 1, height);
    labels.push_back(free_place(wanted, inside, labels));
    cv::putText(picture, text, {labels.back().x, labels.back().y + size.height}, cv::FONT_HERSHEY_PLAIN, kSize,
                cv::Scalar(255, 255, 255), 1, cv::LINE_8);
  }
}

/// Marks where obstacles stand on the ground.
void draw_obstacles(cv::Mat& picture, const GroundCamera& camera, const msg::ObjectPercepts& objects) {
  for (int i = 0; i < objects.obstacle_count; ++i) {
    const auto pixel = camera.pixel(Eigen::Vector2d(objects.obstacle_x_m[i], objects.obstacle_y_m[i]));
    if (!pixel || !camera.inside(*pixel)) continue;
    const cv::Point foot(static_cast<int>(pixel->x()), static_cast<int>(pixel->y()));
    cv::line(picture, foot - cv::Point(0, 3), foot + cv::Point(0, 3), cv::Scalar(255, 255, 255), 2, cv::LINE_8);
  }
}

}  // namespace

void draw_percepts(const cv::Mat& rgb, const cv::Mat& labels, const GroundCamera& camera, const msg::LinePercept& line,
                   const msg::ObjectPercepts& objects, cv::Mat& picture) {
  picture.create(rgb.size(), CV_8UC3);
  for (int v = 0; v < rgb.rows; ++v) {
    dim_row(rgb.ptr<std::uint8_t>(v), picture.ptr<std::uint8_t>(v), 3 * rgb.cols);
    paint_row(rgb.ptr<cv::Vec3b>(v), labels.ptr<std::uint8_t>(v), picture.ptr<cv::Vec3b>(v), rgb.cols);
  }
  const double left = camera.horizon_row(0.0), right = camera.horizon_row(rgb.cols);
  if (std::abs(left) < 1e4 && std::abs(right) < 1e4) {
    cv::line(picture, {0, static_cast<int>(left)}, {rgb.cols - 1, static_cast<int>(right)}, cv::Scalar(90, 90, 110), 1,
             cv::LINE_8);
  }
  draw_obstacles(picture, camera, objects);
  draw_blobs(picture, objects);
  draw_line(picture, camera, line);
}

}  // namespace constrictor::perception
