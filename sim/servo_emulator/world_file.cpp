#include "sim/servo_emulator/world_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace constrictor::servo_emulator {
namespace {

nlohmann::json position(const Eigen::Isometry3d& pose) {
  return {pose.translation().x(), pose.translation().y(), pose.translation().z()};
}

}  // namespace

WorldFile::WorldFile(const std::filesystem::path& file, const World& world, double every_s)
    : file_(file, std::ios::trunc), every_s_(every_s) {
  const Scenario& scenario = world.scenario();
  nlohmann::json scene = {{"scenario", scenario.name}, {"seed", scenario.seed}, {"robot", world.robot().name}};
  for (const ScenarioZone& zone : scenario.zones)
    scene["zones"].push_back({{"colour", zone.colour},
                              {"position_m", {zone.position_m.x(), zone.position_m.y()}},
                              {"radius_m", zone.radius_m}});
  for (const ScenarioObject& object : scenario.objects) scene["objects"].push_back({{"colour", object.colour}});
  file_ << scene << std::endl;
  if (!file_) throw std::runtime_error(fmt::format("cannot write {}", file.string()));
}

void WorldFile::note(const World& world, std::int64_t left_out_ns) {
  constexpr double kRounding_s = 1e-6;
  if (world.time_s() < next_s_ - kRounding_s) return;
  next_s_ = world.time_s() + every_s_;
  nlohmann::json now = {{"time_s", world.time_s()},
                        {"left_out_s", static_cast<double>(left_out_ns) * 1e-9},
                        {"head_m", position(world.module_pose(0))},
                        {"tail_m", position(world.module_pose(world.module_count() - 1))}};
  for (std::size_t i = 0; i < world.joint_count(); ++i) {
    now["joints_rad"].push_back(world.joint_angle_rad(i));
    now["torques_nm"].push_back(world.joint_torque_nm(i));
  }
  for (std::size_t i = 0; i < world.object_count(); ++i) now["objects_m"].push_back(position(world.object_pose(i)));
  file_ << now << std::endl;  // a reader sees whole lines at once
}

}  // namespace constrictor::servo_emulator
