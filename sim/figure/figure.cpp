#include "sim/figure/figure.hpp"

#include <algorithm>
#include <array>

namespace constrictor::figure {
namespace {

constexpr double kMargin = 24.0;
constexpr double kGap = 10.0;
constexpr double kPanelHeight = 180.0;
constexpr double kRowHeight = kPanelHeight + 14.0;
constexpr std::array<double, 5> kColumnWidths{150, 320, 240, 240, 362};  // caption, scene, camera, processed, torque
constexpr double kHeaderHeight = 108.0;
constexpr double kFailureHeight = 24.0;  // of the line that says why the mission did not succeed
constexpr double kNumbers = 11.0;        // size of the numbers at the axes
constexpr std::size_t kStateLines = 3;   // of a state's name, at most

void draw_caption(Canvas& canvas, const Row& row, double left, double top) {
  canvas.fill({left, top, 5.0, kPanelHeight}, display_colour(row.colour));
  const double x = left + 16.0, width = kColumnWidths[0] - 16.0;
  canvas.text(number(row.time_s, 1) + " s", {x, top + 20.0}, {19.0, kInk, true});
  // The state stands at the bottom. A name of more lines than there is room for ends with a mark.
  const TextStyle state{12.0, kGreyInk};
  std::vector<std::string> state_lines = canvas.wrapped(row.state, width, state);
  if (state_lines.size() > kStateLines) {
    state_lines.resize(kStateLines);
    state_lines.back() = canvas.fitted(state_lines.back() + " …", width, state);
  }
  const double state_height = 16.0 * static_cast<double>(state_lines.size());
  double y = top + kPanelHeight + 11.0 - state_height;
  for (const std::string& line : state_lines) {
    canvas.text(line, {x, y}, state);
    y += 16.0;
  }
  const TextStyle words{14.0};
  y = top + 45.0;
  for (const std::string& line : canvas.wrapped(row.caption, width, words)) {
    if (y > top + kPanelHeight - 14.0 - state_height) break;
    canvas.text(line, {x, y}, words);
    y += 19.0;
  }
}

}  // namespace

std::string draw_figure(const Heading& heading, const std::vector<Row>& rows, const TorqueSeries& torques,
                        double window_s, Format format, double scale) {
  const double header = kHeaderHeight + (heading.failure.empty() ? 0.0 : kFailureHeight);
  const double height = header + static_cast<double>(rows.size()) * kRowHeight + kMargin - 8.0;
  Canvas canvas(format, kWidth, height, scale, heading.title + ": " + heading.subtitle);

  // A run of a real robot has no pictures of the scene. Their column is then left out, and the torques are wider.
  const bool scenes = std::any_of(rows.begin(), rows.end(), [](const Row& row) { return !row.scene.empty(); });
  std::array<double, kColumnWidths.size()> width = kColumnWidths;
  if (!scenes) {
    width[4] += width[1] + kGap;
    width[1] = -kGap;  // the gap behind the column is left out, too
  }
  std::array<double, kColumnWidths.size()> left{};
  left[0] = kMargin;
  for (std::size_t i = 1; i < left.size(); ++i) left[i] = left[i - 1] + width[i - 1] + kGap;
  const double right = kWidth - kMargin;
  canvas.text(heading.title, {kMargin, 40.0}, {24.0, kInk, true});
  const auto fitted_line = [&](const std::string& words, double y, const TextStyle& style) {
    if (!words.empty()) canvas.text(canvas.fitted(words, right - kMargin, style), {kMargin, y}, style);
  };
  fitted_line(heading.subtitle, 65.0, {15.0, kGreyInk});
  fitted_line(heading.failure, 88.0, {15.0, kRedInk});
  static constexpr std::array<const char*, 4> kHeadings{"Scene", "Camera", "Processed", "Yaw torques [Nm]"};
  const TextStyle heading_style{15.0, kInk, true};
  double end = 0.0;  // of the last heading
  for (std::size_t i = scenes ? 0 : 1; i < kHeadings.size(); ++i) {
    const double x = left[i + 1] + (i == 3 ? 30.0 : 0.0);
    canvas.text(kHeadings[i], {x, header - 10.0}, heading_style);
    end = x + canvas.width_of(kHeadings[i], heading_style);
  }
  draw_joint_key(canvas, torques.torque_nm.size(), end + kGap, right, header - 10.0, 12.0);

  TorqueAxes axes;
  axes.limit_nm = torque_limit(torques);
  double top = header;
  for (const Row& row : rows) {
    draw_caption(canvas, row, left[0], top);
    if (scenes) draw_picture(canvas, {left[1], top, width[1], kPanelHeight}, row.scene, "no image");
    draw_picture(canvas, {left[2], top, width[2], kPanelHeight}, row.camera, "no image");
    draw_picture(canvas, {left[3], top, width[3], kPanelHeight}, row.processed, "no image");
    // The moment is at four fifths of the window; early in the run the window begins at zero.
    axes.moment_s = row.time_s;
    axes.from_s = std::max(0.0, row.time_s - 0.8 * window_s);
    axes.to_s = axes.from_s + window_s;
    draw_torques(canvas, {left[4], top - 0.5 * kNumbers, width[4], kPanelHeight + 0.5 * kNumbers}, torques, axes,
                 kNumbers);
    top += kRowHeight;
  }
  return canvas.finish();
}

}  // namespace constrictor::figure
