// bench_members NAME OPTIONS: a process that hosts the toy plant `physics` or a member, which reads the joints in each
// tick and writes nothing. `member_1` prints the number of each hundredth tick. measure.py starts these processes.
#include <cstdio>
#include <string>

#include "runtime/component_main.hpp"
#include "runtime/numeric_profile.hpp"
#include "unit/runtime/toy_components.hpp"

namespace {

using namespace constrictor;

class Reader : public StatefulComponent<testing::toys::Mixer> {
 public:
  Reader(Wiring& wiring, const Setup& setup)
      : joints_(wiring.latest(topics::kJointState)), prints_(setup.component == "member_1") {}
  [[nodiscard]] bool has_short_steps() const override { return true; }
  void step(const Tick& tick) override {
    state_.mix(joints_->position_rad[0]);
    if (!prints_ || tick.index % 100 != 0) return;
    std::printf("tick %lld\n", static_cast<long long>(tick.index));
    std::fflush(stdout);
  }

 private:
  Latest<msg::JointState> joints_;
  bool prints_;
};

}  // namespace

int main(int argc, char** argv) {
  ensure_numeric_environment(argv);
  const std::string name = argc > 1 ? argv[1] : "";
  if (name == "physics") return host_main(argc - 1, argv + 1, {testing::toys::plant()});
  if (name.starts_with("member_")) {
    const ComponentFactory reader{
        name, [](Wiring& wiring, const Setup& setup) { return std::make_unique<Reader>(wiring, setup); }};
    return host_main(argc - 1, argv + 1, {reader});
  }
  std::fprintf(stderr, "bench_members: found the name '%s', accepted physics, member_1, member_2 and so on\n",
               name.c_str());
  return 64;
}
