// toy_host NAME[,NAME...] OPTIONS: a process that hosts toy components, for tests of the runtime over DDS.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "../unit/runtime/toy_components.hpp"
#include "runtime/component_main.hpp"
#include "runtime/component_replay.hpp"
#include "runtime/numeric_profile.hpp"

namespace {

using namespace constrictor;

/// Ends the run after a number of ticks, as the component `report` does. The file name of the scenario begins with this
/// number. The toy prints the last angle of the plant's joint and a hash of all angles; if it has an output directory,
/// it also writes mission.json. It logs as many lines in each step as the environment variable TOY_LINES says.
class ToyReport : public StatefulComponent<testing::toys::Mixer> {
 public:
  ToyReport(Wiring& wiring, const Setup& setup)
      : wiring_(wiring),
        joints_(wiring.latest(topics::kJointState)),
        // 0 if the name is not a number: `--topics` and `--check` build the toy with any scenario
        ticks_(std::strtol(setup.scenario_file.filename().c_str(), nullptr, 10)),
        output_dir_(setup.output_dir),
        log_(setup.log) {
    if (const char* lines = std::getenv("TOY_LINES")) lines_ = std::atoi(lines);
  }
  void step(const Tick& tick) override {
    for (int line = 0; line < lines_; ++line) log_.info("line {} of tick {}", line, tick.index);
    state_.mix(joints_->position_rad[0]);
    if (tick.index + 1 < ticks_) return;
    std::printf("result %.17g %016llx\n", joints_->position_rad[0], static_cast<unsigned long long>(state_.value));
    std::fflush(stdout);
    if (!output_dir_.empty()) {
      std::ofstream(output_dir_ / "mission.json") << "{\"success\": true, \"ticks\": " << tick.index + 1
                                                  << ", \"state_hash\": \"" << std::hex << state_.value << "\"}\n";
    }
    wiring_.request_end_of_run();
  }

 private:
  Wiring& wiring_;
  Latest<msg::JointState> joints_;
  long ticks_;
  std::filesystem::path output_dir_;
  Log log_;
  int lines_ = 0;
};

/// Steps once per second of simulated time, as the real `overview` does, and writes nothing.
class ToyOverview : public StatefulComponent<testing::toys::Mixer> {
 public:
  ToyOverview(Wiring& wiring, const Setup&) : joints_(wiring.latest(topics::kJointState)) {}
  [[nodiscard]] Timing timing() const override { return {50, 1}; }
  void step(const Tick&) override { state_.mix(joints_->position_rad[0]); }

 private:
  Latest<msg::JointState> joints_;
};

/// Publishes that an operator takes authority at tick 10 and latches an emergency stop at tick 20.
class ToyInput : public StatefulComponent<testing::toys::Mixer> {
 public:
  ToyInput(Wiring& wiring, const Setup&) : authority_(wiring.output(topics::kAuthority)) {}
  void step(const Tick& tick) override {
    if (tick.index != 10 && tick.index != 20) return;
    msg::Authority authority{};
    authority.level = tick.index == 10 ? msg::kAuthorityOperator : msg::kAuthorityEmergencyStop;
    authority_.write(authority);
  }

 private:
  Output<msg::Authority> authority_;
};

template <class Toy>
ComponentFactory made(const std::string& name) {
  return {name, [](Wiring& w, const Setup& s) -> std::unique_ptr<Component> { return std::make_unique<Toy>(w, s); }};
}

ComponentFactory factory(const std::string& name) {
  if (name == "physics") return testing::toys::plant();
  if (name == "navigation") return testing::toys::navigation({2, 2});
  if (name == "control") return testing::toys::control();
  if (name == "planner") return testing::toys::planner();
  if (name == "overview") return made<ToyOverview>(name);
  if (name == "input") return made<ToyInput>(name);
  return made<ToyReport>("report");
}

}  // namespace

int main(int argc, char** argv) {
  ensure_numeric_environment(argv);  // may start the program again, which needs all arguments
  if (argc > 3 && std::string(argv[1]) == "--replay")
    return replay_main({argv + 2, argv + argc}, [](const std::string& name) { return factory(name); });
  std::vector<ComponentFactory> factories;
  std::istringstream names(argc > 1 ? argv[1] : "");
  for (std::string name; std::getline(names, name, ',');) factories.push_back(factory(name));
  if (factories.empty()) return 64;
  return host_main(argc - 1, argv + 1, std::move(factories));
}
