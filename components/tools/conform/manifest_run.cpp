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

namespace {

/// The process of `component` in a manifest, hosting this component only. `is_checked`: it is restarted once, because
/// the check `restart` kills it.
std::string process_of(Configuration& root, const std::string& component, const std::string& why, bool is_checked) {
  for (Configuration& entry : root.list("processes")) {
    const auto components = entry.texts("components");
    if (std::find(components.begin(), components.end(), component) == components.end()) continue;
    std::string process = fmt::format("  - {{components: [{}], restarts: {}", component, is_checked ? 1 : 0);
    if (entry.has("program")) process += ", program: " + entry.one_line("program");
    if (entry.has("environment")) process += ", environment: " + entry.one_line("environment");
    Configuration configs = entry.section("config", false);
    if (configs.has(component)) process += fmt::format(", config: {{{}: {}}}", component, configs.one_line(component));
    return process + "}\n";
  }
  throw root.error(why, fmt::format("found no {}, accepted a component of processes", component));
}

std::string head_of(Configuration& root, const std::string& plant, bool real_time) {
  return fmt::format("plant: {}\nreal_time: {}\nrobot: {}\nscenario: {}\npatience_s: 30\n", plant, real_time,
                     root.one_line("robot"), root.one_line("scenario"));
}

}  // namespace

std::string plant_manifest(const fs::path& manifest, const fs::path& folder) {
  Configuration root = Configuration::load(manifest);
  const std::string plant = root.text("plant");
  std::string text = head_of(root, plant, true);
  if (root.has("beside")) text += "beside: " + root.one_line("beside") + "\n";
  return text + "processes:\n" + process_of(root, plant, "plant", true) + "  - {components: [input]}\n" +
         fmt::format(
             "  - {{components: [control], program: conform_control, restarts: 0, environment: "
             "['CONSTRICTOR_CONFORM={}', 'CONSTRICTOR_CONFORM_PLANT={}']}}\n",
             folder.string(), plant);
}

std::string part_manifest(const PartPlace& place, const fs::path& manifest, const fs::path& folder) {
  Configuration root = Configuration::load(manifest);
  StandBoard* const none = nullptr;  // only the names are needed
  std::string stands;
  for (const auto& factory : stand_factories(place, *none)) stands += (stands.empty() ? "" : ", ") + factory.name;
  const std::string surroundings = fmt::format(
      "  - {{components: [{}], program: conform_part, restarts: 0, environment: ['CONSTRICTOR_CONFORM={}', "
      "'CONSTRICTOR_CONFORM_PART={}']}}\n",
      stands, folder.string(), place.part);
  const std::string part = process_of(root, place.part, "processes", true);
  if (place.own_plant) return head_of(root, kStandPlant, false) + "processes:\n" + surroundings + part;
  const std::string plant = root.text("plant");
  std::string text = head_of(root, plant, root.flag("real_time", false));
  if (root.has("beside")) text += "beside: " + root.one_line("beside") + "\n";
  return text + "processes:\n" + process_of(root, plant, "plant", false) + part + "  - {components: [input]}\n" +
         surroundings;
}

bool run_manifest(const std::string& manifest, const fs::path& folder, const std::function<bool()>& interrupted,
                  const std::function<void(const std::string&)>& print) {
  std::ofstream(folder / "manifest.yaml") << manifest;
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
  bool told = false;
  auto end = Clock::time_point::max();
  while (!ended(pid)) {
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
