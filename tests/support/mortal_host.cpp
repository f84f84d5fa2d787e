// mortal_host NAME [OPTION...] hosts the component NAME as constrictor_host does, and kills its own process (SIGKILL)
// once at each tick of $CONSTRICTOR_DEATHS (comma-separated), between the component's first output and its TickDone. A
// component that writes nothing in this step dies at the end of the step. A component without a step at this tick dies
// in its next step. Before each death the process writes the file NAME-TICK into $CONSTRICTOR_DEATHS_DIR, so that the
// next incarnation does not die at the same tick again.
#include <unistd.h>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <list>
#include <set>
#include <sstream>
#include <stdexcept>

#include "host/known_components.hpp"
#include "runtime/component_main.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"

namespace {

using namespace constrictor;

/// The ticks at which one component still has to die.
class Fate {
 public:
  explicit Fate(std::string name) : name_(std::move(name)) {
    const char* ticks = std::getenv("CONSTRICTOR_DEATHS");
    const char* dir = std::getenv("CONSTRICTOR_DEATHS_DIR");
    if (!ticks || !dir) throw std::runtime_error("mortal_host needs CONSTRICTOR_DEATHS and CONSTRICTOR_DEATHS_DIR");
    dir_ = dir;
    std::istringstream list(ticks);
    for (std::string tick; std::getline(list, tick, ',');) {
      if (!std::filesystem::exists(mark(std::stoll(tick)))) ticks_.insert(std::stoll(tick));
    }
  }
  void at_tick(std::int64_t tick) { now_ = tick; }
  /// Kills the process if the component has to die at this tick.
  void meet() {
    const auto due = ticks_.begin();
    if (due == ticks_.end() || *due > now_) return;
    std::ofstream(mark(*due)) << now_ << '\n';
    ::kill(::getpid(), SIGKILL);
  }

 private:
  [[nodiscard]] std::filesystem::path mark(std::int64_t tick) const {
    return dir_ / (name_ + "-" + std::to_string(tick));
  }
  std::string name_;
  std::filesystem::path dir_;
  std::set<std::int64_t> ticks_;
  std::int64_t now_ = -1;
};

/// Passes everything through to the real wiring. After each output the process may die.
class MortalWiring : public Wiring {
 public:
  MortalWiring(Wiring& inner, Fate& fate) : inner_(inner), fate_(fate) {}
  std::shared_ptr<ClientRequests> client_requests() override { return inner_.client_requests(); }
  void count_refusal(const std::string& reason) override { inner_.count_refusal(reason); }
  void request_end_of_run() override { inner_.request_end_of_run(); }
  const InputSlot* input(const TopicInfo& topic, bool events) override { return inner_.input(topic, events); }
  const OutputSlot* output_slot(const TopicInfo& topic) override {
    const OutputSlot* slot = inner_.output_slot(topic);
    OutputSlot& mortal = outputs_.emplace_back();
    mortal.topic = slot->topic;
    mortal.write = [this, slot](const void* message) {
      slot->write(message);
      fate_.meet();
    };
    return &mortal;
  }

 private:
  Wiring& inner_;
  Fate& fate_;
  std::list<OutputSlot> outputs_;
};

class Mortal : public Component {
 public:
  Mortal(const ComponentFactory& factory, Wiring& wiring, const Setup& setup)
      : fate_(factory.name), wiring_(wiring, fate_), component_(factory.create(wiring_, setup)) {}
  [[nodiscard]] Timing timing() const override { return component_->timing(); }
  void step(const Tick& tick) override {
    fate_.at_tick(tick.index);
    component_->step(tick);
    fate_.meet();
  }
  [[nodiscard]] std::string save() const override { return component_->save(); }
  void load(const std::string& bytes) override { component_->load(bytes); }

 private:
  Fate fate_;
  MortalWiring wiring_;
  std::unique_ptr<Component> component_;
};

}  // namespace

int main(int argc, char** argv) {
  ensure_numeric_environment(argv);  // may start the program again, which needs all arguments
  const auto known = argc > 1 ? known_components().find(argv[1]) : known_components().end();
  if (known == known_components().end()) {
    std::fprintf(stderr, "usage: mortal_host NAME [OPTION...]; NAME is a component of constrictor_host\n");
    return exit_status::kUsage;
  }
  const ComponentFactory factory = known->second();
  return component_main(argc - 1, argv + 1,
                        {factory.name,
                         [factory](Wiring& wiring, const Setup& setup) -> std::unique_ptr<Component> {
                           return std::make_unique<Mortal>(factory, wiring, setup);
                         },
                         factory.default_config});
}
