// Log lines of a run: on the topic `log` while it goes on, in the files of its report, and that they change nothing.
#include <signal.h>

#include <regex>

#include "integration/introspection_fixture.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

class LogCommand : public Introspection {
 protected:
  /// Runs `log` with --json and returns its lines.
  std::vector<json> lines(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "log");
    arguments.emplace_back("--json");
    EXPECT_EQ(command(std::move(arguments)), 0) << output_;
    std::vector<json> parsed;
    std::istringstream text(output_);
    for (std::string line; std::getline(text, line);) parsed.push_back(json::parse(line, nullptr, false));
    return parsed;
  }
  [[nodiscard]] static std::vector<json> of(const std::vector<json>& lines, const std::string& process) {
    std::vector<json> found;
    for (const auto& line : lines) {
      if (line.value("process", "") == process) found.push_back(line);
    }
    return found;
  }
  /// Starts a run of toys in one process, whose report logs this many lines in each of its ticks.
  [[nodiscard]] Process loud_run(int lines, long ticks, const std::string& report,
                                 const std::string& pace = "lockstep") {
    write("loud.yaml", std::string(kManifest) +
                           "  - {components: [navigation, control, planner], program: toy_host}\n"
                           "  - {components: [report], program: toy_host}\n");
    const std::string scenario = std::to_string(ticks) + "_ticks.yaml";
    write(scenario, "");
    environment_["TOY_LINES"] = std::to_string(lines);
    return start({"run", (dir_ / scenario).string(), "--manifest", (dir_ / "loud.yaml").string(), "--pace", pace,
                  "--report", (dir_ / report).string()});
  }
};

TEST_F(LogCommand, TheFirstLineOfAProcessNamesTheRevisionOfItsProgram) {
  Process about({program("input"), "--version"});
  ASSERT_EQ(about.wait(20s), 0);
  const std::string version = about.output();
  const auto at = version.find("\ngit ");
  ASSERT_NE(at, std::string::npos) << version;
  const std::string revision = version.substr(at + 1, version.find('\n', at + 1) - at - 1);  // "git 0a1b2c of ..."
  EXPECT_TRUE(std::regex_search(revision, std::regex("git [0-9a-f]{12} of \\d{4}-\\d\\d-\\d\\d|git not known")))
      << revision;
  // The toys do not contain their revision, although their launcher does: the line must not borrow that one.
  Process run = toys(std::string(kMembers) + "  - {components: [input]}\n");
  std::vector<json> all;
  ASSERT_TRUE(eventually([&] {
    all = lines({"--grep", "starts: Constrictor"});
    return !of(all, "physics").empty() && !of(all, "input").empty();
  })) << output_;
  EXPECT_NE(of(all, "input").front()["message"].get<std::string>().find(", " + revision + ", IDL "), std::string::npos)
      << all;
  EXPECT_NE(of(all, "physics").front()["message"].get<std::string>().find(", git not known"), std::string::npos) << all;
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

TEST_F(LogCommand, ShowsTheLinesOfAllProcessesOfALiveRun) {
  Process run = toys();
  std::vector<json> all;
  // A process that is still starting has written no line yet.
  ASSERT_TRUE(eventually([&] {
    all = lines({});
    return !of(all, "physics").empty() && !of(all, "navigation,control").empty() && !of(all, "launcher").empty();
  })) << output_;
  const json first = of(all, "navigation,control").front();
  EXPECT_EQ(first["level"], "info");
  EXPECT_EQ(first["number"], 1);
  EXPECT_EQ(first["incarnation"], 1);
  EXPECT_EQ(first["foreign"], false);
  EXPECT_TRUE(first["tick"].is_null()) << "no epoch has begun: " << first;
  const std::string banner = first["message"];
  const std::regex pattern("starts: Constrictor \\d+\\.\\d+\\.\\d+, git not known: [a-z ]+, IDL [0-9a-f]{12}, domain " +
                           std::to_string(domain()) +
                           ", configuration [0-9a-f]{12}, incarnation 1, pid \\d+ on \\S+, started by constrictor "
                           "\\d+\\.\\d+\\.\\d+ git .*");
  EXPECT_TRUE(std::regex_match(banner, pattern)) << banner;
  EXPECT_NE(banner.find("pid " + std::to_string(first["pid"].get<int>()) + " "), std::string::npos) << banner;
  const auto time = [](const json& line) { return line["wall_time_ns"].get<std::int64_t>(); };
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [&](const json& a, const json& b) { return time(a) < time(b); }));

  for (const auto& line : lines({"--component", "control"})) EXPECT_EQ(line["process"], "navigation,control") << line;
  EXPECT_EQ(lines({"--component", "control"}).size(), of(all, "navigation,control").size());
  EXPECT_EQ(lines({"--grep", "starts: Constrictor", "--last", "1"}).size(), 1u);
  EXPECT_TRUE(lines({"--level", "error"}).empty()) << output_;
  EXPECT_TRUE(lines({"--level", "error", "--component", "physics"}).empty()) << output_;
  EXPECT_EQ(command({"log", "--component", "physcs"}), 64) << output_;
  EXPECT_NE(output_.find("--component: found 'physcs', accepted "), std::string::npos) << output_;
  EXPECT_NE(output_.find("did you mean 'physics'?"), std::string::npos) << output_;
  EXPECT_EQ(lines({"--level", "warn"}).size(), lines({"--level", "warning"}).size());
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));

  // The report of the run that has ended has at least the same lines.
  const auto kept = lines({(dir_ / "report").string()});
  for (const auto& line : all) {
    const bool found = std::any_of(kept.begin(), kept.end(), [&](const json& other) {
      return other["message"] == line["message"] && other["level"] == line["level"];
    });
    EXPECT_TRUE(found) << line;
  }
  EXPECT_EQ(command({"log", (dir_ / "report").string(), "--component", "launche"}), 64) << output_;
  EXPECT_NE(output_.find("did you mean 'launcher'"), std::string::npos) << output_;
  EXPECT_TRUE(std::any_of(kept.begin(), kept.end(), [](const json& line) {
    return line["process"] == "launcher" && line["message"].get<std::string>().starts_with("mission ");
  }));
}

