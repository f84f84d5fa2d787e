#include "sim/figure/panels.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "constrictor/colours.hpp"

namespace constrictor::figure {
namespace {

/// Colour of a joint's curve, from the head (dark) to the tail (light): the palette viridis without its lightest part.
/// Its lightness rises evenly, so that all kinds of colour vision, and grey prints, keep the order.
Colour joint_colour(std::size_t joint, std::size_t count) {
  static constexpr std::array<Colour, 6> kStops{{{0.267, 0.005, 0.329},
                                                 {0.259, 0.249, 0.524},
                                                 {0.190, 0.407, 0.556},
                                                 {0.128, 0.567, 0.551},
                                                 {0.267, 0.679, 0.481},
                                                 {0.600, 0.800, 0.200}}};
  const double t = count > 1 ? static_cast<double>(joint) / static_cast<double>(count - 1) : 0.0;
  const double at = t * (kStops.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double f = at - static_cast<double>(i);
  const auto mix = [f](double a, double b) { return a + (b - a) * f; };
  return {mix(kStops[i].red, kStops[i + 1].red), mix(kStops[i].green, kStops[i + 1].green),
          mix(kStops[i].blue, kStops[i + 1].blue)};
}

}  // namespace

Colour display_colour(std::uint8_t colour) {
  const Rgb8& print = look_of(colour).print;
  return {print[0] / 255.0, print[1] / 255.0, print[2] / 255.0};
}

std::string number(double value, int decimals) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  return buffer;
}

TorqueSeries parse_torques(const std::string& csv) {
  TorqueSeries series;
  std::string_view rest(csv);
  bool heading = true;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const auto columns = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    if (heading) {
      series.torque_nm.resize(columns);
      heading = false;
      continue;
    }
    if (columns != series.torque_nm.size()) continue;
    for (std::size_t column = 0; column <= columns; ++column) {
      double value = 0.0;
      const auto result = std::from_chars(line.data(), line.data() + line.size(), value);
      (column == 0 ? series.time_s : series.torque_nm[column - 1]).push_back(value);
      const auto used = static_cast<std::size_t>(result.ptr - line.data());
      line.remove_prefix(std::min(used + 1, line.size()));
    }
  }
  return series;
}

double torque_limit(const TorqueSeries& torques) {
  std::vector<double> magnitudes;
  for (const auto& series : torques.torque_nm) {
    for (const double value : series) magnitudes.push_back(std::abs(value));
  }
  if (magnitudes.empty()) return 6.0;
  const std::size_t rank = std::min(magnitudes.size() - 1, magnitudes.size() * 998 / 1000);
  std::nth_element(magnitudes.begin(), magnitudes.begin() + static_cast<std::ptrdiff_t>(rank), magnitudes.end());
  return std::clamp(std::ceil(magnitudes[rank] * 1.05), 2.0, 10.0);
}

void draw_torques(Canvas& canvas, const Rect& area, const TorqueSeries& torques, const TorqueAxes& axes, double font) {
  const TextStyle numbers{font, kGreyInk, false, Align::kCentre};
  const double left = canvas.width_of("−10", numbers) + 6.0;
  const double half = 0.5 * font;
  const Rect inner{area.x + left, area.y + half, area.width - left - 1.0, area.height - half - 1.6 * font};
  const auto x_of = [&](double time_s) {
    return inner.x + (time_s - axes.from_s) / (axes.to_s - axes.from_s) * inner.width;
  };
  const auto y_of = [&](double torque_nm) {
    return inner.y + inner.height * (0.5 - 0.5 * std::clamp(torque_nm / axes.limit_nm, -1.0, 1.0));
  };
  canvas.fill(inner, {0.99, 0.99, 0.99});
  const double step_nm = axes.limit_nm > 4.0 ? 2.0 : 1.0;
  const int steps = static_cast<int>(std::floor(axes.limit_nm / step_nm + 1e-9));
  for (int step = -steps; step <= steps; ++step) {
    const double y = y_of(step * step_nm);
    canvas.line({inner.x, y}, {inner.x + inner.width, y}, step == 0 ? kFrame : kFaint, 1.0);
    TextStyle style = numbers;
    style.align = Align::kRight;
    const std::string words = (step < 0 ? "−" : "") + number(std::abs(step) * step_nm, 0);
    canvas.text(words, {inner.x - 5.0, y + 0.36 * font}, style);
  }
  const double window_s = axes.to_s - axes.from_s;
  const double step_s = window_s > 40.0 ? 20.0 : window_s > 20.0 ? 10.0 : window_s > 8.0 ? 5.0 : 1.0;
  for (double time_s = std::ceil(axes.from_s / step_s) * step_s; time_s <= axes.to_s + 1e-9; time_s += step_s) {
    const double x = x_of(time_s);
    canvas.line({x, inner.y}, {x, inner.y + inner.height}, kFaint, 1.0);
    const std::string words = number(time_s, 0) + " s";
    // A number near an end stays within the area.
    const double half_width = 0.5 * canvas.width_of(words, numbers);
    const double centre = std::min(x, area.x + area.width - half_width);
    canvas.text(words, {centre, inner.y + inner.height + 1.35 * font}, numbers);
  }
  const auto begin = std::lower_bound(torques.time_s.begin(), torques.time_s.end(), axes.from_s);
  const auto end = std::upper_bound(begin, torques.time_s.end(), std::min(axes.to_s, axes.drawn_until_s));
  for (std::size_t joint = torques.torque_nm.size(); joint-- > 0;) {  // the curve of the head is drawn last
    std::vector<Point> points;
    for (auto time = begin; time != end; ++time)
      points.push_back(
          {x_of(*time), y_of(torques.torque_nm[joint][static_cast<std::size_t>(time - torques.time_s.begin())])});
    canvas.polyline(points, inner, joint_colour(joint, torques.torque_nm.size()), 0.1 * font);
  }
  const double x = x_of(axes.moment_s);
  canvas.line({x, inner.y}, {x, inner.y + inner.height}, kInk, 1.5);
  canvas.frame(inner, kFrame, 1.0);
}

void draw_joint_key(Canvas& canvas, std::size_t joints, double left, double right, double y, double font) {
  if (joints == 0) return;
  constexpr double kSpace = 6.0;
  const TextStyle style{font, kGreyInk, false, Align::kRight};
  const double to = right - canvas.width_of("tail", style) - kSpace;
  const double room = to - left - canvas.width_of("head", style) - kSpace;
  const double height = 0.75 * font;
  const double swatch = std::min(height, room / static_cast<double>(joints));
  if (swatch <= 0.0) return;
  const double gap = std::min(1.0, 0.2 * swatch);  // narrow swatches need their width for the colour
  const double from = to - swatch * static_cast<double>(joints);
  canvas.text("tail", {right, y}, style);
  for (std::size_t joint = 0; joint < joints; ++joint)
    canvas.fill({from + swatch * static_cast<double>(joint), y - height, swatch - gap, height},
                joint_colour(joint, joints));
  canvas.text("head", {from - kSpace, y}, style);
}

void draw_picture(Canvas& canvas, const Rect& area, const Picture& picture, const std::string& missing) {
  if (picture.empty()) {
    canvas.fill(area, kFaint);
    const TextStyle style{12.0, kGreyInk, false, Align::kCentre};
    canvas.text(canvas.fitted(missing, area.width - 8.0, style),
                {area.x + 0.5 * area.width, area.y + 0.5 * area.height + 4.0}, style);
  } else {
    canvas.picture(area, picture);
  }
  canvas.frame(area, kFrame, 1.0);
}

}  // namespace constrictor::figure
