// Runs of the plant in one process, for its tests.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "barrier/local_run.hpp"
#include "sim/physics/physics.hpp"
#include "support/commander.hpp"
#include "support/project.hpp"

namespace constrictor::testing {

inline constrictor::Setup setup_of(const std::filesystem::path& scenario_file, std::uint64_t seed = 1,
                                   const std::string& robot = "mamba") {
  constrictor::Setup setup;
  setup.robot_file = robot_path(robot);
  setup.scenario_file = scenario_file;
  setup.seed = seed;
  return setup;
}

/// The plant, and the commands of a test in the place of the component `control`.
inline std::unique_ptr<LocalRun> make_run(CommandAt command_at, const constrictor::Setup& setup) {
  return std::make_unique<LocalRun>(
      std::vector<ComponentFactory>{make_physics_factory(), commander(std::move(command_at))}, setup);
}

/// The hash of the state of the world at the present tick.
inline std::string hash_of(LocalRun& run) {
  const auto& hash = run.latest(topics::kWorldState)->state_hash;
  return {reinterpret_cast<const char*>(hash), sizeof(hash)};
}

}  // namespace constrictor::testing
