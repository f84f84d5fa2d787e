// Free fall, pendulum, momentum, energy and sliding: laws that no setting of the solver changes.
#include <cmath>
#include <numbers>

#include "bench/validation/checks.hpp"
#include "bench/validation/rigs.hpp"

namespace constrictor::validation {
namespace {

using Eigen::Vector3d;

void check_fall(Section& section) {
  constexpr double kDuration_s = 0.6;
  World world(mamba(), in_the_air(3.0));
  const double start_m = world.module_pose(5).translation().z();
  Series simulated{"simulated", {0.0}, {0.0}, Mark::kDots};
  while (world.time_s() < kDuration_s - 1e-9) {
    hold(world, 0.0, 6.0, kPeriod_s);
    simulated.x.push_back(world.time_s());
    simulated.y.push_back(start_m - world.module_pose(5).translation().z());
  }
  Series parabola{"g t^2 / 2", simulated.x, {}, Mark::kLine};
  for (const double t : parabola.x) parabola.y.push_back(0.5 * kG * t * t);
  section.cases.push_back({"free fall: way after 0.6 s, g t²/2", "m", parabola.y.back(), simulated.y.back(), 0.01});
  section.cases.push_back(
      {"free fall: speed after 0.6 s, g t", "m/s", kG * kDuration_s, -world.module_velocity_m_s(5).z(), 1e-6});
  section.cases.push_back({"free fall: acceleration that the inertial unit feels", "m/s²", 0.0,
                           world.imu().proper_acceleration_m_s2.norm(), 1e-6, false});
  section.figures.push_back(
      {"Free fall", "free_fall.png", {{"Way of a falling module", "time [s]", "way [m]", {parabola, simulated}}}});
}

void check_pendulum(Section& section) {
  const RobotModel robot = mamba();
  const double d = 0.5 * robot.module_length_m;  // from the pivot to the centre of mass
  const double inertia = capsule_inertia(robot.module_mass_kg, robot.module_radius_m, robot.module_length_m) +
                         robot.module_mass_kg * d * d + kSwingingRotor_kg_m2;
  const double usual_ms = 1e3 * SolverSettings{}.step_s;
  Figure figure{
      "Pendulum: the head swings on a relaxed joint, with its rotor, over the edge of a table", "pendulum.png", {}};
  Table table{"The same with other steps of the solver:", {"amplitude", "step [ms]", "period [s]", "energy lost"}, {}};
  for (const double amplitude_rad : {0.2, 1.2}) {
    const double period_s =
        4.0 * std::sqrt(inertia / (robot.module_mass_kg * kG * d)) * std::comp_ellint_1(std::sin(0.5 * amplitude_rad));
    for (const double step_ms : {usual_ms, 0.5 * usual_ms, 0.2 * usual_ms}) {
      SolverSettings settings;
      settings.step_s = 1e-3 * step_ms;
      const Swing swing = swing_head(amplitude_rad, 3.0, settings);
      // The energy of the swing, averaged over the first and over the last period.
      const auto span = static_cast<std::size_t>(std::lround(period_s / settings.step_s));
      const auto mean = [&](std::size_t from) {
        double sum = 0.0;
        for (std::size_t i = from; i < from + span; ++i) sum += swing.energy_j[i] / static_cast<double>(span);
        return sum;
      };
      const double whole_j = robot.module_mass_kg * kG * d * (1.0 - std::cos(amplitude_rad));
      const double lost = (mean(0) - mean(swing.energy_j.size() - span)) / whole_j;
      table.rows.push_back({fmt::format("{} rad", amplitude_rad), shown(step_ms), shown(swing.period_s()),
                            fmt::format("{:.2f} % in {:.1f} periods", 100.0 * lost, 3.0 / period_s - 1.0)});
      if (step_ms < usual_ms) continue;
      const std::string name = fmt::format("pendulum, amplitude {} rad: ", amplitude_rad);
      section.cases.push_back({name + "period, complete elliptic integral", "s", period_s, swing.period_s(), 0.01});
      section.cases.push_back({name + "share of its energy lost in 3 s", "1", 0.0, lost, 0.01, false});
      figure.plots.push_back({fmt::format("Amplitude {} rad", amplitude_rad),
                              "time [s]",
                              "angle [rad]",
                              {{"", swing.time_s, swing.angle_rad, Mark::kLine}}});
    }
  }
  section.tables.push_back(table);
  section.figures.push_back(figure);
}

/// Momentum about the vertical through the origin of W, and linear momentum, of the robot and of all objects.
struct Momentum {
  Vector3d linear_ns{0.0, 0.0, 0.0};
  double angular_nms = 0.0;
  double kinetic_j = 0.0;
};

Momentum momentum_of(const World& world) {
  const RobotModel& robot = world.robot();
  const double mass = robot.module_mass_kg;
  const double inertia = capsule_inertia(mass, robot.module_radius_m, robot.module_length_m);
  Momentum sum;
  const auto add = [&sum](double m, double J, const Vector3d& p, const Vector3d& v, const Vector3d& w) {
    sum.linear_ns += m * v;
    sum.angular_nms += m * p.cross(v).z() + J * w.z();
    sum.kinetic_j += 0.5 * m * v.squaredNorm() + 0.5 * J * w.squaredNorm();
  };
  for (std::size_t i = 0; i < world.module_count(); ++i) {
    add(mass, inertia, world.module_pose(i).translation(), world.module_velocity_m_s(i),
        world.module_angular_velocity_rad_s(i));
  }
  for (std::size_t i = 0; i < world.object_count(); ++i) {
    const ScenarioObject& object = world.scenario().objects[i];
    add(object.mass_kg, 0.5 * object.mass_kg * object.size_m.x() * object.size_m.x(),
        world.object_pose(i).translation(), world.object_velocity_m_s(i), world.object_angular_velocity_rad_s(i));
  }
  return sum;
}

/// Momentum that a robot gives itself by swinging, without gravity or on ground without friction: there is none.
void check_swinging(Section& section, const std::string& name, const Scenario& scenario) {
  RobotModel robot = chain(24, JointAxis::kYaw);
  for (JointModel& joint : robot.joints) {  // no joint reaches its end stop, which would take energy
    joint.min_rad = -3.0;
    joint.max_rad = 3.0;
    joint.rotor_inertia_kg_m2 = 0.0;  // whose energy would come and go
  }
  World world(robot, scenario);
  OpenLoopGait gait;
  gait.amplitude_rad = 0.15;  // with a yaw joint at each module
  double largest_m_s = 0.0;
  for (int tick = 0; tick < 60; ++tick) {
    gait.drive(world, tick * kPeriod_s, kPeriod_s);
    largest_m_s = std::max(largest_m_s, world.module_velocity_m_s(23).norm());
  }
  const Momentum driven = momentum_of(world);
  // The ground holds vertically.
  const double linear_ns = scenario.gravity_m_s2.isZero() ? driven.linear_ns.norm() : driven.linear_ns.head<2>().norm();
  const double scale_ns = 24 * robot.module_mass_kg * largest_m_s;
  section.cases.push_back({name + ": linear momentum, as a share of mass times the tail's speed", "1", 0.0,
                           linear_ns / scale_ns, 1e-6, false});
  section.cases.push_back({name + ": angular momentum, as a share of the same times 1 m", "1", 0.0,
                           std::abs(driven.angular_nms) / scale_ns, 0.01, false});
  hold(world, 0.0, 0.0, 0.5);
  section.cases.push_back(
      {name + ", then relaxed: kinetic energy after 0.5 s", "J", driven.kinetic_j, momentum_of(world).kinetic_j, 0.01});
}

void check_collision(Section& section) {
  // A cylinder slides into the side of the robot; nothing else acts, because the ground is without friction.
  Scenario ice = with_object({0.085, 0.085, 0.15}, 0.8);
  ice.objects[0].position_m = {-0.6, 0.3};
  ice.friction.ground_scale = 0.0;
  ice.friction.object_ground = 0.0;
  World world(mamba(), ice);
  hold(world, 0.0, 6.0, 0.2);
  world.apply_force(0, {0.0, -60.0, 0.0});
  world.advance(kPeriod_s);
  const Momentum before = momentum_of(world);
  hold(world, 0.0, 6.0, 0.6);
  const Momentum after = momentum_of(world);
  section.cases.push_back(
      {"collision on ice: momentum of robot and object", "N s", before.linear_ns.y(), after.linear_ns.y(), 1e-3});
  section.cases.push_back({"collision on ice: speed of the object afterwards (it must have hit the robot)", "m/s", 0.0,
                           world.object_velocity_m_s(0).y(), 0.75 * std::abs(before.linear_ns.y() / 0.8), false});
  section.cases.push_back(
      {"collision on ice: angular momentum of robot and object", "N m s", before.angular_nms, after.angular_nms, 0.02});
}

/// [m] how far an object slides that a force has pushed for one tick in this direction.
double coasted_m(BodyShape shape, double direction_rad, double force_n) {
  Scenario scenario = with_object({0.1, 0.1, 0.06}, 0.5);
  scenario.objects[0].shape = shape;
  scenario.objects[0].yaw_rad = direction_rad;  // the object turns with the push: only the world's axes differ
  World world(chain(2, JointAxis::kYaw), scenario);
  hold(world, 0.0, 6.0, 0.2);
  const Vector3d from = world.object_pose(0).translation();
  world.apply_force(0, force_n * Vector3d(std::cos(direction_rad), std::sin(direction_rad), 0.0));
  world.advance(kPeriod_s);
  hold(world, 0.0, 6.0, 1.5);
  return (world.object_pose(0).translation() - from).head<2>().norm();
}

void check_coasting(Section& section) {
  constexpr double kForce_n = 40.0;
  const double mu = Scenario{}.friction.object_ground;
  const double speed_m_s = (kForce_n / 0.5 - mu * kG) * kPeriod_s;
  const double law_m = speed_m_s * speed_m_s / (2.0 * mu * kG) + 0.5 * speed_m_s * kPeriod_s;
  for (const auto& [shape, name] : {std::pair{BodyShape::kCylinder, "cylinder"}, std::pair{BodyShape::kBox, "box"}}) {
    for (const double degrees : {0.0, 45.0}) {
      section.cases.push_back({fmt::format("pushed {} on the ground, {:.0f}° to the axes of the world: way until it "
                                           "rests, v²/(2 mu g)",
                                           name, degrees),
                               "m", law_m, coasted_m(shape, degrees * std::numbers::pi / 180.0, kForce_n), 0.02});
    }
  }
}

}  // namespace

Section check_free_bodies() {
  Section section{"Free bodies",
                  "Free fall, a pendulum, momentum, energy and a pushed object, compared with their laws. The solver "
                  "integrates with steps of h by the semi-implicit Euler method; its error in free fall is g t h / 2.",
                  {},
                  {},
                  {}};
  check_fall(section);
  check_pendulum(section);
  Scenario space = in_the_air(3.0);
  space.gravity_m_s2.setZero();
  check_swinging(section, "swinging without gravity", space);
  Scenario ice;
  ice.friction.ground_scale = 0.0;
  check_swinging(section, "swinging on ice", ice);
  check_collision(section);
  check_coasting(section);
  return section;
}

}  // namespace constrictor::validation
