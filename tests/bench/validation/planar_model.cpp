#include "bench/validation/planar_model.hpp"

#include <cmath>
#include <numbers>

namespace constrictor::validation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kGravity_m_s2 = 9.81;

/// [kg m²] of a solid capsule about a transverse axis through its centre; `length` is that of its cylinder.
double capsule_inertia(double mass, double radius, double length) {
  const double cylinder = radius * radius * length;  // volumes divided by pi
  const double sphere = 4.0 / 3.0 * radius * radius * radius;
  const double cylinder_mass = mass * cylinder / (cylinder + sphere);
  const double sphere_mass = mass - cylinder_mass;
  return cylinder_mass * (radius * radius / 4.0 + length * length / 12.0) +
         sphere_mass * (0.4 * radius * radius + length * length / 4.0 + 0.375 * length * radius);
}

/// The matrix B for which link i has its centre at p + sum_j B_ij (cos theta_j, sin theta_j), with p the centre of
/// mass.
MatrixXd centre_matrix(const PlanarRobot& robot) {
  const Index n = robot.length_m.size();
  MatrixXd from_head = MatrixXd::Zero(n, n);  // the same with p the centre of the first link
  for (Index i = 1; i < n; ++i) {
    from_head.row(i) = from_head.row(i - 1);
    from_head(i, i - 1) -= 0.5 * robot.length_m[i - 1];
    from_head(i, i) -= 0.5 * robot.length_m[i];
  }
  const Eigen::RowVectorXd centre = robot.mass_kg.transpose() * from_head / robot.mass_kg.sum();
  return from_head.rowwise() - centre;
}

}  // namespace

PlanarRobot planar_robot(const RobotModel& robot, FrictionPlaces places) {
  std::vector<int> modules{1};  // of each link: a yaw joint begins a new one
  for (const JointModel& joint : robot.joints) {
    if (joint.axis == JointAxis::kYaw) {
      modules.push_back(1);
    } else {
      ++modules.back();
    }
  }
  const double length = robot.module_length_m;
  const double mass = robot.module_mass_kg;
  const double inertia = capsule_inertia(mass, robot.module_radius_m, length);
  const auto n = static_cast<Index>(modules.size());
  PlanarRobot planar{VectorXd(n), VectorXd(n), VectorXd::Zero(n), {}};
  for (Index i = 0; i < n; ++i) {
    const int count = modules[static_cast<std::size_t>(i)];
    planar.length_m[i] = count * length;
    planar.mass_kg[i] = count * mass;
    for (int k = 0; k < count; ++k) {
      const double centre = (0.5 * (count - 1) - k) * length;
      planar.inertia_kg_m2[i] += inertia + mass * centre * centre;
      if (places == FrictionPlaces::kModuleCentres) planar.points.push_back({i, centre, mass * kGravity_m_s2});
      if (places != FrictionPlaces::kModuleEnds) continue;
      for (const double end : {0.5, -0.5})
        planar.points.push_back({i, centre + end * length, 0.5 * mass * kGravity_m_s2});
    }
    if (places == FrictionPlaces::kLinkCentres) planar.points.push_back({i, 0.0, count * mass * kGravity_m_s2});
  }
  return planar;
}

PlanarModel::PlanarModel(const PlanarRobot& robot, const GroundFriction& friction)
    : robot_(robot),
      friction_(friction),
      mass_kg_(robot.mass_kg.sum()),
      B_(centre_matrix(robot)),
      G_(B_.transpose() * robot.mass_kg.asDiagonal() * B_) {}

PlanarModel::Links PlanarModel::links(const PlanarState& state, const JointMotion& motion) const {
  const Index n = robot_.length_m.size();
  Links links{VectorXd(n), VectorXd(n), VectorXd(n)};
  double heading = state.heading_rad;
  double rate = state.turn_rad_s;
  for (Index i = 0; i < n; ++i) {
    links.cosine[i] = std::cos(heading);
    links.sine[i] = std::sin(heading);
    links.rate[i] = rate;
    if (i + 1 == n) break;
    heading -= motion.angle_rad[i];  // joint i: heading of link i minus heading of link i + 1
    rate -= motion.rate_rad_s[i];
  }
  return links;
}

Vector2d PlanarModel::forward(const PlanarState& state, const JointMotion& motion) const {
  const Links at = links(state, motion);
  return Vector2d(at.cosine.sum(), at.sine.sum()).normalized();
}

