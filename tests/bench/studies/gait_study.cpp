// scratch: gait measurements over settings
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include "unit/world/world_fixture.hpp"
using namespace constrictor;
using Eigen::Vector3d;
// angles with analytic end rate
struct Result {
  double speed, track, torque_rms, ripple, gap, wall;
};
static std::vector<double> rates_at(const OpenLoopGait& g, const RobotModel& r, double t, double T, bool mean) {
  if (mean) {
    auto a = g.angles(r, t - T), b = g.angles(r, t);
    for (size_t i = 0; i < a.size(); ++i) b[i] = (b[i] - a[i]) / T;
    return b;
  }
  const double e = 1e-4;
  auto a = g.angles(r, t - e), b = g.angles(r, t + e);
  for (size_t i = 0; i < a.size(); ++i) b[i] = (b[i] - a[i]) / (2 * e);
  return b;
}
int main(int c, char** v) {
  std::map<std::string, double> o;
  for (int i = 1; i < c; ++i) {
    std::string s = v[i];
    auto e = s.find('=');
    o[s.substr(0, e)] = atof(s.c_str() + e + 1);
  }
  auto get = [&](const char* k, double d) { return o.count(k) ? o[k] : d; };
  RobotModel robot = mamba();
  for (auto& j : robot.joints) {
    if (o.count("kp")) j.position_gain_nm_rad = o["kp"];
    if (o.count("kd")) j.velocity_gain_nm_s_rad = o["kd"];
    if (o.count("ia")) j.rotor_inertia_kg_m2 = o["ia"];
    if (o.count("k")) j.stiffness_nm_rad = o["k"];
    if (o.count("d")) j.damping_nm_s_rad = o["d"];
  }
  SolverSettings s;
  s.step_s = get("h", 0.004);
  s.iterations = (int)get("it", 50);
  s.over_relaxation = get("w", 1.7);
  s.cfm = get("cfm", 1e-5);
  s.erp = get("erp", 0.2);
  s.contact_stiffness_n_m = get("kc", 20000);
  s.contact_damping_n_s_m = get("dc", 50);
  s.one_ground_contact_a_joint = get("one", 1) > 0;
  World world(robot, Scenario{}, s);
  OpenLoopGait g;
  g.amplitude_rad = get("A", 0.5);
  g.frequency_hz = get("f", 0.7);
  g.wavelength_m = get("wl", 1.07);
  const double T = 0.02;
  double t = 0;
  const int settle = int(get("settle", 3) / T), ticks = int(get("dur", 6) / T);
  const bool mean = get("mean", 0) > 0;
  auto centre = [&] {
    Vector3d q = Vector3d::Zero();
    for (size_t i = 0; i < 24; ++i) q += world.module_pose(i).translation();
    return Vector3d(q / 24);
  };
  double e2 = 0, t2 = 0, r2 = 0;
  long n = 0, m = 0;
  double gap = 0;
  Vector3d from;
  // half-step accounting through observer
  std::vector<std::vector<double>> tick_torque(23);
  auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < settle + ticks; ++k, t += T) {
    if (k == settle) {
      from = centre();
      begin = std::chrono::steady_clock::now();
    }
    auto q = g.angles(robot, t + T);
    auto w = rates_at(g, robot, t + T, T, mean);
    std::vector<double> lim(23, 6.0);
    world.set_servo(q, w, lim);
    for (auto& x : tick_torque) x.clear();
    world.advance(T, [&] {
      for (size_t i = 0; i < 23; ++i) tick_torque[i].push_back(world.joint(i).step_torque_nm());
    });
    if (k < settle) continue;
    for (size_t i = 0; i < 23; i += 2) {
      double mean_t = 0;
      for (double x : tick_torque[i]) mean_t += x;
      mean_t /= tick_torque[i].size();
      for (double x : tick_torque[i]) {
        r2 += (x - mean_t) * (x - mean_t);
        ++m;
      }
      t2 += mean_t * mean_t;
      double e = q[i] - world.joint_angle_rad(i);
      e2 += e * e;
      ++n;
    }
    for (size_t i = 0; i + 1 < 24; ++i) {
      Vector3d a = world.module_pose(i) * Vector3d(-0.0445, 0, 0),
               b = world.module_pose(i + 1) * Vector3d(0.0445, 0, 0);
      gap = std::max(gap, (a - b).norm());
    }
  }
  double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  double dur = ticks * T;
  Vector3d d = centre() - from;
  printf("speed %.4f drift %.3f track_rms %.5f torque_rms %.3f ripple_rms %.3f gap_mm %.3f rtf %.1f\n", d.x() / dur,
         d.y(), std::sqrt(e2 / n), std::sqrt(t2 / n), std::sqrt(r2 / m), gap * 1e3, dur / wall);
}
