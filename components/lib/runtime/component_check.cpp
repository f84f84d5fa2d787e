#include "runtime/component_check.hpp"

#include <deque>
#include <exception>
#include <set>

#include "component/data_path.hpp"

namespace constrictor {
namespace {

/// Ports without a run: inputs stay empty, and written messages are discarded.
class UnconnectedWiring : public Wiring {
 public:
  void request_end_of_run() override {}
  const InputSlot* input(const TopicInfo& topic, bool events) override {
    InputSlot& slot = inputs_.emplace_back();
    slot.topic = &topic;
    slot.events = events;
    return &slot;
  }
  const OutputSlot* output_slot(const TopicInfo& topic) override {
    return &outputs_.emplace_back(OutputSlot{&topic, [](const void*) {}});
  }

 private:
  std::deque<InputSlot> inputs_;  // a deque, because its elements keep the addresses that components store
  std::deque<OutputSlot> outputs_;
};

}  // namespace

std::vector<std::string> check_components(const HostOptions& options, const std::vector<ComponentFactory>& factories) {
  std::vector<std::string> errors;
  std::set<std::string> reported;
  for (const auto& factory : factories) {
    Setup setup = options.setup;
    setup.component = factory.name;
    setup.output_dir.clear();
    const auto chosen = options.config_files.find(factory.name);
    if (chosen != options.config_files.end()) setup.config_file = chosen->second;
    else if (!factory.default_config.empty()) setup.config_file = data_path(factory.default_config);
    try {
      UnconnectedWiring wiring;
      static_cast<void>(factory.create(wiring, setup));
    } catch (const std::exception& error) {
      if (reported.insert(error.what()).second) errors.push_back(factory.name + ": " + error.what());
    }
  }
  return errors;
}

}  // namespace constrictor
