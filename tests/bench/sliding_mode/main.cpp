// Measures sliding mode control beside the servos' own position control: a table, and sliding_mode.png.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iostream>

#include "bench/measure_main.hpp"
#include "bench/sliding_mode/tracking_trial.hpp"
#include "sim/figure/canvas.hpp"

namespace constrictor::sliding_mode {
namespace {

using figure::Canvas;
using figure::Point;
using figure::Rect;

struct Row {
  std::string law, condition;
  Trial trial;
  bool drawn = false;
};

Trial sliding(double period_s) {
  Trial trial;
  trial.method = "sliding_mode";
  trial.period_s = period_s;
  // At a shorter tick the same law may be faster by the same ratio.
  const double ratio = 0.02 / period_s;
  trial.config.sliding.surface_1_s *= std::sqrt(ratio);
  trial.config.sliding.reaching_rad_s2 *= ratio * std::sqrt(ratio);
  trial.config.sliding.layer_rad_s *= std::sqrt(ratio);
  trial.config.sliding.estimate_s /= ratio;
  return trial;
}

Trial without_model(double period_s) {
  Trial trial = sliding(period_s);
  trial.config.sliding.inertia = 1;
  trial.config.sliding.estimate_s = 1e3;  // no estimate of unknown torques
  return trial;
}

std::vector<Row> rows() {
  struct Condition {
    const char* name;
    double friction, mass;
  };
  std::vector<Row> rows;
  for (const Condition& at :
       {Condition{"as in the robot file", 1.0, 1.0}, Condition{"friction -30 %", 0.7, 1.0},
        Condition{"friction +30 %", 1.3, 1.0}, Condition{"mass -30 %", 1.0, 0.7}, Condition{"mass +30 %", 1.0, 1.3}}) {
    for (Row row : {Row{"angles (`undulation`)", at.name, {}}, Row{"`sliding_mode`", at.name, sliding(0.02)}}) {
      row.trial.friction_share = at.friction;
      row.trial.mass_share = at.mass;
      row.drawn = at.friction == 1.0 && at.mass == 1.0;
      rows.push_back(row);
    }
  }
  rows.push_back({"bare law, each joint by itself", "20 ms", without_model(0.02), true});
  rows.push_back({"bare law, each joint by itself", "4 ms", without_model(0.004)});
  rows.push_back({"`sliding_mode`", "4 ms", sliding(0.004)});
  return rows;
}

/// One panel for each drawn row: reference and angle of the yaw joint in the middle, over three seconds.
void draw(const std::filesystem::path& file, const std::vector<Row>& all, const std::vector<Tracking>& found) {
  constexpr double kWidth = 900.0, kPanel = 170.0, kLeft = 60.0, kTop = 44.0, kSpan_s = 3.0, kRange_rad = 0.7;
  double height = 10.0;
  for (const Row& row : all) height += row.drawn ? kPanel + kTop : 0.0;
  Canvas canvas(figure::Format::kPng, kWidth, height, 1.0, "Sliding mode");
  canvas.fill({0.0, 0.0, kWidth, height}, figure::kWhite);
  double top = kTop;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].drawn) continue;
    const Rect area{kLeft, top, kWidth - kLeft - 14.0, kPanel - 12.0};
    canvas.text(fmt::format("{}, {}: error {:.3f} rad rms", all[i].law, all[i].condition, found[i].error_rad),
                {kLeft, top - 10.0}, {14.0, figure::kInk, true});
    canvas.frame(area, figure::kFaint, 1.0);
    canvas.text("0.5 rad", {4.0, area.y + area.height * (0.5 - 0.5 / (2 * kRange_rad)) + 4.0},
                {12.0, figure::kGreyInk, false});
    canvas.text("-0.5 rad", {4.0, area.y + area.height * (0.5 + 0.5 / (2 * kRange_rad)) + 4.0},
                {12.0, figure::kGreyInk, false});
    std::vector<Point> reference, angle;
    const double begin_s = found[i].course.back().time_s - kSpan_s;
    for (const Moment& at : found[i].course) {
      if (at.time_s < begin_s) continue;
      const double x = area.x + area.width * (at.time_s - begin_s) / kSpan_s;
      const auto y = [&](double value) { return area.y + area.height * (0.5 - value / (2.0 * kRange_rad)); };
      reference.push_back({x, y(at.reference_rad)});
      angle.push_back({x, y(at.angle_rad)});
    }
    canvas.polyline(reference, area, {0.65, 0.65, 0.65}, 5.0);
    canvas.polyline(angle, area, {0.06, 0.25, 0.47}, 2.0);
    top += kPanel + kTop;
  }
  std::ofstream(file, std::ios::binary) << canvas.finish();
}

void measure(const std::filesystem::path& robot_file, const std::filesystem::path& output) {
  const RobotModel robot = load_robot(robot_file);
  const std::vector<Row> all = rows();
  std::vector<Tracking> found;
  fmt::print(
      "| law | condition | joint error rms | heading rms | torque rms | speed | power "
      "|\n|---|---|---|---|---|---|---|\n");
  for (const Row& row : all) {
    const Tracking one = run(robot, row.trial);
    fmt::print("| {} | {} | {:.3f} rad | {:.3f} rad | {:.2f} Nm | {:.2f} m/s | {:.1f} W |\n", row.law, row.condition,
               one.error_rad, one.heading_rad, one.torque_nm, one.speed_m_s, one.power_w);
    std::cout.flush();
    found.push_back(one);
  }
  draw(output / "sliding_mode.png", all, found);
  fmt::print("\nsliding_mode: {}\n", (output / "sliding_mode.png").string());
}

}  // namespace
}  // namespace constrictor::sliding_mode

int main(int argc, char** argv) {
  return constrictor::bench::measure_main(argc, argv, "sliding_mode",
                                          "measure sliding mode control beside position control in the simulated world",
                                          "sliding_mode.png", constrictor::sliding_mode::measure);
}
