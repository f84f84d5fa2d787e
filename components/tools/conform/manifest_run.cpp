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

/// Starts a program beside this one with its output in `log`, in a process group of its own: Ctrl-C goes to this
/// process only. `variables`: added to the environment.
pid_t start(const std::string& name, std::vector<std::string> words, std::vector<std::string> variables,
            const fs::path& folder) {
  const std::string program = (fs::read_symlink("/proc/self/exe").parent_path() / name).string();
  words.insert(words.begin(), program);
  std::vector<char*> arguments, environment;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  for (auto& variable : variables) environment.push_back(variable.data());  // before others of the same name
  for (char** variable = environ; *variable != nullptr; ++variable) environment.push_back(*variable);
  environment.push_back(nullptr);
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
  const int error = ::posix_spawn(&pid, program.c_str(), &files, &attributes, arguments.data(), environment.data());
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::runtime_error(fmt::format("{}: {}", program, ::strerrordesc_np(error)));
  return pid;
}

/// `failed`: set when the process has ended with another status than 0.
bool ended(pid_t pid, bool& failed) {
  int status = 0;
  if (::waitpid(pid, &status, WNOHANG) != pid) return false;
  failed = status != 0;
  return true;
}

/// The log of a process says why it has failed: prints its warnings and errors, at most the last ones.
void print_log(const fs::path& log, const std::function<void(const std::string&)>& print) {
  constexpr std::size_t kMost = 5;
  std::vector<std::string> found;
  std::ifstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(" info ") == std::string::npos) found.push_back(line);
  }
  for (std::size_t i = found.size() > kMost ? found.size() - kMost : 0; i < found.size(); ++i) print(found[i]);
}

}  // namespace

namespace {

/// Returns the manifest entry (YAML) of the process that hosts `component` in the manifest `root`, changed so that it
/// hosts this component only. `is_checked`: it is restarted once, because the check `restart` kills it. `why`: the key
/// that the error names if no process has the component.
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

namespace {

/// Prints the lines of the results until the process has ended. `ends_by_itself`: when the checks have ended; else it
/// is then asked to end. Returns false if there is no result.
bool follow(pid_t pid, const fs::path& folder, bool ends_by_itself, const std::function<bool()>& interrupted,
            const std::function<void(const std::string&)>& print) {
  std::streamoff read = 0;
  const auto print_new = [&] {
    std::ifstream lines(folder / "lines.txt");
    lines.seekg(read);
    for (std::string line; std::getline(lines, line) && !lines.eof();) {
      print(line);
      read = lines.tellg();
    }
  };
  bool told = false, failed = false;
  auto end = Clock::time_point::max();
  while (!ended(pid, failed)) {
    print_new();
    const bool done = fs::exists(folder / "result.json");
    if ((interrupted() || done) && !told) {
      told = true;
      end = Clock::now() + kEndBound;
      if (interrupted() || !ends_by_itself) ::kill(pid, SIGTERM);  // the process ends the run in order
    }
    if (Clock::now() > end) {
      ::kill(pid, SIGKILL);
      ::waitpid(pid, nullptr, 0);
      break;
    }
    std::this_thread::sleep_for(kPoll);
  }
  print_new();
  if (failed && ends_by_itself && !interrupted()) print_log(folder / "log", print);
  return fs::exists(folder / "result.json");
}

}  // namespace

bool run_manifest(const std::string& manifest, const fs::path& folder, const std::function<bool()>& interrupted,
                  const std::function<void(const std::string&)>& print) {
  const fs::path file = folder / "manifest.yaml";
  std::ofstream(file) << manifest;
  const pid_t pid =
      start("constrictor", {"run", "--manifest", file.string(), "--report", (folder / "run").string()}, {}, folder);
  return follow(pid, folder, false, interrupted, print);
}

std::vector<std::string> joining_arguments(const ServedPart& part) {
  StandBoard* const none = nullptr;  // only the names are needed
  std::string roster;
  for (const auto& factory : stand_factories(part.place, *none)) roster += factory.name + ",";
  std::vector<std::string> words = {"--domain",   std::to_string(part.domain), "--plant", kStandPlant,
                                    "--roster",   roster + part.place.part,    "--robot", part.robot.string(),
                                    "--scenario", part.scenario.string()};
  // A mission contains blanks; only the planner needs it.
  const std::string mission = Configuration::load(part.scenario).one_line("mission");
  if (!mission.empty() && part.place.part == "planner") words.insert(words.end(), {"--mission", "'" + mission + "'"});
  return words;
}

bool serve_part(const ServedPart& part, const fs::path& folder, const std::function<bool()>& interrupted,
                const std::function<void(const std::string&)>& print) {
  std::vector<std::string> words = joining_arguments(part);
  if (words[words.size() - 2] == "--mission") words.back() = words.back().substr(1, words.back().size() - 2);
  words.insert(words.end(),
               {"--output", (folder / "run").string(), "--patience", fmt::format("{:g}", part.patience_s)});
  const pid_t pid = start("conform_part", std::move(words),
                          {"CONSTRICTOR_CONFORM=" + folder.string(), "CONSTRICTOR_CONFORM_PART=" + part.place.part,
                           "CONSTRICTOR_CONFORM_SERVED=1"},
                          folder);
  return follow(pid, folder, true, interrupted, print);
}

}  // namespace constrictor::conform
