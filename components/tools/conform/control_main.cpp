// conform_control: takes the place of `control` in a run and checks the plant. `constrictor conform plant --manifest`
// starts such a run; see launched_checks.hpp for the files.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "client/request_client.hpp"
#include "client/run_control_client.hpp"
#include "conform/launched_checks.hpp"
#include "conform/member_port.hpp"
#include "conform/member_process.hpp"
#include "conform/plant_conformance.hpp"
#include "cyclone/domain.hpp"
#include "runtime/component_main.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"

namespace {

using namespace constrictor;
using namespace constrictor::conform;

/// Stops and resets the run as an operator does, and kills the plant's process. It joins the domain at the first use,
/// when the run has begun.
class Operator {
 public:
  Operator(std::uint32_t domain, std::string plant) : domain_(domain), plant_(std::move(plant)) {}
  void stop() {
    client().ask(msg::kRequestEmergencyStop);
    settle();
  }
  void clear() {
    client().ask(msg::kRequestClearStop);
    settle();
  }
  void reset() {
    client();
    RunControlClient(participant(), domain_, std::chrono::seconds(10)).reset(1);
  }
  /// At the first use, waits for the plant's next status.
  std::uint32_t incarnation() {
    constexpr int kMost = 300;  // times 10 ms
    for (int i = 0; i < kMost; ++i) {
      process().look();
      if (process().incarnation() != 0) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return process().incarnation();
  }
  std::string kill_plant() {
    // A process that the launcher has started again without being asked for has crashed.
    if (const std::uint32_t now = incarnation(); now > 1)
      throw PlantGone(fmt::format("the plant's process has ended by itself, and is now incarnation {}", now));
    return process().kill();
  }

 private:
  dds_entity_t participant() {
    if (!participant_) participant_ = dds::create_participant(domain_, dds::Reach::kLoopback, "operator");
    return participant_.get();
  }
  MemberProcess& process() {
    if (!process_) process_ = std::make_unique<MemberProcess>(participant(), plant_);
    return *process_;
  }
  RequestClient& client() {
    if (client_) return *client_;
    RequestClientOptions options;
    options.source = unique_source("conform");
    options.level = msg::kAuthorityOperator;
    client_ = std::make_unique<RequestClient>(participant(), domain_, options);
    client_->connect_or_throw();
    return *client_;
  }
  void settle() {
    for (int i = 0; i < 30; ++i) {
      client_->poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  std::uint32_t domain_;
  std::string plant_;
  dds::Entity participant_;
  std::unique_ptr<MemberProcess> process_;
  std::unique_ptr<RequestClient> client_;
};

void check(TickExchange& exchange, const LaunchedChecks& launched, Report& report) {
  const RobotModel robot = load_robot(launched.robot);
  PlantProfile profile = load_parameters<PlantProfile>(launched.folder / "profile.yaml");
  profile.adapt_to(robot);
  const char* plant = std::getenv("CONSTRICTOR_CONFORM_PLANT");
  Operator person(launched.domain, plant ? plant : "");
  MemberPort port(exchange, {[&] { person.stop(); }, [&] { person.clear(); }, [&] { person.reset(); },
                             [&] { return person.kill_plant(); }, [&] { return person.incarnation(); }});
  PlantConformance(port, robot, profile, report).run();
}

}  // namespace

int main(int argc, char** argv) {
  ensure_numeric_environment(argv);  // may start the program again, which needs all arguments
  try {
    const LaunchedChecks launched = launched_checks(argc, argv);
    TickExchange exchange;
    std::thread checks;
    if (launched.takes_part)
      checks = start_checks(
          launched.folder, plant_checks(), [&](Report& report) { check(exchange, launched, report); },
          [&] { exchange.finish(); });
    const int status = component_main(launched.argc, launched.argv, make_conform_factory(exchange));
    exchange.end();
    if (checks.joinable()) checks.join();
    return status;
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "conform_control: {}\n", error.what());
    return exit_status::kUsage;
  }
}
