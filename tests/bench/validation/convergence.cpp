// How much the results depend on the step and the iterations of the solver.
#include <cmath>

#include "bench/validation/carrying.hpp"
#include "bench/validation/checks.hpp"

namespace constrictor::validation {
namespace {

SolverSettings solver(double step_ms, int iterations) {
  SolverSettings settings;
  settings.step_s = 1e-3 * step_ms;
  settings.iterations = iterations;
  return settings;
}

constexpr double kFinestStep_ms = 0.5;
constexpr int kMostIterations = 400;
const std::vector<double> kSteps_ms{10.0, 5.0, 4.0, 2.0, 1.0};  // whole numbers of steps make a control period of 20 ms
const std::vector<int> kIterations{20, 50, 100, 200};

/// A quantity of a measurement that goes into a column of the table and a panel of the figure.
template <class Measurement>
struct Column {
  const char* name;
  double Measurement::*value;
  double factor;  ///< from SI to the unit in the name
};

template <class Measurement>
struct Grid {
  Table table;
  std::vector<Plot> plots;
};

/// Measures all settings, and fills a table and a plot for each column.
template <class Measurement, class Experiment>
Grid<Measurement> measure_grid(const std::string& caption, const std::vector<Column<Measurement>>& columns,
                               const std::vector<double>& steps_ms, const std::vector<int>& iterations,
                               const Experiment& experiment) {
  Grid<Measurement> grid;
  grid.table = {caption, {"step [ms]", "iterations"}, {}};
  for (const auto& column : columns) {
    grid.table.columns.push_back(column.name);
    grid.plots.push_back({column.name, "step [ms]", "", {}});
  }
  for (const int count : iterations) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      grid.plots[c].series.push_back({fmt::format("{} iterations", count), {}, {}, Mark::kLineWithDots});
    for (const double step_ms : steps_ms) {
      const Measurement found = experiment(solver(step_ms, count));
      std::vector<std::string> row{shown(step_ms), std::to_string(count)};
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const double value = columns[c].factor * (found.*columns[c].value);
        row.push_back(shown(value));
        grid.plots[c].series.back().x.push_back(step_ms);
        grid.plots[c].series.back().y.push_back(value);
      }
      grid.table.rows.push_back(row);
    }
  }
  return grid;
}

}  // namespace

Section check_convergence() {
  Section section{
      "Convergence of the solver",
      "The same motion with other steps and numbers of iterations. The default (4 ms, 50 iterations) is "
      "compared with a much finer solution (empty: 0.5 ms, 400 iterations; loaded: 1 ms, 200 iterations). "
      "Loaded: the robot carries a cylinder of 0.4 kg in a bend of its body. Its motion is not periodic "
      "and slips a little, so that its figures scatter. The torque of the empty gait converges slowly with the step, "
      "because points that do not slip hold forces against each other that only the softness of the model determines.",
      {},
      {},
      {}};
  const RobotModel robot = mamba();
  const Gait gait = lateral_gait(robot, {});

  const auto empty = [&](const SolverSettings& settings) { return measure_gait(robot, gait, settings); };
  const GaitMeasurement reference = empty(solver(kFinestStep_ms, kMostIterations));
  const GaitMeasurement usual = empty({});
  section.cases.push_back({"empty: speed", "m/s", reference.speed_m_s, usual.speed_m_s, 0.03});
  section.cases.push_back(
      {"empty: rms torque of the yaw joints", "Nm", reference.torque_rms_nm, usual.torque_rms_nm, 0.05, true, false});
  section.cases.push_back({"empty: largest gap at a joint", "mm", 0.0, 1e3 * usual.joint_gap_m, 0.5, false});
  auto grid = measure_grid<GaitMeasurement>("Empty:",
                                            {{"speed [m/s]", &GaitMeasurement::speed_m_s, 1.0},
                                             {"rms torque [Nm]", &GaitMeasurement::torque_rms_nm, 1.0},
                                             {"largest joint gap [mm]", &GaitMeasurement::joint_gap_m, 1e3},
                                             {"ripple of the torque [Nm]", &GaitMeasurement::ripple_nm, 1.0},
                                             {"tracking error [mrad]", &GaitMeasurement::tracking_rad, 1e3}},
                                            kSteps_ms, kIterations, empty);
  grid.table.rows.push_back({shown(kFinestStep_ms), std::to_string(kMostIterations), shown(reference.speed_m_s),
                             shown(reference.torque_rms_nm), shown(1e3 * reference.joint_gap_m),
                             shown(reference.ripple_nm), shown(1e3 * reference.tracking_rad)});
  section.tables.push_back(grid.table);
  section.figures.push_back({"Convergence of the empty gait", "convergence_empty.png", grid.plots});

  const auto loaded = [&](const SolverSettings& settings) { return measure_carrying(robot, settings); };
  const CarryingMeasurement fine = loaded(solver(1.0, 200));
  const CarryingMeasurement carrying = loaded({});
  section.cases.push_back({"loaded: speed", "m/s", fine.speed_m_s, carrying.speed_m_s, 0.1, true, false});
  section.cases.push_back(
      {"loaded: rms torque of the yaw joints", "Nm", fine.torque_rms_nm, carrying.torque_rms_nm, 0.1, true, false});
  section.cases.push_back(
      {"loaded: force on the object", "N", fine.object_force_n, carrying.object_force_n, 0.2, true, false});
  section.cases.push_back({"loaded: way of the object in the bend in 10 s", "m", 0.0, carrying.slip_m, 0.02, false});
  section.cases.push_back({"loaded: largest gap at a joint", "mm", 0.0, 1e3 * carrying.joint_gap_m, 2.0, false});
  const auto load =
      measure_grid<CarryingMeasurement>("Loaded:",
                                        {{"speed [m/s]", &CarryingMeasurement::speed_m_s, 1.0},
                                         {"rms torque [Nm]", &CarryingMeasurement::torque_rms_nm, 1.0},
                                         {"largest joint gap [mm]", &CarryingMeasurement::joint_gap_m, 1e3},
                                         {"force on the object [N]", &CarryingMeasurement::object_force_n, 1.0}},
                                        {5.0, 4.0, 2.0, 1.0}, {20, 50, 100, 200}, loaded);
  section.tables.push_back(load.table);
  section.figures.push_back({"Convergence of the gait with an object", "convergence_loaded.png", load.plots});
  return section;
}

}  // namespace constrictor::validation
