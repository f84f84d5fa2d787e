// conform_control: takes the place of `control` in a run and checks the plant. `constrictor conform plant --manifest`
// starts such a run; see launched_checks.hpp for the files.
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>

#include "client/request_client.hpp"
#include "client/run_control_client.hpp"
#include "conform/launched_checks.hpp"
#include "conform/member_port.hpp"
#include "conform/plant_conformance.hpp"
#include "cyclone/domain.hpp"
#include "runtime/component_main.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"

namespace {

using namespace constrictor;
using namespace constrictor::conform;

/// Stops and resets the run as an operator does. Made at the first use, when the run has begun.
class Operator {
 public:
  explicit Operator(std::uint32_t domain) : domain_(domain) {}
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
    RunControlClient(participant_.get(), domain_, std::chrono::seconds(10)).reset(1);
  }

 private:
  RequestClient& client() {
    if (client_) return *client_;
    participant_ = dds::create_participant(domain_, dds::Reach::kLoopback, "operator");
    RequestClientOptions options;
    options.source = unique_source("conform");
    options.level = msg::kAuthorityOperator;
    client_ = std::make_unique<RequestClient>(participant_.get(), domain_, options);
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
  dds::Entity participant_;
  std::unique_ptr<RequestClient> client_;
};

void check(TickExchange& exchange, const LaunchedChecks& launched, Report& report) {
  const RobotModel robot = load_robot(launched.robot);
  PlantProfile profile = load_parameters<PlantProfile>(launched.folder / "profile.yaml");
  profile.adapt_to(robot);
  Operator person(launched.domain);
  MemberPort port(exchange, {[&] { person.stop(); }, [&] { person.clear(); }, [&] { person.reset(); }});
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
