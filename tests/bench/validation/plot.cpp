#include "bench/validation/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "bench/validation/drawing.hpp"

namespace constrictor::validation {
namespace {

constexpr int kPanelWidth = 520;
constexpr int kPanelHeight = 330;
constexpr int kHeader = 46;
constexpr int kKeyRow = 17;

cv::Scalar colour_of(std::size_t series) {
  static const std::array<cv::Scalar, 6> kColours{cv::Scalar(45, 40, 38),   cv::Scalar(40, 60, 215),
                                                  cv::Scalar(170, 95, 40),  cv::Scalar(60, 150, 60),
                                                  cv::Scalar(30, 150, 235), cv::Scalar(150, 60, 150)};
  return kColours[series % kColours.size()];
}

/// An axis that begins and ends at multiples of its step.
struct Axis {
  double from = 0.0;
  double to = 1.0;
  double step = 0.2;

  [[nodiscard]] int steps() const { return static_cast<int>(std::lround((to - from) / step)); }
  [[nodiscard]] double tick(int i) const { return from + i * step; }
  [[nodiscard]] std::string label(double value) const {
    return fmt::format("{:.6g}", std::abs(value) < 1e-9 * step ? 0.0 : value);
  }
};

Axis axis_around(double least, double most) {
  if (!(most > least)) {
    least -= 0.5;
    most += 0.5;
  }
  const double raw = (most - least) / 5.0;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= raw * 0.999) step = factor * power;
  }
  return {std::floor(least / step + 1e-6) * step, std::ceil(most / step - 1e-6) * step, step};
}

struct Panel {
  Axis x_axis, y_axis;
  int left, top, width, height;  // of the area inside the axes
  [[nodiscard]] double x(double value) const {
    return left + width * (value - x_axis.from) / (x_axis.to - x_axis.from);
  }
  [[nodiscard]] double y(double value) const {
    return top + height * (1.0 - (value - y_axis.from) / (y_axis.to - y_axis.from));
  }
};

void draw_axes(cv::Mat& canvas, const Panel& panel, const Plot& plot) {
  cv::rectangle(canvas, scaled_rect(panel.left, panel.top, panel.width, panel.height), cv::Scalar(252, 252, 252),
                cv::FILLED);
  const Axis& x = panel.x_axis;
  for (int i = 0; i <= x.steps(); ++i) {
    const double value = x.tick(i);
    cv::line(canvas, scaled(panel.x(value), panel.top), scaled(panel.x(value), panel.top + panel.height), kFaint,
             kScale / 2, cv::LINE_AA);
    text(canvas, x.label(value), panel.x(value), panel.top + panel.height + 16, 0.78, kGreyInk, false, Align::kCentre);
  }
  const Axis& y = panel.y_axis;
  for (int i = 0; i <= y.steps(); ++i) {
    const double value = y.tick(i);
    cv::line(canvas, scaled(panel.left, panel.y(value)), scaled(panel.left + panel.width, panel.y(value)),
             std::abs(value) < 1e-9 * y.step ? kFrame : kFaint, kScale / 2, cv::LINE_AA);
    text(canvas, y.label(value), panel.left - 6, panel.y(value) + 4, 0.78, kGreyInk, false, Align::kRight);
  }
  cv::rectangle(canvas, scaled_rect(panel.left, panel.top, panel.width, panel.height), kFrame, kScale / 2);
  text(canvas, plot.x_label, panel.left + panel.width / 2.0, panel.top + panel.height + 34, 0.85, kInk, false,
       Align::kCentre);
  text(canvas, plot.y_label, panel.left - 44, panel.top - 12, 0.85, kInk);
}

void draw_series(cv::Mat& canvas, const Panel& panel, const Series& series, const cv::Scalar& colour, int dot_radius) {
  std::vector<cv::Point> points;
  for (std::size_t i = 0; i < series.x.size(); ++i)
    points.push_back(scaled(panel.x(series.x[i]), panel.y(series.y[i])));
  if (series.mark != Mark::kDots) cv::polylines(canvas, points, false, colour, kScale, cv::LINE_AA);
  if (series.mark == Mark::kLine) return;
  for (const cv::Point& point : points) cv::circle(canvas, point, dot_radius, colour, cv::FILLED, cv::LINE_AA);
}

void draw_plot(cv::Mat& canvas, const Plot& plot, int left, int top) {
  double least_x = INFINITY;
  double most_x = -INFINITY;
  double least_y = plot.from_zero ? 0.0 : INFINITY;
  double most_y = plot.from_zero ? 0.0 : -INFINITY;
  int keys = 0;
  for (const Series& series : plot.series) {
    keys += series.name.empty() ? 0 : 1;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      least_x = std::min(least_x, series.x[i]);
      most_x = std::max(most_x, series.x[i]);
      least_y = std::min(least_y, series.y[i]);
      most_y = std::max(most_y, series.y[i]);
    }
  }
  text(canvas, plot.title, left + 16, top + 20, 1.0, kInk, true);
  const int above = 52 + kKeyRow * keys;
  const Panel panel{
      axis_around(least_x, most_x), axis_around(least_y, most_y), left + 60, top + above, kPanelWidth - 84,
      kPanelHeight - above - 42};
  draw_axes(canvas, panel, plot);
  double key_y = top + 38;
  int dot_radius = 5 * kScale;  // less for each series of dots, so that dots on the same place remain visible
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    draw_series(canvas, panel, plot.series[i], colour_of(i),
                plot.series[i].mark == Mark::kDots ? dot_radius : 3 * kScale);
    if (plot.series[i].mark == Mark::kDots) dot_radius = std::max(2, dot_radius - 2 * kScale);
    if (plot.series[i].name.empty()) continue;
    if (plot.series[i].mark != Mark::kDots)
      cv::line(canvas, scaled(left + 18, key_y - 4), scaled(left + 40, key_y - 4), colour_of(i), kScale, cv::LINE_AA);
    if (plot.series[i].mark != Mark::kLine)
      cv::circle(canvas, scaled(left + 29, key_y - 4), 4 * kScale, colour_of(i), cv::FILLED, cv::LINE_AA);
    text(canvas, plot.series[i].name, left + 48, key_y, 0.85, kInk);
    key_y += kKeyRow;
  }
}

}  // namespace

cv::Mat draw(const Figure& figure) {
  const int columns = figure.plots.size() > 1 ? 2 : 1;
  const int rows = (static_cast<int>(figure.plots.size()) + columns - 1) / columns;
  cv::Mat canvas = make_canvas(columns * kPanelWidth + 10, kHeader + rows * kPanelHeight + 12);
  text(canvas, fitted(figure.title, 1.2, columns * kPanelWidth - 20), 16, 30, 1.2, kInk, true);
  for (std::size_t i = 0; i < figure.plots.size(); ++i) {
    const auto place = static_cast<int>(i);
    draw_plot(canvas, figure.plots[i], (place % columns) * kPanelWidth, kHeader + (place / columns) * kPanelHeight);
  }
  cv::Mat rgb;
  cv::cvtColor(reduced(canvas), rgb, cv::COLOR_BGR2RGB);
  return rgb;
}

}  // namespace constrictor::validation
