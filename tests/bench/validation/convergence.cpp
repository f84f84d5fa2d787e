// How much the results depend on the step and the iterations of the solver.
#include <cmath>

#include "bench/validation/carrying.hpp"
#include "bench/validation/checks.hpp"
#include "bench/validation/rigs.hpp"

namespace constrictor::validation {
namespace {

SolverSettings ode(double step_ms, int iterations) {
  SolverSettings settings;
  settings.engine = kEngineOde;
  settings.step_s = 1e-3 * step_ms;
  settings.iterations = iterations;
  return settings;
}

SolverSettings chain(double step_ms) {
  SolverSettings settings;
  settings.engine = kEngineChain;
  settings.step_s = 1e-3 * step_ms;
  return settings;
}

constexpr double kFinestStep_ms = 0.5;
constexpr double kReferenceStep_ms = 0.125;  // of `chain` alone
constexpr double kConverged = 0.01;          // share by which twice the step of a converged solution may change it
constexpr int kMostIterations = 400;         // of ode
// Whole numbers of steps make a control period of 20 ms.
const std::vector<double> kSteps_ms{10.0, 5.0, 4.0, 2.0, 1.0, 0.5};
const std::vector<int> kIterations{20, 50, 200};

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
  grid.table = {caption, {"engine", "step [ms]"}, {}};
  for (const auto& column : columns) {
    grid.table.columns.push_back(column.name);
    grid.plots.push_back({column.name, "step [ms]", "", {}});
  }
  const auto measure_series = [&](const std::string& name, const auto& settings_of) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      grid.plots[c].series.push_back({name, {}, {}, Mark::kLineWithDots});
    for (const double step_ms : steps_ms) {
      const Measurement found = experiment(settings_of(step_ms));
      std::vector<std::string> row{name, shown(step_ms)};
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const double value = columns[c].factor * (found.*columns[c].value);
        row.push_back(shown(value));
        grid.plots[c].series.back().x.push_back(step_ms);
        grid.plots[c].series.back().y.push_back(value);
      }
      grid.table.rows.push_back(row);
    }
  };
  measure_series("chain", chain);
  for (const int count : iterations)
    measure_series(fmt::format("ode, {} iterations", count), [&](double step_ms) { return ode(step_ms, count); });
  return grid;
}

/// Compares the carrying robot at the default step with the reference, and the reference with twice its step.
/// `force_required`: whether the force on the object has to be right, too.
void check_carrying(Section& section, const std::string& name, const RobotModel& robot, double lift_rad,
                    bool force_required) {
  ControlConfig control;
  control.lift_rad = lift_rad;
  const CarryingMeasurement reference = measure_carrying(robot, chain(kReferenceStep_ms), control);
  const CarryingMeasurement doubled = measure_carrying(robot, chain(2.0 * kReferenceStep_ms), control);
  const CarryingMeasurement usual = measure_carrying(robot, {}, control);
  const auto compare = [&](const char* what, const char* unit, double CarryingMeasurement::*value, double limit,
                           bool required) {
    section.cases.push_back({name + ": " + what, unit, reference.*value, usual.*value, limit, true, required});
    section.cases.push_back(
        {name + ", 0.25 ms: " + what, unit, reference.*value, doubled.*value, kConverged, true, required});
  };
  compare("speed", "m/s", &CarryingMeasurement::speed_m_s, 0.03, true);
  compare("rms torque of the yaw joints", "Nm", &CarryingMeasurement::torque_rms_nm, 0.05, true);
  compare("mean torque of the joints that press on the object", "Nm", &CarryingMeasurement::base_torque_nm, 0.05,
          force_required);
  compare("rms force of the ground on a module", "N", &CarryingMeasurement::ground_force_n, 0.05, true);
  compare("force on the object", "N", &CarryingMeasurement::object_force_n, 0.05, force_required);
  section.cases.push_back({name + ": way of the object in the bend in 10 s", "m", 0.0, usual.slip_m, 0.02, false});
  section.cases.push_back({name + ": largest gap at a joint", "mm", 0.0, 1e3 * usual.joint_gap_m, 0.2, false});
}

}  // namespace

