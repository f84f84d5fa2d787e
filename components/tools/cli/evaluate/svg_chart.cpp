#include "cli/evaluate/svg_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "configuration/xml_escaped.hpp"

namespace constrictor::cli {
namespace {

constexpr double kWidth = 640;
constexpr double kLeft = 230, kRight = 120;  // of a bar chart: room for names and for texts behind the bars
constexpr double kBarHeight = 18, kBarGap = 8, kTop = 34, kBottom = 42;
constexpr double kKeyRow = 18;
constexpr double kCurveLeft = 64, kCurveRight = 20, kCurveHeight = 300;

std::string text(double x, double y, const std::string& words, const char* anchor = "start",
                 const std::string& more = {}) {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}"{}>{}</text>)", x, y, anchor,
                     more.empty() ? "" : " " + more, xml_escaped(words));
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" class="{}"/>)", x1, y1, x2, y2, style);
}

std::string begin(const std::string& title, double height) {
  return fmt::format(R"(<svg viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="{}">)", kWidth, height,
                     xml_escaped(title)) +
         text(0, 16, title, "start", R"(class="title")");
}

/// A round distance of about a fifth of the span.
double tick_step(double span) {
  const double rough = span / 5;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

struct Axis {
  double low = 0, high = 1, step = 0.2;
  double from = 0, to = 1;  // in the picture
  [[nodiscard]] double at(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

Axis make_axis(double low, double high, double from, double to) {
  if (!(high > low)) high = low + 1;
  Axis axis;
  axis.step = tick_step(high - low);
  axis.low = std::floor(low / axis.step + 1e-9) * axis.step;
  axis.high = std::ceil(high / axis.step - 1e-9) * axis.step;
  axis.from = from;
  axis.to = to;
  return axis;
}

std::vector<double> ticks(const Axis& axis) {
  std::vector<double> values;
  const auto count = static_cast<int>(std::lround((axis.high - axis.low) / axis.step));
  for (int i = 0; i <= count; ++i) values.push_back(axis.low + i * axis.step);
  return values;
}

std::string tick_text(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  return fmt::format("{:.{}f}", std::abs(value) < 1e-12 ? 0.0 : value, decimals);
}

/// Row `index` of a key that begins at (left, top).
std::string key_row(double left, double top, std::size_t index, const std::string& name) {
  const double y = top + kKeyRow * static_cast<double>(index) + 8;
  return fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="14" height="4" fill="{}"/>)", left, y - 4,
                     series_colour(index)) +
         text(left + 20, y, name);
}

std::string whisker(double x, double y_low, double y_high) {
  return line(x, y_low, x, y_high, "whisker") + line(x - 4, y_low, x + 4, y_low, "whisker") +
         line(x - 4, y_high, x + 4, y_high, "whisker");
}

std::string draw(const Curve& curve, std::size_t colour, const Axis& x, const Axis& y) {
  std::string path, marks;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const CurvePoint& point = curve.points[i];
    const double at_x = x.at(point.x), at_y = y.at(point.y);
    if (curve.steps && i > 0) path += fmt::format("H{:.1f}V{:.1f}", at_x, at_y);
    else path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", at_x, at_y);
    if (point.whisker) marks += whisker(at_x, y.at(point.interval.low), y.at(point.interval.high));
    if (!curve.steps)
      marks += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3.5" fill="{}"/>)", at_x, at_y, series_colour(colour));
  }
  return fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="2"/>)", path, series_colour(colour)) + marks;
}

}  // namespace

const char* series_colour(std::size_t index) {
  static constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
  return kColours[index % kColours.size()];
}

std::string bar_chart(const std::string& title, const std::vector<Bar>& bars, double full, const std::string& unit,
                      const std::vector<std::string>& key) {
  const double bottom = kTop + static_cast<double>(bars.size()) * (kBarHeight + kBarGap);
  const Axis x = make_axis(0, full, kLeft, kWidth - kRight);
  std::string svg = begin(title, bottom + kBottom + kKeyRow * static_cast<double>(key.size()));
  for (const double value : ticks(x)) {
    svg += line(x.at(value), kTop - 4, x.at(value), bottom, "grid");
    svg += text(x.at(value), bottom + 16, tick_text(value, x.step), "middle");
  }
  svg += text((kLeft + kWidth - kRight) / 2, bottom + 34, unit, "middle");
  for (std::size_t i = 0; i < key.size(); ++i) svg += key_row(kLeft, bottom + kBottom, i, key[i]);
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const Bar& bar = bars[i];
    const double top = kTop + static_cast<double>(i) * (kBarHeight + kBarGap);
    const double middle = top + kBarHeight / 2;
    svg += text(kLeft - 8, middle + 4, bar.name, "end");
    svg += fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}"/>)", kLeft, top,
                       std::max(0.0, x.at(bar.value) - kLeft), kBarHeight, series_colour(bar.colour));
    if (bar.whisker) {
      const double low = x.at(bar.interval.low), high = x.at(bar.interval.high);
      svg += line(low, middle, high, middle, "whisker") + line(low, middle - 4, low, middle + 4, "whisker") +
             line(high, middle - 4, high, middle + 4, "whisker");
    }
    svg += text(kWidth - kRight + 8, middle + 4, bar.text);
  }
  return svg + "</svg>\n";
}

std::string curve_chart(const std::string& title, const std::vector<Curve>& curves, const std::string& x_label,
                        const std::string& y_label, double y_full) {
  double low = 1e300, high = -1e300, y_high = y_full;
  for (const auto& curve : curves) {
    for (const auto& point : curve.points) {
      low = std::min(low, point.x);
      high = std::max(high, point.x);
      if (y_full <= 0) y_high = std::max({y_high, point.y, point.whisker ? point.interval.high : 0});
    }
  }
  if (low > high) low = 0, high = 1;
  const double key = curves.size() > 1 ? kKeyRow * static_cast<double>(curves.size()) : 0;
  const double height = kTop + kCurveHeight + kBottom + key;
  const double bottom = kTop + kCurveHeight;
  const Axis x = make_axis(low, high, kCurveLeft, kWidth - kCurveRight);
  const Axis y = make_axis(0, y_high, bottom, kTop);
  std::string svg = begin(title, height);
  for (const double value : ticks(x)) {
    svg += line(x.at(value), kTop, x.at(value), bottom, "grid");
    svg += text(x.at(value), bottom + 16, tick_text(value, x.step), "middle");
  }
  for (const double value : ticks(y)) {
    svg += line(kCurveLeft, y.at(value), kWidth - kCurveRight, y.at(value), "grid");
    svg += text(kCurveLeft - 6, y.at(value) + 4, tick_text(value, y.step), "end");
  }
  svg += text((kCurveLeft + kWidth) / 2, bottom + 34, x_label, "middle");
  const double middle = (kTop + bottom) / 2;
  svg += text(14, middle, y_label, "middle", fmt::format(R"-(transform="rotate(-90 14 {:.1f})")-", middle));
  for (std::size_t i = 0; i < curves.size(); ++i) {
    svg += draw(curves[i], i, x, y);
    if (curves.size() > 1) svg += key_row(kCurveLeft, bottom + kBottom, i, curves[i].name);
  }
  return svg + "</svg>\n";
}

}  // namespace constrictor::cli
