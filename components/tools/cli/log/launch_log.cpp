#include "cli/log/launch_log.hpp"

#include <unistd.h>

#include <cstdlib>

#include "cli/log/log_files.hpp"
#include "constrictor/messages.hpp"
#include "cyclone/acknowledgements.hpp"
#include "cyclone/own_host.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

constexpr dds_duration_t kLastWait_ns = DDS_MSECS(200);  // for readers of the last lines

Log open_log(const std::filesystem::path& folder, bool continued) {
  std::filesystem::create_directories(folder);
  const auto file = folder / (std::string(LaunchLog::kName) + ".log");
  if (!continued) remove_log(file);
  return {LaunchLog::kName, file};
}

}  // namespace

LaunchLog::LaunchLog(ProgressDisplay& display, const std::filesystem::path& folder, std::int32_t participant,
                     std::uint64_t run_id, bool continued)
    : display_(display),
      participant_(participant),
      run_id_(run_id),
      log_(open_log(folder, continued)),
      publisher_(participant, log_, kName, 1) {
  log_.at(run_id_, 0, -1);
  const char* program = std::getenv(kLauncherVariable);
  log_.info("{}, IDL {:.12}, pid {} on {}", program ? program : "constrictor", msg::kIdlHash, ::getpid(), own_host());
}

LaunchLog::~LaunchLog() {
  // An observer that was killed must not delay the end of the launcher for longer.
  dds::wait_for_acknowledgements(participant_, kLastWait_ns);
}

void LaunchLog::say(const std::string& line) {
  display_.print(line);
  log_.info("{}", line);
}

void LaunchLog::warn(const std::string& line) {
  display_.print(line);
  log_.warning("{}", line);
}

void LaunchLog::at(const RunView& view) const {
  if (view.tick >= 0) log_.at(run_id_, view.run_state ? view.run_state->epoch : 1, view.tick);
}

}  // namespace constrictor::cli