Section check_convergence() {
  Section section{
      "Convergence of the solver",
      "The same motion with both engines and other steps. The default is compared with `chain` and a step of 0.125 ms, "
      "which is converged: a step of 0.25 ms changes it by at most 1 %. With a step of 0.5 ms, `chain` is compared "
      "with "
      "`ode` at 400 iterations, empty. Loaded: the robot carries a cylinder of 0.4 kg in a "
      "bend of its body. Its motion is not periodic and slips a little, so that its figures scatter. The torque of "
      "the empty gait is not determined by the law of friction: points that do not slip hold forces against each "
      "other, as far as the softness of the model allows.",
      {},
      {},
      {}};
  const RobotModel robot = mamba();
  const Gait gait = lateral_gait(robot, {});

  const auto empty = [&](const SolverSettings& settings) { return measure_gait(robot, gait, settings); };
  const GaitMeasurement reference = empty(chain(kReferenceStep_ms));
  const GaitMeasurement doubled = empty(chain(2.0 * kReferenceStep_ms));
  const GaitMeasurement fine = empty(chain(kFinestStep_ms));
  const GaitMeasurement other = empty(ode(kFinestStep_ms, kMostIterations));
  const GaitMeasurement usual = empty({});
  section.cases.push_back({"empty: speed", "m/s", reference.speed_m_s, usual.speed_m_s, 0.03});
  section.cases.push_back(
      {"empty: rms torque of the yaw joints", "Nm", reference.torque_rms_nm, usual.torque_rms_nm, 0.05});
  section.cases.push_back(
      {"empty: rms force of the ground on a module", "N", reference.ground_force_n, usual.ground_force_n, 0.05});
  section.cases.push_back({"empty: largest gap at a joint", "mm", 0.0, 1e3 * usual.joint_gap_m, 0.2, false});
  section.cases.push_back({"empty, 0.25 ms: speed", "m/s", reference.speed_m_s, doubled.speed_m_s, kConverged});
  section.cases.push_back(
      {"empty, 0.25 ms: rms torque", "Nm", reference.torque_rms_nm, doubled.torque_rms_nm, kConverged});
  section.cases.push_back({"empty, 0.25 ms: rms force of the ground on a module", "N", reference.ground_force_n,
                           doubled.ground_force_n, kConverged});
  section.cases.push_back({"empty, 0.5 ms: speed, ode", "m/s", fine.speed_m_s, other.speed_m_s, 0.02});
  section.cases.push_back(
      {"empty, 0.5 ms: rms torque, ode", "Nm", fine.torque_rms_nm, other.torque_rms_nm, 0.05, true, false});
  auto grid = measure_grid<GaitMeasurement>("Empty:",
                                            {{"speed [m/s]", &GaitMeasurement::speed_m_s, 1.0},
                                             {"rms torque [Nm]", &GaitMeasurement::torque_rms_nm, 1.0},
                                             {"largest joint gap [mm]", &GaitMeasurement::joint_gap_m, 1e3},
                                             {"ripple of the torque [Nm]", &GaitMeasurement::ripple_nm, 1.0},
                                             {"tracking error [mrad]", &GaitMeasurement::tracking_rad, 1e3}},
                                            kSteps_ms, kIterations, empty);
  section.tables.push_back(grid.table);
  section.figures.push_back({"Convergence of the empty gait", "convergence_empty.png", grid.plots});

  check_carrying(section, "loaded", robot, ControlConfig{}.lift_rad, true);
  check_carrying(section, "loaded, base on the ground", robot, 0.0, false);
  check_carrying(section, "loaded, serpens", robot_file("serpens"), ControlConfig{}.lift_rad, false);
  const auto loaded = [&](const SolverSettings& settings) { return measure_carrying(robot, settings); };
  const auto load =
      measure_grid<CarryingMeasurement>("Loaded:",
                                        {{"speed [m/s]", &CarryingMeasurement::speed_m_s, 1.0},
                                         {"rms torque [Nm]", &CarryingMeasurement::torque_rms_nm, 1.0},
                                         {"largest joint gap [mm]", &CarryingMeasurement::joint_gap_m, 1e3},
                                         {"force on the object [N]", &CarryingMeasurement::object_force_n, 1.0}},
                                        {5.0, 4.0, 2.0, 1.0, 0.5}, {50, 200}, loaded);
  section.tables.push_back(load.table);
  Table lifts{"Loaded: the base of the bend is raised by the pitch joints beside it.",
              {"lift [rad]", "speed [m/s]", "rms torque [Nm]", "force on the object [N]", "way in the bend [m]"},
              {}};
  for (const double lift_rad : {0.0, 0.002, 0.005, 0.01, 0.02, 0.05}) {
    ControlConfig control;
    control.lift_rad = lift_rad;
    const CarryingMeasurement found = measure_carrying(robot, {}, control);
    lifts.rows.push_back({shown(lift_rad), shown(found.speed_m_s), shown(found.torque_rms_nm),
                          shown(found.object_force_n), shown(found.slip_m)});
  }
  section.tables.push_back(lifts);
  section.figures.push_back({"Convergence of the gait with an object", "convergence_loaded.png", load.plots});
  return section;
}

}  // namespace constrictor::validation
