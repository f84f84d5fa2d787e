// Configuration of the simulated plant (physics.yaml).
#pragma once

#include <cstdint>
#include <filesystem>

#include "robot/safety_gate.hpp"
#include "sim/world/solver_settings.hpp"

namespace constrictor {

struct PhysicsConfig {
  std::int64_t period_ns = 20'000'000;
  SolverSettings solver;
  GateLimits command;

  [[nodiscard]] double period_s() const { return static_cast<double>(period_ns) * 1e-9; }
};

/// Throws ConfigurationError.
[[nodiscard]] PhysicsConfig load_physics_config(const std::filesystem::path& file);

}  // namespace constrictor
