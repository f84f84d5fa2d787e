#include "bench/perception_study/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace constrictor::perception_study {
namespace {

using figure::Align;
using figure::Canvas;
using figure::Colour;
using figure::Rect;

constexpr int kColumns = 4;
constexpr double kPanelWidth = 330.0, kPanelHeight = 366.0;
constexpr double kHeader = 66.0, kMargin = 12.0;
constexpr double kLeft = 46.0, kRight = 14.0, kTop = 36.0;  // of the strips in a panel
constexpr double kGap = 27.0;
constexpr Colour kBlue{0.0, 0.447, 0.698}, kOrange{0.835, 0.369, 0.0}, kGreen{0.0, 0.620, 0.451};  // Okabe and Ito

// Objects that were dropped farther away are drawn at the top, with their distance: the axis stays readable.
constexpr double kFarthest_m = 0.6;

/// One quantity over the levels.
struct Strip {
  std::string label;
  Colour colour;
  double height;  ///< of its area
  double full;    ///< value at the top
  double step;    ///< between marked values
  int decimals;
};

struct Value {
  double low, middle, high;
};

Value value_of(const LevelResult& level, int strip) {
  if (strip == 0) {
    const double share = static_cast<double>(level.successes) / static_cast<double>(level.runs);
    return {100 * level.wilson_low, 100 * share, 100 * level.wilson_high};
  }
  const Quartiles& quartiles = strip == 1 ? level.placement_m : level.time_s;
  return {quartiles.low, quartiles.median, quartiles.high};
}

/// The least of 1, 2, 5 times a power of ten of which `count` reach `value`.
double step_to(double value, int count) {
  double step = 1e-3;
  for (const double factors[] = {2.0, 2.5, 2.0}; count * step < value;) {
    for (const double factor : factors) {
      if (count * step < value) step *= factor;
    }
  }
  return step;
}

std::vector<Strip> strips_for(const std::vector<std::vector<LevelResult>>& results) {
  double placement_m = 0.1, time_s = 100.0;
  for (const auto& factor : results) {
    for (const auto& level : factor) {
      if (std::isfinite(level.placement_m.high)) placement_m = std::max(placement_m, level.placement_m.high);
      if (std::isfinite(level.time_s.high)) time_s = std::max(time_s, level.time_s.high);
    }
  }
  placement_m = std::min(placement_m, kFarthest_m);
  const double placement_step = step_to(placement_m, 3), time_step = step_to(time_s, 3);
  return {{"missions that succeed [%]", kBlue, 96.0, 100.0, 25.0, 0},
          {"placement [m]", kOrange, 52.0, 3 * placement_step, placement_step, placement_step < 0.1 ? 2 : 1},
          {"time [s]", kGreen, 52.0, 3 * time_step, time_step, 0}};
}

void draw_strip(Canvas& canvas, const Rect& area, const Strip& strip, int index,
                const std::vector<LevelResult>& levels) {
  const auto y_of = [&](double value) {
    return area.y + area.height * (1.0 - std::clamp(value / strip.full, 0.0, 1.0));
  };
  for (double value = 0.0; value <= strip.full * 1.0001; value += strip.step) {
    canvas.line({area.x, y_of(value)}, {area.x + area.width, y_of(value)}, figure::kFaint, 1.0);
    canvas.text(fmt::format("{:.{}f}", value, strip.decimals), {area.x - 6.0, y_of(value) + 3.5},
                {9.5, figure::kGreyInk, false, Align::kRight});
  }
  canvas.text(strip.label, {area.x, area.y - 9.0}, {10.5, strip.colour, true});
  const double each = area.width / static_cast<double>(levels.size());
  std::vector<figure::Point> line;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double x = area.x + (static_cast<double>(i) + 0.5) * each;
    const Value value = value_of(levels[i], index);
    if (!std::isfinite(value.middle)) {
      canvas.text("none", {x, area.y + area.height - 4.0}, {9.5, figure::kGreyInk, false, Align::kCentre});
      continue;
    }
    canvas.line({x, y_of(value.low)}, {x, y_of(value.high)}, strip.colour, 1.2);
    for (const double end : {value.low, value.high})
      canvas.line({x - 4.0, y_of(end)}, {x + 4.0, y_of(end)}, strip.colour, 1.2);
    line.push_back({x, y_of(value.middle)});
  }
  canvas.polyline(line, {area.x, area.y - 2.0, area.width, area.height + 4.0}, strip.colour, 2.0);
  for (std::size_t i = 0, at = 0; i < levels.size(); ++i) {
    if (!std::isfinite(value_of(levels[i], index).middle)) continue;
    const figure::Point& point = line[at++];
    // Hollow: without the error.
    canvas.fill({point.x - 4.0, point.y - 4.0, 8.0, 8.0}, strip.colour);
    const double value = value_of(levels[i], index).middle;
    if (value > strip.full)
      canvas.text(fmt::format("{:.1f}", value), {point.x + 7.0, point.y + 9.0}, {9.5, strip.colour, true});
    if (levels[i].reference) canvas.fill({point.x - 2.4, point.y - 2.4, 4.8, 4.8}, figure::kWhite);
  }
}

