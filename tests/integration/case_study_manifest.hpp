// Manifests of runs for tests.
#pragma once

#include <string>

namespace constrictor::testing {

/// A manifest with the case study's robot and scenario. `processes`: its rows.
inline std::string case_study_manifest(int patience_s, const std::string& processes) {
  return "plant: physics\nrobot: components/lib/robot/mamba.yaml\nscenario: "
         "sim/scenarios/case_study.yaml\npatience_s: " +
         std::to_string(patience_s) + "\nprocesses:\n" + processes;
}

/// Processes without camera and perception, for tests that need neither: such a run is faster.
inline constexpr const char* kBlindProcesses =
    "  - {components: [physics, guidance, navigation, control]}\n  - {components: [input]}\n";

}  // namespace constrictor::testing
