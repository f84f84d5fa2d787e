#include "sim/physics/physics.hpp"

#include <algorithm>
#include <cereal/types/string.hpp>
#include <iterator>
#include <span>
#include <string>

#include "component/data_path.hpp"
#include "component/default_robot.hpp"
#include "constrictor/archive.hpp"
#include "sim/physics/scene_description.hpp"
#include "sim/scenario_loader/layout_check.hpp"
#include "sim/scenario_loader/scenario_file.hpp"

namespace constrictor {
namespace {

Scenario scene_of(const Setup& setup, const RobotModel& robot) {
  const std::filesystem::path file = setup.scenario_file.empty() ? default_scenario_file() : setup.scenario_file;
  return load_scenario(file, setup.seed, static_cast<double>(robot.module_count) * robot.module_length_m,
                       robot.module_radius_m);
}

}  // namespace

Physics::Physics(Wiring& wiring, const Setup& setup)
    : Physics(wiring, setup, load_parameters<PhysicsConfig>(setup.config_file), load_robot(robot_file_of(setup))) {}

Physics::Physics(Wiring& wiring, const Setup& setup, const PhysicsConfig& config, const RobotModel& robot)
    : Physics(wiring, setup, config, robot, scene_of(setup, robot)) {}

Physics::Physics(Wiring& wiring, const Setup& setup, const PhysicsConfig& config, const RobotModel& robot,
                 const Scenario& scenario)
    : wiring_(wiring),
      config_(config),
      world_(robot, scenario, config.solver),
      sensors_(robot, setup.component_seed(), scenario.sensor_noise),
      perturbations_(scenario),
      gate_(wiring, robot, config.command, config.stop_ticks()),
      angles_rad_(robot.joints.size()),
      rates_rad_s_(robot.joints.size()) {}

void Physics::sample(const Tick& tick) {
  gate_.sample(tick);
  if (!scene_written_) {
    scene_.write(scene_description(world_.scenario(), world_.robot()));
    scene_written_ = true;
  }
  joint_state_.write(sensors_.joints(world_));
  msg::ContactState felt{};
  msg::TouchedState touched{};
  sensors_.contacts(world_, felt, touched);
  contact_state_.write(felt);
  touched_state_.write(touched);
  if (world_.robot().imu) imu_state_.write(sensors_.imu(world_, config_.period_s()));
  world_state_.write(constrictor::world_state(world_));
}

void Physics::obey(const Tick& tick) {
  for (std::size_t i = 0; i < angles_rad_.size(); ++i) {
    angles_rad_[i] = world_.joint_angle_rad(i);
    rates_rad_s_[i] = world_.joint_rate_rad_s(i);
  }
  world_.set_servo(gate_.setpoints(tick, {angles_rad_, rates_rad_s_}));
}

void Physics::step(const Tick& tick) {
  obey(tick);
  perturbations_.apply(world_, tick.time_s());
  world_.advance(config_.period_s());
}

std::vector<DemandedObject> Physics::demanded_objects(const std::vector<std::uint8_t>& colours) const {
  std::vector<DemandedObject> demanded;
  const Scenario& scene = world_.scenario();
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const ScenarioObject& object = scene.objects[i];
    if (std::find(colours.begin(), colours.end(), object.colour) == colours.end()) continue;
    DemandedObject& one = demanded.emplace_back();
    one.key = "objects[" + std::to_string(i) + "]";
    one.box = object.shape == BodyShape::kBox;
    const Eigen::Vector2d sides_m = (one.box ? 1.0 : 2.0) * object.size_m.head<2>();
    one.width_m = sides_m.minCoeff();
    one.length_m = sides_m.maxCoeff();
    one.height_m = object.size_m.z();
    for (std::size_t z = 0; z < scene.zones.size(); ++z) {
      if (scene.zones[z].colour != object.colour || scene.zones[z].radius_m <= one.zone_radius_m) continue;
      one.zone_key = "zones[" + std::to_string(z) + "]";
      one.zone_radius_m = scene.zones[z].radius_m;
    }
  }
  return demanded;
}

CheckVerdict Physics::judge_scene() const {
  CheckVerdict verdict{{}, find_obstacles_on_line(world_.scenario(), world_.robot().module_radius_m)};
  std::ranges::move(find_turns_back(world_.scenario()), std::back_inserter(verdict.warnings));
  return verdict;
}

std::string Physics::save() const { return save_bytes(world_.save(), sensors_, perturbations_, gate_, scene_written_); }

void Physics::load(const std::string& bytes) {
  std::string world;
  load_bytes(bytes, world, sensors_, perturbations_, gate_, scene_written_);
  world_.load(world);
}

ComponentFactory make_physics_factory() {
  return make_factory<Physics, PhysicsConfig>("physics", "sim/physics/physics.yaml");
}

}  // namespace constrictor
