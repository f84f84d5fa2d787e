// The speed of the simulated gait against the planar model of Liljebäck's book, which shares no code with it.
#include <cmath>
#include <functional>
#include <numbers>

#include "bench/validation/checks.hpp"
#include "bench/validation/gait_run.hpp"
#include "bench/validation/planar_model.hpp"

namespace constrictor::validation {
namespace {

constexpr double kAim = 0.1;
constexpr double kEllipseLimit = 0.03;
constexpr double kSlow_m_s = 0.05;  // below this speed the gait does not propel, and shares of it mean nothing
constexpr double kSlowAim_m_s = 0.005;
constexpr int kSettleCycles = 5;  // with little friction across, the body takes that long to reach its speed
constexpr double kDegree = std::numbers::pi / 180.0;

/// A robot on a ground, and its gait.
struct Setting {
  LateralUndulation gait;
  double along = 0.05;
  double across = 0.5;
};

/// One setting in the simulation and in the planar model.
struct Comparison {
  GaitMeasurement simulated;
  PlanarMeasurement links;    ///< the ground acts on the centres of the links
  PlanarMeasurement modules;  ///< the ground acts on the centres of the modules
  PlanarMeasurement ends;     ///< the ground acts on both ends of each module, as in the simulation
};

Comparison compare_setting(const Setting& setting) {
  RobotModel robot = mamba();
  robot.friction_along = setting.along;
  robot.friction_across = setting.across;
  const GroundFriction friction{FrictionLaw::kCoulomb, setting.along, setting.across};
  const auto planar = [&](FrictionPlaces places) {
    return measure_planar(PlanarModel(planar_robot(robot, places), friction), setting.gait, kSettleCycles, 2);
  };
  return {measure_gait(robot, lateral_gait(robot, setting.gait), {}, kSettleCycles),
          planar(FrictionPlaces::kLinkCentres), planar(FrictionPlaces::kModuleCentres),
          planar(FrictionPlaces::kModuleEnds)};
}

/// One parameter of the setting that varies while the others keep their defaults.
struct Sweep {
  const char* name;
  const char* label;  ///< of the axis in the plot
  std::vector<double> values;
  std::function<void(Setting&, double)> apply;
};

const std::vector<Sweep>& sweeps() {
  static const std::vector<Sweep> all{
      {"amplitude of the joints [deg]",
       "amplitude [deg]",
       {10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0},
       [](Setting& s, double value) { s.gait.amplitude_rad = value * kDegree; }},
      {"period [s]",
       "frequency [Hz]",
       {4.0, 2.8, 2.0, 1.4, 1.0, 0.8},
       [](Setting& s, double value) { s.gait.frequency_hz = 1.0 / value; }},
      {"phase offset [deg]",
       "phase offset [deg]",
       {30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0},
       [](Setting& s, double value) { s.gait.phase_offset_rad = value * kDegree; }},
      {"friction ratio (0.5 across)",
       "friction across / along",
       {2.0, 3.0, 5.0, 10.0, 15.0, 20.0},
       [](Setting& s, double value) { s.along = s.across / value; }},
  };
  return all;
}

/// Compares the speeds of the defaults after both models have been refined: a tenth of the smoothing of Coulomb's law
/// in the planar model, a tenth of the step in the simulation.
Case compare_fine_solutions() {
  const RobotModel robot = mamba();
  const Setting setting;
  GroundFriction sharp{FrictionLaw::kCoulomb, setting.along, setting.across};
  sharp.smoothing_m_s *= 0.1;
  SolverSettings fine;
  fine.step_s *= 0.1;
  const PlanarModel model(planar_robot(robot, FrictionPlaces::kModuleEnds), sharp);
  return {"defaults, both models refined: ends", "m/s", measure_planar(model, setting.gait, 3, 1, 2e-5).speed_m_s,
          measure_gait(robot, lateral_gait(robot, setting.gait), fine).speed_m_s, 0.01};
}

/// Compares the speed and the power with an elliptic bound on the friction in both models, at the ends of the modules.
void compare_ellipse(Section& section) {
  const RobotModel robot = mamba();
  const Setting setting;
  SolverSettings elliptic;
  elliptic.elliptic_friction = true;
  const PlanarModel model(planar_robot(robot, FrictionPlaces::kModuleEnds),
                          {FrictionLaw::kEllipse, setting.along, setting.across});
  const PlanarMeasurement planar = measure_planar(model, setting.gait, kSettleCycles, 2);
  const GaitMeasurement simulated = measure_gait(robot, lateral_gait(robot, setting.gait), elliptic, kSettleCycles);
  section.cases.push_back(
      {"defaults, elliptic friction: ends", "m/s", planar.speed_m_s, simulated.speed_m_s, kEllipseLimit});
  section.cases.push_back({"defaults, elliptic friction: power that friction takes, ends", "W", planar.power_w,
                           simulated.friction_j / simulated.duration_s, kEllipseLimit});
}

/// Compares the torque after the servos have become a thousand times as stiff: the joints then follow their setpoints
/// as exactly as those of the planar model, and the points that do not slip hold the same forces against each other.
Case compare_stiff_servos(double planar_nm) {
  RobotModel robot = mamba();
  for (JointModel& joint : robot.joints) {
    joint.position_gain_nm_rad *= 1000.0;
    joint.velocity_gain_nm_s_rad *= 30.0;
  }
  SolverSettings fine;
  fine.step_s *= 0.1;
  return {"defaults, servos a thousand times as stiff: rms torque of the joints, ends", "Nm", planar_nm,
          measure_gait(robot, lateral_gait(robot, {}), fine).torque_rms_nm, 0.05};
}

/// Adds cases, a table and a plot for one parameter.
void compare_sweep(Section& section, Figure& figure, const Sweep& sweep) {
  Series simulated{"simulation", {}, {}, Mark::kDots};
  Series links{"planar model, ground acts on centres of links", {}, {}, Mark::kLine};
  Series modules{"planar model, ground acts on centres of modules", {}, {}, Mark::kLine};
  Series ends{"planar model, ground acts on ends of modules", {}, {}, Mark::kLine};
  Table table{std::string("Simulation and planar model over ") + sweep.name + ":",
              {sweep.name, "simulated [m/s]", "links [m/s]", "difference", "modules [m/s]", "difference", "ends [m/s]",
               "difference", "simulated rms torque [Nm]", "ends [Nm]", "servos' tracking error [rad]"},
              {}};
  for (const double value : sweep.values) {
    Setting setting;
    sweep.apply(setting, value);
    const Comparison found = compare_setting(setting);
    const double speed_m_s = found.simulated.speed_m_s;
    const double x = std::string(sweep.label).starts_with("frequency") ? 1.0 / value : value;
    for (Series* series : {&simulated, &links, &modules, &ends}) series->x.push_back(x);
    simulated.y.push_back(speed_m_s);
    std::vector<std::string> row{shown(value), shown(speed_m_s)};
    const auto compare = [&](Series& model, double model_m_s, const char* places, bool required) {
      model.y.push_back(model_m_s);
      const bool slow = std::abs(model_m_s) < kSlow_m_s;
      row.push_back(shown(model_m_s));
      row.push_back(slow ? fmt::format("{:+.4f} m/s", speed_m_s - model_m_s)
                         : fmt::format("{:+.1f} %", 100.0 * (speed_m_s / model_m_s - 1.0)));
      if (places == nullptr) return;
      section.cases.push_back({fmt::format("{} {}: {}", sweep.name, shown(value), places), "m/s", model_m_s, speed_m_s,
                               slow ? kSlowAim_m_s : kAim, !slow, required});
    };
    compare(links, found.links.speed_m_s, "links", false);
    compare(modules, found.modules.speed_m_s, nullptr, false);
    compare(ends, found.ends.speed_m_s, "ends", true);  // the same places as in the simulation
    row.push_back(shown(found.simulated.torque_rms_nm));
    row.push_back(shown(found.ends.torque_rms_nm));
    row.push_back(shown(found.simulated.tracking_rad));
    table.rows.push_back(row);
  }
  section.tables.push_back(table);
  figure.plots.push_back(
      {std::string("Speed over ") + sweep.label, sweep.label, "speed [m/s]", {simulated, links, modules, ends}});
}

}  // namespace

Section check_planar_model() {
  Section section{
      "Planar model",
      "Lateral undulation in the simulation and in the planar model of Liljebäck et al. (2013), which is integrated "
      "separately: 13 links (two of them half as long) with our masses and Coulomb friction, joint angles "
      "a sin(2 pi f t - k delta), driven exactly. Defaults: amplitude 28.6°, period 1.4 s, phase offset 60°, "
      "friction 0.05 along and 0.5 across. Where the ground acts makes a difference: on the centre of each link of two "
      "modules (\"links\": the book's model), on both ends of each module, where the simulated contacts are "
      "(\"ends\"), or, without an aim, on the centre of each module (\"modules\"). The speeds shall agree within "
      "10 %, or 0.005 m/s where the gait hardly propels; this is required at the ends and an aim at the links. The "
      "torques are less certain than the speeds: points that do not slip across "
      "the body hold forces against each other, which depend on how far the servos yield.",
      {},
      {},
      {}};
  const Comparison usual = compare_setting({});
  section.cases.push_back({"defaults: rms torque of the joints, ends", "Nm", usual.ends.torque_rms_nm,
                           usual.simulated.torque_rms_nm, 2.0 * kAim, true, false});
  section.cases.push_back({"defaults: power that friction takes, ends", "W", usual.ends.power_w,
                           usual.simulated.friction_j / usual.simulated.duration_s, kAim});
  section.cases.push_back(compare_fine_solutions());
  compare_ellipse(section);
  section.cases.push_back(compare_stiff_servos(usual.ends.torque_rms_nm));
  Figure figure{"Speed of lateral undulation: simulation and planar model", "planar_model.png", {}};
  for (const Sweep& sweep : sweeps()) compare_sweep(section, figure, sweep);
  section.figures.push_back(figure);
  return section;
}

}  // namespace constrictor::validation
