#include "conform/manifest_run.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "configuration/configuration.hpp"

namespace constrictor::conform {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPoll{50};
constexpr std::chrono::seconds kEndBound{60};

/// `constrictor`, beside this program.
fs::path command() {
  const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
  return here / "constrictor";
}

/// Starts `constrictor run` with its output in `log`, in a process group of its own: Ctrl-C goes to this process only.
pid_t start(const fs::path& manifest, const fs::path& folder) {
  const std::string program = command().string(), report = (folder / "run").string();
  std::vector<std::string> words = {program, "run", "--manifest", manifest.string(), "--report", report};
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  const std::string log = (folder / "log").string();
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  ::posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  pid_t pid = -1;
  const int error = ::posix_spawn(&pid, program.c_str(), &files, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::runtime_error(fmt::format("{}: {}", program, ::strerrordesc_np(error)));
  return pid;
}

bool ended(pid_t pid) { return ::waitpid(pid, nullptr, WNOHANG) == pid; }

}  // namespace

std::string conform_manifest(const fs::path& manifest, const fs::path& folder) {
  Configuration root = Configuration::load(manifest);
  const std::string plant = root.text("plant");
  std::string process;
  for (Configuration& entry : root.list("processes")) {
    const auto components = entry.texts("components");
    if (std::find(components.begin(), components.end(), plant) == components.end()) continue;
    process = fmt::format("  - {{components: [{}], restarts: 0", plant);
    if (entry.has("program")) process += ", program: " + entry.one_line("program");
    if (entry.has("environment")) process += ", environment: " + entry.one_line("environment");
    Configuration configs = entry.section("config", false);
    if (configs.has(plant)) process += fmt::format(", config: {{{}: {}}}", plant, configs.one_line(plant));
    process += "}\n";
  }
  if (process.empty()) throw root.error("plant", "found " + plant + ", accepted a component of processes");
  std::string text = fmt::format("plant: {}\nreal_time: true\nrobot: {}\nscenario: {}\npatience_s: 30\n", plant,
                                 root.one_line("robot"), root.one_line("scenario"));
  if (root.has("beside")) text += "beside: " + root.one_line("beside") + "\n";
  return text + "processes:\n" + process + "  - {components: [input]}\n" +
         fmt::format(
             "  - {{components: [control], program: conform_control, restarts: 0, environment: "
             "['CONSTRICTOR_CONFORM={}']}}\n",
             folder.string());
}

bool run_manifest(const fs::path& manifest, const fs::path& folder, const std::function<bool()>& interrupted,
                  const std::function<void(const std::string&)>& print) {
  std::ofstream(folder / "manifest.yaml") << conform_manifest(manifest, folder);
  const pid_t pid = start(folder / "manifest.yaml", folder);
  std::streamoff read = 0;
  const auto print_new = [&] {
    std::ifstream lines(folder / "lines.txt");
    lines.seekg(read);
    for (std::string line; std::getline(lines, line) && !lines.eof();) {
      print(line);
      read = lines.tellg();
    }
  };
  bool told = false, gone = false;
  auto end = Clock::time_point::max();
  while (!(gone = ended(pid))) {
    print_new();
    const bool done = fs::exists(folder / "result.json");
    if ((interrupted() || done) && !told) {
      told = true;
      end = Clock::now() + kEndBound;
      ::kill(pid, SIGTERM);  // the launcher ends the run in order
    }
    if (Clock::now() > end) {
      ::kill(pid, SIGKILL);
      ::waitpid(pid, nullptr, 0);
      break;
    }
    std::this_thread::sleep_for(kPoll);
  }
  print_new();
  return fs::exists(folder / "result.json");
}

}  // namespace constrictor::conform
