#include "cli/companions.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include "cli/launch_plan.hpp"
#include "cli/log/log_files.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
constexpr auto kCompanionGrace = 3s;

}  // namespace

Companions::Companions(const LaunchManifest& manifest, std::uint64_t seed, const std::filesystem::path& report_dir,
                       Print print)
    : report_dir_(report_dir), print_(std::move(print)) {
  const auto logs = report_dir / "logs";
  if (!manifest.beside.empty()) std::filesystem::create_directories(logs);
  for (const CompanionPlan& plan : manifest.beside) {
    std::vector<std::string> arguments = {(program_folder() / plan.program).string(),
                                          "--robot",
                                          manifest.robot_file.string(),
                                          "--scenario",
                                          manifest.scenario_file.string(),
                                          "--seed",
                                          std::to_string(seed),
                                          "--output",
                                          report_dir.string()};
    arguments.insert(arguments.end(), plan.arguments.begin(), plan.arguments.end());
    Companion companion{plan.program, logs / (plan.program + ".log"), nullptr};
    remove_log(companion.log);
    companion.process = std::make_unique<ChildProcess>(arguments, run_environment(), companion.log);
    companions_.push_back(std::move(companion));
  }
}

void Companions::poll() {
  for (Companion& companion : companions_) {
    if (companion.reported || !companion.process->poll()) continue;
    companion.reported = true;
    for (const auto& line : last_lines(companion.log, 0, 3)) print_(companion.program + ": " + line);
    print_(fmt::format("{}, which runs beside the run, {}; see {}", companion.program,
                       companion.process->poll()->describe(), companion.log.string()));
  }
}

void Companions::obey(const std::vector<FaultDirector::Command>& commands) {
  for (const auto& [device, line] : commands) {
    const auto pipe = report_dir_ / (device + ".commands");
    const std::string text = line + "\n";
    // A pipe without a reader belongs to a device that has ended: do not wait for it.
    const int file = ::open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0 || ::write(file, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
      print_(
          fmt::format("fault: '{}' was not sent to {}: {}: {}", line, device, pipe.string(), ::strerrordesc_np(errno)));
    if (file >= 0) ::close(file);
  }
}

Companions::~Companions() {
  const auto any_left = [&] {
    return std::any_of(companions_.begin(), companions_.end(), [](auto& one) { return !one.process->poll(); });
  };
  for (Companion& companion : companions_) {
    if (!companion.process->poll()) companion.process->signal(SIGTERM);
  }
  for (const auto end = std::chrono::steady_clock::now() + kCompanionGrace;
       any_left() && std::chrono::steady_clock::now() < end;)
    std::this_thread::sleep_for(10ms);
}

}  // namespace constrictor::cli
