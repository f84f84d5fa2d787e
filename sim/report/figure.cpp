#include "sim/report/figure.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "sim/report/drawing.hpp"
#include "sim/report/png.hpp"

namespace constrictor::report {
namespace {

constexpr int kMargin = 24;
constexpr int kGap = 10;
constexpr int kPanelHeight = 180;
constexpr std::array<int, 5> kColumnWidths{150, 320, 240, 240, 362};  // caption, scene, camera, processed, torque
constexpr int kHeaderHeight = 104;
constexpr int kFailureHeight = 24;  // height of the text line that says why the mission did not succeed

cv::Scalar display_colour(std::uint8_t colour) {
  static const std::array<cv::Scalar, 5> kColours{cv::Scalar(150, 150, 150), cv::Scalar(72, 160, 44),
                                                  cv::Scalar(48, 48, 205), cv::Scalar(200, 96, 40),
                                                  cv::Scalar(30, 175, 225)};
  return kColours[colour < kColours.size() ? colour : 0];
}

void picture(cv::Mat& canvas, const std::filesystem::path& file, int x, int y, int width) {
  const cv::Rect frame = scaled_rect(x, y, width, kPanelHeight);
  const cv::Mat image = read_png(file);
  if (image.empty()) {
    cv::rectangle(canvas, frame, kFaint, cv::FILLED);
    text(canvas, "no image", x + width / 2.0, y + kPanelHeight / 2.0 + 4, 0.85, kGreyInk, false, Align::kCentre);
  } else {
    // The image is cut to the shape of the panel, never stretched.
    const double wanted = static_cast<double>(width) / kPanelHeight;
    const double have = static_cast<double>(image.cols) / image.rows;
    cv::Rect part(0, 0, image.cols, image.rows);
    if (have > wanted) {
      part.width = static_cast<int>(image.rows * wanted);
      part.x = (image.cols - part.width) / 2;
    } else {
      part.height = std::min(image.rows, static_cast<int>(image.cols / wanted));
      part.y = (image.rows - part.height) / 2;
    }
    cv::Mat target = canvas(frame);
    cv::resize(image(part), target, frame.size(), 0, 0, cv::INTER_CUBIC);
  }
  cv::rectangle(canvas, frame, kFrame, kScale / 2);
}

/// Colour of a joint's curve: from red at the head to blue at the tail.
cv::Scalar joint_colour(std::size_t joint, std::size_t count) {
  const double t = count > 1 ? static_cast<double>(joint) / static_cast<double>(count - 1) : 0.0;
  static const std::array<cv::Vec3d, 4> kStops{cv::Vec3d(40, 60, 215), cv::Vec3d(40, 165, 235), cv::Vec3d(150, 160, 60),
                                               cv::Vec3d(170, 75, 60)};
  const double at = t * (kStops.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const cv::Vec3d mixed = kStops[i] + (kStops[i + 1] - kStops[i]) * (at - static_cast<double>(i));
  return {mixed[0], mixed[1], mixed[2]};
}

struct Axes {
  int x, y, width, height;  // of the area inside the frame
  double from_s, to_s, limit_nm;
  [[nodiscard]] cv::Point at(double time_s, double torque_nm) const {
    return scaled(x + (time_s - from_s) / (to_s - from_s) * width,
                  y + height * (0.5 - 0.5 * std::clamp(torque_nm / limit_nm, -1.0, 1.0)));
  }
};

void torque_plot(cv::Mat& canvas, const TorqueSeries& torques, double limit_nm, double moment_s, double window_s,
                 int left, int top, int width) {
  Axes axes{left + 30, top + 4, width - 34, kPanelHeight - 24, 0.0, 0.0, limit_nm};
  // The moment is at four fifths of the window; early in the run the window begins at zero.
  axes.from_s = std::max(0.0, moment_s - 0.8 * window_s);
  axes.to_s = axes.from_s + window_s;
  cv::rectangle(canvas, scaled_rect(axes.x, axes.y, axes.width, axes.height), cv::Scalar(252, 252, 252), cv::FILLED);
  const double step_nm = limit_nm > 4.0 ? 2.0 : 1.0;
  for (double value = -std::floor(limit_nm / step_nm) * step_nm; value <= limit_nm + 1e-9; value += step_nm) {
    cv::line(canvas, axes.at(axes.from_s, value), axes.at(axes.to_s, value), std::abs(value) < 1e-9 ? kFrame : kFaint,
             kScale / 2, cv::LINE_AA);
    text(canvas, number(value, 0), axes.x - 5, axes.at(axes.from_s, value).y / static_cast<double>(kScale) + 4, 0.72,
         kGreyInk, false, Align::kRight);
  }
  const double step_s = window_s > 20.0 ? 10.0 : 5.0;
  for (double time = std::ceil(axes.from_s / step_s) * step_s; time <= axes.to_s + 1e-9; time += step_s) {
    cv::line(canvas, axes.at(time, -limit_nm), axes.at(time, limit_nm), kFaint, kScale / 2, cv::LINE_AA);
    const bool last = time > axes.to_s - 0.05 * window_s;
    text(canvas, number(time, 0) + (last ? " s" : ""),
         axes.at(time, 0).x / static_cast<double>(kScale) + (last ? 4 : 0), axes.y + axes.height + 15, 0.72, kGreyInk,
         false, last ? Align::kRight : Align::kCentre);
  }
  const auto begin =
      std::lower_bound(torques.time_s.begin(), torques.time_s.end(), axes.from_s) - torques.time_s.begin();
  const auto end = std::upper_bound(torques.time_s.begin(), torques.time_s.end(), axes.to_s) - torques.time_s.begin();
  for (std::size_t joint = torques.torque_nm.size(); joint-- > 0;) {  // the curve of the head is drawn last
    std::vector<cv::Point> line;
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      line.push_back(axes.at(torques.time_s[i], torques.torque_nm[joint][i]));
    }
    cv::polylines(canvas, line, false, joint_colour(joint, torques.torque_nm.size()), kScale, cv::LINE_AA);
  }
  cv::line(canvas, axes.at(moment_s, -limit_nm), axes.at(moment_s, limit_nm), kInk, kScale, cv::LINE_AA);
  cv::rectangle(canvas, scaled_rect(axes.x, axes.y, axes.width, axes.height), kFrame, kScale / 2);
}

/// [Nm] limit of the plots: the 99.8th percentile of all torques, rounded up, 2 to 10 Nm.
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

void joint_key(cv::Mat& canvas, std::size_t joints, int right, double y) {
  if (joints == 0) return;
  constexpr int kSwatch = 9;
  const int width = kSwatch * static_cast<int>(joints);
  text(canvas, "tail", right, y, 0.72, kGreyInk, false, Align::kRight);
  const int from = right - 30 - width;
  for (std::size_t joint = 0; joint < joints; ++joint) {
    cv::rectangle(canvas,
                  scaled_rect(from + static_cast<int>(joint) * kSwatch, static_cast<int>(y) - 8, kSwatch - 1, 8),
                  joint_colour(joint, joints), cv::FILLED);
  }
  text(canvas, "head", from - 6, y, 0.72, kGreyInk, false, Align::kRight);
}

}  // namespace

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

cv::Mat draw_figure(const FigureHeading& heading, const std::vector<FigureRow>& rows, const TorqueSeries& torques,
                    double window_s) {
  int width = 2 * kMargin - kGap;
  for (const int column : kColumnWidths) width += column + kGap;
  const int row_height = kPanelHeight + 14;
  const int header_height = kHeaderHeight + (heading.failure.empty() ? 0 : kFailureHeight);
  const int height = header_height + static_cast<int>(rows.size()) * row_height + kMargin - 8;
  cv::Mat canvas = make_canvas(width, height);

  std::array<int, kColumnWidths.size()> left{};
  left[0] = kMargin;
  for (std::size_t i = 1; i < left.size(); ++i) left[i] = left[i - 1] + kColumnWidths[i - 1] + kGap;
  text(canvas, heading.title, kMargin, 38, 1.5, kInk, true);
  text(canvas, heading.subtitle, kMargin, 62, 0.95, kGreyInk);
  text(canvas, fitted(heading.failure, 0.95, width - 2 * kMargin), kMargin, 84, 0.95, kRedInk);
  static const std::array<const char*, 4> kHeadings{"Scene", "Camera", "Processed", "Yaw torques [Nm]"};
  for (std::size_t i = 0; i < kHeadings.size(); ++i)
    text(canvas, kHeadings[i], left[i + 1] + (i == 3 ? 30 : 0), header_height - 10, 0.95, kInk, true);
  joint_key(canvas, torques.torque_nm.size(), width - kMargin - 5, header_height - 10);

  const double limit_nm = torque_limit(torques);
  int top = header_height;
  for (const FigureRow& row : rows) {
    cv::rectangle(canvas, scaled_rect(left[0], top, 5, kPanelHeight), display_colour(row.colour), cv::FILLED);
    text(canvas, number(row.time_s, 1) + " s", left[0] + 16, top + 24, 1.25, kInk, true);
    double y = top + 48;
    std::string words = row.caption;
    while (!words.empty()) {  // break the caption at the last space that fits into its column
      std::size_t cut = words.size();
      if (cut > 17) {
        cut = words.rfind(' ', 17);
        if (cut == std::string::npos) cut = 17;
      }
      text(canvas, words.substr(0, cut), left[0] + 16, y, 0.95, kInk);
      words.erase(0, std::min(words.size(), cut + 1));
      y += 19;
    }
    if (!row.state.empty()) text(canvas, row.state.substr(0, 20), left[0] + 16, top + kPanelHeight - 8, 0.8, kGreyInk);
    picture(canvas, row.scene, left[1], top, kColumnWidths[1]);
    picture(canvas, row.camera, left[2], top, kColumnWidths[2]);
    picture(canvas, row.processed, left[3], top, kColumnWidths[3]);
    torque_plot(canvas, torques, limit_nm, row.time_s, window_s, left[4], top, kColumnWidths[4]);
    top += row_height;
  }
  return reduced(canvas);
}

}  // namespace constrictor::report
