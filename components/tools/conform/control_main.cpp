// conform_control: takes the place of `control` in a run and checks the plant. `constrictor conform plant --manifest`
// starts such a run. CONSTRICTOR_CONFORM names the folder with profile.yaml, where lines.txt and result.json are
// written.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "client/request_client.hpp"
#include "client/run_control_client.hpp"
#include "component/data_path.hpp"
#include "conform/member_port.hpp"
#include "conform/plant_conformance.hpp"
#include "cyclone/domain.hpp"
#include "runtime/component_main.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"

namespace {

using namespace constrictor;
using namespace constrictor::conform;
namespace fs = std::filesystem;

/// The value of an option of the launcher's command line; empty: it is not there.
std::string value_of(int argc, char** argv, const std::string& option) {
  for (int i = 1; i + 1 < argc; ++i) {
    if (argv[i] == option) return argv[i + 1];
  }
  return {};
}

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

void check(TickExchange& exchange, const fs::path& folder, const fs::path& robot_file, std::uint32_t domain) {
  std::ofstream lines(folder / "lines.txt");
  Report report(plant_checks(), [&](const Check& one) { lines << text_of(one) << std::endl; });
  std::string gone;
  try {
    const RobotModel robot = load_robot(robot_file);
    PlantProfile profile = load_parameters<PlantProfile>(folder / "profile.yaml");
    profile.adapt_to(robot);
    Operator person(domain);
    MemberPort port(exchange, {[&] { person.stop(); }, [&] { person.clear(); }, [&] { person.reset(); }});
    PlantConformance(port, robot, profile, report).run();
  } catch (const std::exception& error) {
    gone = error.what();
  }
  lines << summary_of(report) << std::endl;
  if (!gone.empty()) lines << gone << std::endl;
  std::ofstream(folder / "result.new") << to_json(report).dump(2) << "\n";
  fs::rename(folder / "result.new", folder / "result.json");
  exchange.finish();
}

}  // namespace

int main(int argc, char** argv) {
  ensure_numeric_environment(argv);  // may start the program again, which needs all arguments
  if (argc > 1 && std::string(argv[1]) == "control") {
    --argc;  // the launcher passes the names of the components as the first argument
    ++argv;
  }
  const char* folder = std::getenv("CONSTRICTOR_CONFORM");
  if (!folder) {
    fmt::print(stderr,
               "conform_control: found no CONSTRICTOR_CONFORM; `constrictor conform plant --manifest` starts "
               "this program\n");
    return exit_status::kUsage;
  }
  const std::string robot = value_of(argc, argv, "--robot"), domain = value_of(argc, argv, "--domain");
  TickExchange exchange;
  std::thread checks;
  // The launcher asks each program first what it reads and writes, and whether its files are right.
  const bool only_asked = std::any_of(
      argv, argv + argc, [](const std::string& argument) { return argument == "--check" || argument == "--topics"; });
  const bool takes_part = !only_asked && !domain.empty();
  if (takes_part)
    checks = std::thread([&] {
      check(exchange, folder, robot.empty() ? data_path("components/lib/robot/mamba.yaml") : fs::path(robot),
            static_cast<std::uint32_t>(std::stoul(domain)));
    });
  const int status = component_main(argc, argv, make_conform_factory(exchange));
  exchange.end();
  if (checks.joinable()) checks.join();
  return status;
}
