// scratch: carrying gait over settings
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include "control/yaw_chain.hpp"
#include "unit/world/world_fixture.hpp"
using namespace constrictor;
using Eigen::Vector3d;
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
  s.reorder_seed = (unsigned)get("seed", 1);
  s.one_ground_contact_a_joint = get("one", 1) > 0;
  const double r = get("r", 0.085);
  Scenario sc;
  ScenarioObject ob;
  ob.size_m = {r, r, 0.15};
  ob.mass_kg = get("mass", 0.4);
  // bend 3 joints at 60 degrees; base between modules 10..16; object left of the body
  ob.position_m = {get("ox", -0.089 * 13 + 0.0), 0.035 + r + get("oy", 0.01)};
  sc.objects.push_back(ob);
  World world(robot, sc, s);
  YawChain chain(robot);
  WaveWeights ww{{0.0, 0.5, 0.8}, get("rigid", 1.047)};
  LinkArray shape{};
  Wave wave;
  wave.wavelength_m = get("wl", 1.07);
  wave.field = 1;
  const double T = 0.02;
  double t = 0;
  const double f = get("f", 1.1), A = get("A", 0.6);
  const double bend = get("bend", 1.047);
  const double t_bend = get("tb", 10), t_sq = t_bend + get("tsq", 10), t0 = t_sq + 6, t1 = t0 + get("dur", 20);
  double squeeze = 0;
  double hold[3] = {0, 0, 0};
  Vector3d from;
  double yaw0 = 0;
  double tq2 = 0, base_t = 0, fo = 0;
  long n = 0, nb = 0;
  std::vector<double> prev(23, 0), prev2(23, 0);
  double peak = 0;
  double path = 0;
  Vector3d last;
  double gap = 0, spread = 0;
  auto begin = std::chrono::steady_clock::now();
  auto centre = [&] {
    Vector3d q = Vector3d::Zero();
    for (size_t i = 0; i < 24; ++i) q += world.module_pose(i).translation();
    return Vector3d(q / 24);
  };
  int ncarry = 0;
  while (t < t1) {
    t += T;
    double q3;
    std::vector<double> q(23, 0.0), lim(23, 6.0);
    double a = 0;
    if (t < t_bend) {
      q3 = bend * std::min(1.0, t / (t_bend - 1));
      for (int k = 5; k < 8; ++k) shape[k] = q3;
    } else if (t < t_sq) {  // squeeze at 0.1 rad/s total until base torque>3 or .9
      double mt = std::max({std::abs(world.joint_torque_nm(10)), std::abs(world.joint_torque_nm(12)),
                            std::abs(world.joint_torque_nm(14))});
      if (t > t_sq - 2) peak = std::max(peak, mt);
      a = 0.35;
      if (t > t_bend + 2 && squeeze < get("sq", 0.35)) {
        squeeze += 0.1 * T;
      }
      for (int k = 5; k < 8; ++k) shape[k] = bend + squeeze / 3;
      shape[4] = shape[8] = -squeeze * 0.25;
      for (int k : {10, 12, 14}) lim[k] = 2.5;
      for (int k = 0; k < 3; ++k) hold[k] = shape[5 + k];
    } else {
      for (int k = 0; k < 3; ++k) shape[5 + k] = hold[k];
      for (int k : {10, 12, 14}) lim[k] = 1.5;
      a = 0.35 + (A - 0.35) * std::min(1.0, (t - t_sq) / 1.0);
    }
    wave.amplitude_rad = a;
    static double ph = 0;
    ph += 2 * std::numbers::pi * (t < t_sq ? 0.4 : f) * T;
    wave.phase_rad = ph;
    auto ang = chain.joint_angles(shape, wave, ww);
    for (size_t k = 0; k < chain.joint_count(); ++k) q[chain.joint_index(k)] = ang[k];
    std::vector<double> w(23);
    for (int i = 0; i < 23; ++i) {
      w[i] = t < 2 * T ? 0.0 : (1.5 * (q[i] - prev[i]) - 0.5 * (prev[i] - prev2[i])) / T;
      if (o.count("mean")) w[i] = (q[i] - prev[i]) / T;
    }
    prev2 = prev;
    prev = q;
    world.set_servo(q, w, lim);
    world.advance(T);
    if (t >= t0 && n == 0) {
      from = centre();
      last = from;
    }
    if (t >= t0) {
      for (int i = 0; i < 23; i += 2) {
        double x = world.joint_torque_nm(i);
        tq2 += x * x;
        ++n;
      }
      for (int k : {10, 12, 14}) {
        base_t += world.joint_torque_nm(k);
        ++nb;
      }
      double F = 0;
      for (auto& x : world.contacts())
        if (x.touched == Touched::kObject) F += x.force_n.norm();
      fo += F;
      ++ncarry;
      Vector3d p = centre();
      if (ncarry % 50 == 0) {
        path += (p - last).norm();
        last = p;
      }
      for (size_t i = 0; i + 1 < 24; ++i) {
        Vector3d aa = world.module_pose(i) * Vector3d(-0.0445, 0, 0),
                 b = world.module_pose(i + 1) * Vector3d(0.0445, 0, 0);
        gap = std::max(gap, (aa - b).norm());
      }
    }
  }
  double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  Vector3d d = centre() - from;
  Vector3d rel = world.object_pose(0).translation() - world.module_pose(12).translation();
  printf(
      "carry %.4f m/s (path %.4f) torque_rms %.3f base %.3f objforce %.2f sqpeak %.2f squeeze %.3f object_rel %.3f gap "
      "%.3f rtf %.1f\n",
      d.norm() / (t1 - t0), path / (t1 - t0), std::sqrt(tq2 / n), base_t / nb, fo / ncarry, peak, squeeze,
      rel.head<2>().norm(), gap * 1e3, t1 / wall);
}
