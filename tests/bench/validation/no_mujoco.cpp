// Takes the place of mujoco_comparison.cpp where MuJoCo is not installed.
#include "bench/validation/checks.hpp"

namespace constrictor::validation {

Section check_mujoco() {
  return {"The same robot in MuJoCo",
          "Not compared: MuJoCo is not installed. Run `./scripts/setup.sh bench`, then this command again.",
          {},
          {},
          {}};
}

}  // namespace constrictor::validation