TEST_F(LogCommand, FollowsARunUntilItsEndAndShowsHowAProcessDies) {
  Process run = toys();
  ASSERT_TRUE(eventually([&] { return json_of({"status"}).value("tick", -1) > 0; })) << output_;
  Process follow = start({"log", "--follow"});
  ASSERT_TRUE(follow.wait_for("info navigation,control: starts", 20s)) << follow.output() << follow.errors();
  const json node = json_of({"node", "info", "control"});
  ASSERT_TRUE(node.is_array() && !node.empty()) << output_;
  ASSERT_EQ(::kill(node[0]["pid"].get<pid_t>(), SIGKILL), 0);
  EXPECT_TRUE(follow.wait_for("was killed by signal 9 (Killed); restarted as incarnation 2", 20s)) << follow.output();
  EXPECT_TRUE(follow.wait_for("incarnation 2, pid", 20s)) << follow.output();
  const std::regex warning("warning launcher tick \\d+: \\S+ was killed");
  EXPECT_TRUE(std::regex_search(follow.output(), warning)) << follow.output();
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
  EXPECT_EQ(follow.wait(20s), 0) << follow.errors();
  EXPECT_NE(follow.errors().find("log: "), std::string::npos) << "it says that the run is over";
}

TEST_F(LogCommand, ManyLinesChangeNoResultAndAreCountedWhereTheyAreLost) {
  constexpr long kTicks = 300;
  constexpr int kLines = 20;
  Process quiet = loud_run(0, kTicks, "quiet");
  ASSERT_EQ(quiet.wait(60s), 0) << quiet.output() << quiet.errors();
  // 1,000 lines a second, and a reader that does not read for a third of the time. (A reader that is stopped until the
  // run is over may have lost its writers, and with them what has arrived: it cannot know what it missed.)
  Process loud = loud_run(kLines, kTicks, "loud", "1x");
  ASSERT_TRUE(eventually([&] { return domain() != 0; })) << loud.output() << loud.errors();
  Process follow = start({"log", "--follow", "--component", "report"});
  ASSERT_TRUE(follow.wait_for("of tick", 20s)) << follow.output() << follow.errors();
  follow.signal(SIGSTOP);
  const auto written = [&] { return lines({(dir_ / "loud").string(), "--component", "report"}).size(); };
  const std::size_t stopped_at = written();
  EXPECT_TRUE(eventually([&] { return written() > stopped_at + static_cast<std::size_t>(kTicks * kLines / 3); }));
  follow.signal(SIGCONT);
  ASSERT_EQ(loud.wait(60s), 0) << loud.output() << loud.errors();
  EXPECT_EQ(follow.wait(20s), 0) << follow.errors();
  ASSERT_NE(report("quiet")["state_hash"], json()) << report("quiet");
  EXPECT_EQ(report("loud")["state_hash"], report("quiet")["state_hash"]);

  const auto in_file = lines({(dir_ / "loud").string(), "--component", "report", "--grep", "of tick"});
  ASSERT_EQ(in_file.size(), static_cast<std::size_t>(kTicks * kLines));
  for (std::size_t i = 0; i < in_file.size(); ++i) {
    ASSERT_EQ(in_file[i]["message"], "line " + std::to_string(i % kLines) + " of tick " + std::to_string(i / kLines));
    ASSERT_EQ(in_file[i]["tick"], i / kLines);
  }
  std::smatch lost;
  const std::string errors = follow.errors();
  ASSERT_TRUE(std::regex_search(errors, lost, std::regex("log: (\\d+) lines of report did not arrive"))) << errors;
  EXPECT_GT(std::stol(lost[1].str()), 100) << "at most 100 lines a second are published";
}

TEST_F(LogCommand, RefusesWhatCannotBeShown) {
  EXPECT_EQ(command({"log"}), 70);
  EXPECT_NE(output_.find("no run"), std::string::npos) << output_;
  EXPECT_EQ(command({"log", dir_.string()}), 70);
  EXPECT_NE(output_.find("found no log files"), std::string::npos) << output_;
  EXPECT_EQ(command({"log", dir_.string(), "--follow"}), 64);
  EXPECT_NE(output_.find("leave the folder out"), std::string::npos) << output_;
  EXPECT_EQ(command({"log", (dir_ / "nowhere").string()}), 64);
  EXPECT_EQ(command({"log", "--level", "loud"}), 64);
  EXPECT_NE(output_.find("warning"), std::string::npos) << "the accepted levels: " << output_;
  EXPECT_EQ(command({"log", "--last", "0"}), 64);
  EXPECT_EQ(command({"log", "--since", "-1"}), 64);
}

}  // namespace
}  // namespace constrictor::testing
