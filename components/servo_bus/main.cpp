#include "log/log.hpp"
#include "plant/real_time.hpp"
#include "runtime/component_main.hpp"
#include "runtime/numeric_profile.hpp"
#include "servo_bus/servo_bus.hpp"

namespace {

constexpr int kPriority = 5;  // above all usual processes, below emulated servos and interrupts

}  // namespace

int main(int argc, char** argv) {
  constrictor::ensure_numeric_environment(argv);  // may start the program again
  // Servos stop when their bus is silent, and a busy computer may keep a usual process waiting for longer than they do.
  if (const std::string refusal = constrictor::prefer_this_process(kPriority); !refusal.empty())
    constrictor::Log("servo_bus").warning("on a busy computer the servos may stop: {}", refusal);
  return constrictor::component_main(argc, argv, constrictor::make_servo_bus_factory());
}