PlanarModel::Instant PlanarModel::evaluate(const PlanarState& state, const JointMotion& motion) const {
  const Index n = robot_.length_m.size();
  const Links at = links(state, motion);
  const VectorXd vx = VectorXd::Constant(n, state.velocity_m_s.x()) - B_ * at.sine.cwiseProduct(at.rate);
  const VectorXd vy = VectorXd::Constant(n, state.velocity_m_s.y()) + B_ * at.cosine.cwiseProduct(at.rate);

  // Forces of the ground: sum on each link, and moment about the link's centre.
  Instant instant;
  VectorXd fx = VectorXd::Zero(n);
  VectorXd fy = VectorXd::Zero(n);
  VectorXd moment = VectorXd::Zero(n);
  for (const FrictionPoint& point : robot_.points) {
    const Index i = point.link;
    const double along = at.cosine[i] * vx[i] + at.sine[i] * vy[i];
    const double across = at.cosine[i] * vy[i] - at.sine[i] * vx[i] + point.offset_m * at.rate[i];
    const auto force = [&](double coefficient, double v) {
      if (friction_.law == FrictionLaw::kViscous) return -coefficient * v;
      return -coefficient * point.weight_n * v / std::hypot(v, friction_.smoothing_m_s);
    };
    double f_along = force(friction_.along, along);
    double f_across = force(friction_.across, across);
    if (friction_.law == FrictionLaw::kEllipse) {
      const double u = friction_.along * along;
      const double v = friction_.across * across;
      const double smoothing = std::sqrt(friction_.along * friction_.across) * friction_.smoothing_m_s;
      const double share = -point.weight_n / std::hypot(u, v, smoothing);
      f_along = share * friction_.along * u;
      f_across = share * friction_.across * v;
    }
    fx[i] += at.cosine[i] * f_along - at.sine[i] * f_across;
    fy[i] += at.sine[i] * f_along + at.cosine[i] * f_across;
    moment[i] += point.offset_m * f_across;
    instant.friction_power_w -= f_along * along + f_across * across;
  }

  const MatrixXd M = MatrixXd(robot_.inertia_kg_m2.asDiagonal()) +
                     G_.cwiseProduct(at.cosine * at.cosine.transpose() + at.sine * at.sine.transpose());
  const MatrixXd W = G_.cwiseProduct(at.sine * at.cosine.transpose() - at.cosine * at.sine.transpose());
  const VectorXd ground =
      at.cosine.cwiseProduct(B_.transpose() * fy) - at.sine.cwiseProduct(B_.transpose() * fx) + moment;
  const VectorXd rest = W * at.rate.cwiseAbs2() - ground;  // M theta" + rest = D^T u

  // theta" = e * (first link's) + shape, where the joints give the shape. The columns of D^T sum up to 0, so that the
  // sum of all rows has no joint torque and gives the first link's acceleration.
  VectorXd shape = VectorXd::Zero(n);
  for (Index i = 1; i < n; ++i) shape[i] = shape[i - 1] - motion.acceleration_rad_s2[i - 1];
  const VectorXd inertia = M.rowwise().sum();
  instant.turn_acceleration_rad_s2 = -((M * shape).sum() + rest.sum()) / inertia.sum();
  instant.acceleration_m_s2 = Vector2d(fx.sum(), fy.sum()) / mass_kg_;

  const VectorXd rows = M * shape + inertia * instant.turn_acceleration_rad_s2 + rest;
  instant.torque_nm.resize(n - 1);
  double sum = 0.0;
  for (Index i = 0; i + 1 < n; ++i) instant.torque_nm[i] = sum += rows[i];
  instant.joint_power_w = instant.torque_nm.dot(motion.rate_rad_s);
  instant.kinetic_energy_j = 0.5 * at.rate.dot(M * at.rate) + 0.5 * mass_kg_ * state.velocity_m_s.squaredNorm();
  instant.angular_momentum_nms = (M * at.rate).sum();
  return instant;
}

void PlanarModel::step(PlanarState& state, double time_s, double step_s,
                       const std::function<JointMotion(double)>& motion) const {
  struct Slope {
    double turn, turn_rate;
    Vector2d velocity, acceleration;
  };
  const auto slope = [&](const PlanarState& s, const JointMotion& joints) {
    const Instant instant = evaluate(s, joints);
    return Slope{s.turn_rad_s, instant.turn_acceleration_rad_s2, s.velocity_m_s, instant.acceleration_m_s2};
  };
  const auto moved = [&state](const Slope& k, double h) {
    return PlanarState{state.heading_rad + h * k.turn, state.centre_m + h * k.velocity,
                       state.turn_rad_s + h * k.turn_rate, state.velocity_m_s + h * k.acceleration};
  };
  const JointMotion middle = motion(time_s + 0.5 * step_s);
  const Slope k1 = slope(state, motion(time_s));
  const Slope k2 = slope(moved(k1, 0.5 * step_s), middle);
  const Slope k3 = slope(moved(k2, 0.5 * step_s), middle);
  const Slope k4 = slope(moved(k3, step_s), motion(time_s + step_s));
  const auto mean = [](const auto& a, const auto& b, const auto& c, const auto& d) {
    return ((a + 2.0 * b + 2.0 * c + d) / 6.0);
  };
  state = moved({mean(k1.turn, k2.turn, k3.turn, k4.turn), mean(k1.turn_rate, k2.turn_rate, k3.turn_rate, k4.turn_rate),
                 Vector2d(mean(k1.velocity, k2.velocity, k3.velocity, k4.velocity)),
                 Vector2d(mean(k1.acceleration, k2.acceleration, k3.acceleration, k4.acceleration))},
                step_s);
}

PlanarMeasurement measure_planar(const PlanarModel& model, const LateralUndulation& gait, int settle_cycles, int cycles,
                                 double largest_step_s) {
  const int steps = static_cast<int>(std::ceil(gait.period_s() / largest_step_s));
  const double step_s = gait.period_s() / steps;
  const auto motion = [&](double time_s) { return gait.at(time_s, model.joint_count()); };
  PlanarState state;
  PlanarMeasurement found;
  double torque_squares = 0.0;
  for (int cycle = 0; cycle < settle_cycles + cycles; ++cycle) {
    const bool measured = cycle >= settle_cycles;
    const Vector2d from = state.centre_m;
    const Vector2d forward = model.forward(state, motion(cycle * gait.period_s()));
    for (int i = 0; i < steps; ++i) {
      const double time_s = (cycle * steps + i) * step_s;
      if (measured) {
        const PlanarModel::Instant instant = model.evaluate(state, motion(time_s));
        torque_squares += instant.torque_nm.squaredNorm();
        found.power_w += instant.friction_power_w / (cycles * steps);
      }
      model.step(state, time_s, step_s, motion);
    }
    if (measured) found.speed_m_s += forward.dot(state.centre_m - from) / (cycles * gait.period_s());
  }
  found.torque_rms_nm = std::sqrt(torque_squares / (static_cast<double>(model.joint_count()) * cycles * steps));
  return found;
}

}  // namespace constrictor::validation
