// Drives the robot through random fields of pegs, with undulation and with obstacle_aided: a table, peg_fields.json and
// peg_fields.png.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "bench/measure_main.hpp"
#include "bench/peg_fields/peg_picture.hpp"

namespace constrictor::peg_fields {
namespace {

constexpr std::uint64_t kFirstSeed = 1;  // no seed of these was used while the method was made
constexpr int kFields = 10;
constexpr double kWanted_m_s = 0.05;

/// A method and its wave.
struct Row {
  std::string name;
  Trial trial;
};

Row row(const std::string& name, const std::string& method, double amplitude_rad) {
  Row row{name, {}};
  row.trial.method.method = method;
  row.trial.method.amplitude_rad = amplitude_rad;
  row.trial.longest_s = row.trial.goal_m / kWanted_m_s;
  return row;
}

std::string cell(const Course& course) {
  return fmt::format("{:.3f}{}", course.speed_m_s(), course.goal_s ? "" : " (no)");
}

/// Draws the same field with each of these methods.
void draw_example(const RobotModel& robot, const std::vector<Row>& rows, const std::filesystem::path& file) {
  constexpr std::uint64_t kSeed = 4;
  const FieldSpec field;
  const Scenario scene = field_for(robot, field, kSeed);
  std::vector<Panel> panels;
  for (const Row& r : rows) {
    const Course course = run(robot, field, kSeed, r.trial);
    const std::string title =
        fmt::format("{}, field {}, pegs at least {:g} m apart: {:.2f} m in {:.0f} s", r.trial.method.method, kSeed,
                    field.spacing_m, course.way_m, course.duration_s);
    panels.push_back({title, scene, course});
  }
  draw(file, panels, robot.module_radius_m);
}

void measure(const std::filesystem::path& robot_file, const std::filesystem::path& output) {
  const RobotModel robot = load_robot(robot_file);
  const std::vector<Row> rows = {row("`undulation`, 0.5 rad", "undulation", 0.5),
                                 row("`undulation`, 0.9 rad", "undulation", 0.9),
                                 row("`obstacle_aided`", "obstacle_aided", 0.5)};
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  draw_example(robot, {rows[1], rows[2]}, output / "peg_fields.png");
  for (const double spacing_m : {0.25, 0.3, 0.35}) {
    FieldSpec field;
    field.spacing_m = spacing_m;
    fmt::print("Pegs at least {:g} m apart. Speed over the way of the body's centre, in m/s:\n\n| field |", spacing_m);
    for (const Row& r : rows) fmt::print(" {} |", r.name);
    fmt::print("\n|---|---|---|---|\n");
    std::vector<int> succeeded(rows.size());
    std::vector<double> speed_m_s(rows.size());
    for (int i = 0; i < kFields; ++i) {
      const std::uint64_t seed = kFirstSeed + static_cast<std::uint64_t>(i);
      fmt::print("| {} |", seed);
      for (std::size_t m = 0; m < rows.size(); ++m) {
        const Course course = run(robot, field, seed, rows[m].trial);
        succeeded[m] += course.goal_s ? 1 : 0;
        speed_m_s[m] += course.speed_m_s() / kFields;
        fmt::print(" {} |", cell(course));
        json.push_back({{"spacing_m", spacing_m},
                        {"seed", seed},
                        {"method", rows[m].trial.method.method},
                        {"amplitude_rad", rows[m].trial.method.amplitude_rad},
                        {"reached", course.goal_s.has_value()},
                        {"way_m", course.way_m},
                        {"sideways_m", course.sideways_m},
                        {"duration_s", course.duration_s},
                        {"cost_of_transport", course.transport},
                        {"touching_modules", course.touching_modules},
                        {"largest_peg_n", course.largest_peg_n}});
      }
      fmt::print("\n");
      std::cout.flush();
    }
    fmt::print("| 3 m within 60 s |");
    for (const int count : succeeded) fmt::print(" {} of {} |", count, kFields);
    fmt::print("\n| mean |");
    for (const double mean : speed_m_s) fmt::print(" {:.3f} |", mean);
    fmt::print("\n\n");
  }
  std::ofstream(output / "peg_fields.json") << json.dump(2) << '\n';
  fmt::print("peg_fields: {} and {}\n", (output / "peg_fields.png").string(), (output / "peg_fields.json").string());
}

}  // namespace
}  // namespace constrictor::peg_fields

int main(int argc, char** argv) {
  return constrictor::bench::measure_main(argc, argv, "peg_fields",
                                          "drive the simulated robot through random fields of pegs",
                                          "peg_fields.png and peg_fields.json", constrictor::peg_fields::measure);
}
