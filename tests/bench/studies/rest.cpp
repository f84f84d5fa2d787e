#include <cstdio>
#include <cstdlib>
#include <map>
#include "unit/world/world_fixture.hpp"
using namespace constrictor;
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
  }
  SolverSettings s;
  s.step_s = get("h", 0.004);
  s.iterations = (int)get("it", 50);
  s.over_relaxation = get("w", 1.7);
  s.contact_stiffness_n_m = get("kc", 20000);
  s.contact_damping_n_s_m = get("dc", 50);
  s.cfm = get("cfm", 1e-5);
  s.erp = get("erp", .2);
  s.one_ground_contact_a_joint = get("one", 0) > 0;
  World w(robot, Scenario{}, s);
  hold(w, 0, 6, 2.0);
  double rr[2] = {0, 0}, dd[2] = {0, 0};
  long n = 0;
  std::vector<double> q(23);
  for (int i = 0; i < 23; ++i) q[i] = w.joint_angle_rad(i);
  auto p0 = w.module_pose(12).translation();
  double mx = 0;
  for (int k = 0; k < 100; ++k) {
    hold(w, 0, 6, 0.02);
    for (int i = 0; i < 23; ++i) {
      double r = w.joint_rate_rad_s(i);
      rr[i % 2] += r * r;
      double d = w.joint_angle_rad(i) - q[i];
      dd[i % 2] += d * d;
      mx = std::max(mx, std::abs(d));
      q[i] = w.joint_angle_rad(i);
      ++n;
    }
  }
  printf("rate_rms yaw %.4f pitch %.4f  tick change rms yaw %.2e pitch %.2e max %.2e creep %.4f mm\n",
         std::sqrt(2 * rr[0] / n), std::sqrt(2 * rr[1] / n), std::sqrt(2 * dd[0] / n), std::sqrt(2 * dd[1] / n), mx,
         1e3 * (w.module_pose(12).translation() - p0).norm());
}