void draw_panel(Canvas& canvas, const Rect& panel, const Factor& factor, const std::vector<Strip>& strips,
                const std::vector<LevelResult>& levels) {
  canvas.text(factor.title, {panel.x + kLeft, panel.y + 8.0}, {14.0, figure::kInk, true});
  double top = panel.y + kTop;
  const double width = panel.width - kLeft - kRight;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    draw_strip(canvas, {panel.x + kLeft, top, width, strips[i].height}, strips[i], static_cast<int>(i), levels);
    top += strips[i].height + kGap;
  }
  const double each = width / static_cast<double>(levels.size());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double x = panel.x + kLeft + (static_cast<double>(i) + 0.5) * each;
    canvas.text(fmt::format("{:g}", levels[i].level), {x, top - 6.0}, {11.0, figure::kInk, false, Align::kCentre});
    canvas.text(fmt::format("n = {}", levels[i].runs), {x, top + 6.5}, {8.5, figure::kGreyInk, false, Align::kCentre});
  }
  canvas.text(canvas.fitted(factor.axis, width, {11.0}), {panel.x + kLeft + 0.5 * width, top + 21.0},
              {11.0, figure::kInk, false, Align::kCentre});
}

}  // namespace

std::string draw(figure::Format format, const std::string& title, const std::vector<Factor>& factors,
                 const std::vector<std::vector<LevelResult>>& results) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < factors.size(); ++i)
    if (!results[i].empty()) shown.push_back(i);
  const int rows = std::max(1, (static_cast<int>(shown.size()) + kColumns - 1) / kColumns);
  const double width = kColumns * kPanelWidth + 2 * kMargin, height = kHeader + rows * kPanelHeight + kMargin;
  Canvas canvas(format, width, height, 1.0, title);
  canvas.fill({0.0, 0.0, width, height}, figure::kWhite);
  canvas.text(title, {kMargin + 12.0, 26.0}, {17.0, figure::kInk, true});
  canvas.text(
      "Hollow marks: runs without the error, the same in all panels. Bars: 95 % interval (Wilson) of the success, "
      "quartiles of placement and time. n: missions.",
      {kMargin + 12.0, 46.0}, {12.0, figure::kGreyInk});
  const std::vector<Strip> strips = strips_for(results);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const std::size_t column = k % kColumns, row = k / kColumns;
    const Rect panel{kMargin + static_cast<double>(column) * kPanelWidth,
                     kHeader + static_cast<double>(row) * kPanelHeight + 8.0, kPanelWidth, kPanelHeight};
    draw_panel(canvas, panel, factors[shown[k]], strips, results[shown[k]]);
  }
  return canvas.finish();
}

}  // namespace constrictor::perception_study
