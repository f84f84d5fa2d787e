// conform_part: takes the places of all members around a part and checks the part. `constrictor conform PART
// --manifest` starts such a run. CONSTRICTOR_CONFORM_PART is the part; see launched_checks.hpp for the files.
#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

#include "conform/exchange_port.hpp"
#include "conform/launched_checks.hpp"
#include "conform/parts.hpp"
#include "runtime/component_main.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"

using namespace constrictor;
using namespace constrictor::conform;

int main(int argc, char** argv) {
  ensure_numeric_environment(argv);  // may start the program again, which needs all arguments
  const char* part = std::getenv("CONSTRICTOR_CONFORM_PART");
  try {
    const LaunchedChecks launched = launched_checks(argc, argv);
    if (!part) throw std::invalid_argument("found no environment variable CONSTRICTOR_CONFORM_PART");
    const PartKind& kind = part_kind(part);
    ExchangePort port(part, launched.domain, std::getenv("CONSTRICTOR_CONFORM_SERVED") != nullptr);
    std::thread checks;
    if (launched.takes_part)
      checks = start_checks(
          launched.folder, kind.checks(),
          [&](Report& report) {
            kind.run(port, {load_robot(launched.robot), launched.folder / "profile.yaml", launched.mission}, report);
          },
          [&] { port.finish(); });
    const int status = host_main(launched.argc, launched.argv, stand_factories(part_place(part), port));
    port.end();
    if (checks.joinable()) checks.join();
    return status;
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "conform_part: {}\n", error.what());
    return exit_status::kUsage;
  } catch (const std::exception& error) {
    fmt::print(stderr, "conform_part: {}\n", error.what());
    return exit_status::kSoftware;
  }
}
