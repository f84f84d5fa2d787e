// topic, node, status, doctor and completion on real processes: a run of toys, and programs that are no part of the project.
#include <sstream>

#include "cli_fixture.hpp"
#include "runtime/domain_claim.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr const char* kManifest =
    "plant: physics\nrobot: components/robot/mamba.yaml\nscenario: sim/scenarios/case_study.yaml\npatience_s: 30\nprocesses:\n"
    "  - {components: [physics], program: toy_host}\n  - {components: [navigation, control], program: toy_host}\n";

class Introspection : public CliFixture {
 protected:
  [[nodiscard]] Process foreign(std::uint32_t domain, const std::string& mode) const {
    Process process({program("foreign_talker"), std::to_string(domain), mode}, environment_);
    EXPECT_TRUE(process.wait_for("talking", 20s)) << process.errors();
    return process;
  }
  /// A run of toys at real-time pace: 50 ticks a second, and it lasts.
  [[nodiscard]] Process toys() const {
    write("toys.yaml", kManifest);
    write("100000_ticks.yaml", "");
    Process run = start({"run", (dir_ / "100000_ticks.yaml").string(), "--manifest", (dir_ / "toys.yaml").string(), "--pace", "1x",
                         "--report", (dir_ / "report").string()});
    EXPECT_TRUE(eventually([&] { return domain() != 0; }));
    return run;
  }
  /// Output of a command as JSON; it must end with `status`. What it says to people stays in `output_`.
  json json_of(std::vector<std::string> arguments, int status = 0) {
    arguments.push_back("--json");
    Process process = start(std::move(arguments));
    const auto ended = process.wait(30s);
    output_ = process.output() + process.errors();
    EXPECT_EQ(ended, status) << output_;
    return json::parse(process.output(), nullptr, false);
  }
  /// Names of what the doctor finds in a domain.
  std::vector<std::string> faults(std::uint32_t domain) {
    const json found = json_of({"doctor", "--run", std::to_string(domain)}, 1);
    std::vector<std::string> names;
    for (const auto& finding : found.value("findings", json::array())) {
      names.push_back(finding["fault"]);
      EXPECT_FALSE(finding["cure"].get<std::string>().empty());
    }
    return names;
  }
};

TEST_F(Introspection, ShowsEveryFieldOfATypeThatThisProjectDoesNotDefine) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  const Process talker = foreign(claim.domain(), "final");
  const json sample = json_of({"topic", "echo", "weather", "--count", "1", "--run", number});
  ASSERT_TRUE(sample.is_object()) << output_;
  EXPECT_EQ(sample["station"], "Trondheim");
  EXPECT_EQ(sample["flag"], 7);
  EXPECT_EQ(sample["temperature"], -3.5);
  EXPECT_EQ(sample["grid"], json::parse("[[0.0,0.5,1.0],[1.5,2.0,2.5]]"));
  EXPECT_EQ(sample["gusts"], json::parse(R"([{"speed":12.5,"strength":3},{"speed":20.25,"strength":5}])"));
  EXPECT_EQ(sample["remarks"], json::parse(R"(["windy",""])"));
  EXPECT_EQ(sample["sky"], "RAIN");
  EXPECT_EQ(sample["reading"]["text"], "drizzle");
  EXPECT_EQ(sample["night"], true);
  EXPECT_EQ(sample["when"], -1234567890123);
  EXPECT_EQ(command({"topic", "echo", "weather", "--count", "1", "--field", "gusts.1.speed", "--run", number}), 0);
  EXPECT_EQ(output_, "20.25\n");
  EXPECT_EQ(command({"topic", "info", "weather", "--run", number}), 0);
  EXPECT_NE(output_.find("double temperature"), std::string::npos) << output_;
}

TEST_F(Introspection, ReadsAppendableTypesInTheirNewerEncoding) {
  const DomainClaim claim;
  const Process talker = foreign(claim.domain(), "appendable");
  const json sample = json_of({"topic", "echo", "tide", "--count", "1", "--run", std::to_string(claim.domain())});
  ASSERT_TRUE(sample.is_object()) << output_;
  EXPECT_EQ(sample["flag"], 9);
  EXPECT_EQ(sample["level"], 2.75);
  EXPECT_EQ(sample["gusts"], json::parse(R"([{"speed":1.5,"strength":2}])"));
  EXPECT_GT(sample["count"], 0);
}

TEST_F(Introspection, ShowsTheBytesOfATypeThatNobodyDescribes) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  const Process talker = foreign(claim.domain(), "untyped");
  const json sample = json_of({"topic", "echo", "weather", "--count", "1", "--run", number});
  ASSERT_TRUE(sample.contains("cdr")) << output_;
  const std::string bytes = sample["cdr"];
  EXPECT_EQ(bytes.size(), 2 * sample["size"].get<std::size_t>());
  EXPECT_EQ(bytes.substr(0, 4), "0001");                                 // CDR, little-endian
  EXPECT_NE(bytes.find("54726f6e646865696d00"), std::string::npos);      // "Trondheim"
  EXPECT_EQ(command({"topic", "echo", "weather", "--count", "1", "--run", number}), 0);
  EXPECT_NE(output_.find("does not describe the type"), std::string::npos) << output_;
}

TEST_F(Introspection, MeasuresTheRateAndDelayOfAForeignTopic) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  const Process talker = foreign(claim.domain(), "untyped");
  const json rate = json_of({"topic", "hz", "weather", "--for", "1", "--run", number});
  EXPECT_GT(rate["rate_hz"], 20.0) << rate;   // one in 10 ms, on a busy machine fewer
  EXPECT_LT(rate["rate_hz"], 105.0) << rate;
  EXPECT_GT(rate["greatest_interval_s"], 0.008);
  const json delay = json_of({"topic", "delay", "weather", "--for", "1", "--run", number});
  EXPECT_GT(delay["least_s"], 0.0);
  EXPECT_LT(delay["least_s"], 0.5);
}

TEST_F(Introspection, ASilentTopicEndsWithStatusOne) {
  const DomainClaim claim;
  EXPECT_EQ(command({"topic", "echo", "nothing", "--timeout", "0.5", "--run", std::to_string(claim.domain())}), 1);
  EXPECT_NE(output_.find("nobody writes"), std::string::npos) << output_;
}

TEST_F(Introspection, ListsTopicsNodesAndTheStateOfARun) {
  Process run = toys();
  json topics;
  ASSERT_TRUE(eventually([&] {
    topics = json_of({"topic", "list"});
    return topics.dump().find("joint_state") != std::string::npos;
  })) << topics;
  const json sample = json_of({"topic", "echo", "joint_state", "--count", "1"});
  EXPECT_GT(sample["header"]["tick"], 0) << output_;
  EXPECT_EQ(sample["robot_id"], 1);

  const json nodes = json_of({"node", "list"});
  std::map<std::string, json> by_name;
  for (const auto& node : nodes) by_name[node["node"]] = node;
  ASSERT_TRUE(by_name.contains("navigation,control")) << nodes;
  EXPECT_EQ(by_name["navigation,control"]["process"], "toy_host");
  EXPECT_EQ(::kill(by_name["navigation,control"]["pid"].get<pid_t>(), 0), 0);
  EXPECT_EQ(by_name["navigation,control"]["components"][1]["component"], "control");
  EXPECT_EQ(by_name["navigation,control"]["components"][1]["idl_hash"].get<std::string>().size(), 64u);
  const json node = json_of({"node", "info", "control"});
  EXPECT_EQ(node[0]["node"], "navigation,control");

  const json status = json_of({"status"});
  EXPECT_EQ(status["components"].size(), 3u);
  for (const auto& component : status["components"]) {
    EXPECT_EQ(component["state"], "running") << component;
    if (!component["rate_hz"].is_null()) { EXPECT_LT(component["rate_hz"], 60.0); }
    EXPECT_GE(component["step_time_p99_us"], component["step_time_p50_us"]);
  }
  EXPECT_EQ(command({"status"}), 0) << output_;
  std::istringstream lines(output_);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("report in") == std::string::npos) { EXPECT_LE(line.size(), 80u) << line; }
  }
  EXPECT_EQ(command({"topic", "echo", "joint_state", "--count", "1", "--field", "header.tock"}), 64) << output_;
  EXPECT_NE(output_.find("found 'tock'"), std::string::npos) << output_;
  EXPECT_NE(output_.find("tick"), std::string::npos) << "the fields that there are: " << output_;
  EXPECT_EQ(command({"topic", "hz", "request", "--for", "0.5", "--timeout", "1"}), 1);
  EXPECT_NE(output_.find("request"), std::string::npos) << "the reason: " << output_;
  EXPECT_EQ(command({"doctor"}), 0) << output_;
  EXPECT_NE(output_.find("nothing is wrong"), std::string::npos);

  Process other = start({"run", (dir_ / "100000_ticks.yaml").string(), "--manifest", (dir_ / "toys.yaml").string(), "--pace", "1x",
                         "--report", (dir_ / "other").string()});
  ASSERT_TRUE(other.wait_for("simulated", 20s)) << other.errors();
  command({"doctor"});
  std::size_t domains = 0;
  for (auto at = output_.find("domain "); at != std::string::npos; at = output_.find("\ndomain ", at + 1)) ++domains;
  EXPECT_EQ(domains, 2u) << "each run is examined: " << output_;
  other.signal(SIGTERM);
  EXPECT_TRUE(other.wait(20s));
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

// A running conductor refuses a second member at once; before the run has begun both are there and wait.
TEST_F(Introspection, TheDoctorFindsASecondMember) {
  const DomainClaim claim;
  const std::vector<std::string> arguments = {program("toy_host"), "navigation", "--domain", std::to_string(claim.domain()),
                                              "--roster", "physics,navigation,control"};
  const Process first(arguments, environment_);
  const Process second(arguments, environment_);
  EXPECT_TRUE(eventually([&] {
    command({"doctor", "--run", std::to_string(claim.domain()), "--json"});
    return output_.find("two members of one name") != std::string::npos;
  })) << output_;
  EXPECT_NE(output_.find(std::to_string(first.pid())), std::string::npos) << output_;
  EXPECT_NE(output_.find(std::to_string(second.pid())), std::string::npos) << output_;
}

// Constrictor's own plants refuse each other; a driver of somebody's may not.
TEST_F(Introspection, TheDoctorFindsASecondPlant) {
  Process run = toys();
  const Process second = foreign(domain(), "plant");
  std::vector<std::string> found;
  EXPECT_TRUE(eventually([&] {
    found = faults(domain());
    return std::count(found.begin(), found.end(), "two plants") == 1;
  })) << output_;
  EXPECT_NE(output_.find(std::to_string(second.pid())), std::string::npos) << output_;
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

TEST_F(Introspection, TheDoctorFindsThatTheRunIsInAnotherDomain) {
  Process run = toys();
  const DomainClaim empty;
  EXPECT_EQ(faults(empty.domain()), std::vector<std::string>{"wrong domain"}) << output_;
  EXPECT_NE(output_.find("--run " + std::to_string(domain())), std::string::npos) << output_;
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

TEST_F(Introspection, TheDoctorFindsInterfacesThatCannotWorkAndBuffersThatAreSmall) {
  const DomainClaim claim;
  const auto with = [this](const std::string& general) {
    environment_["CYCLONEDDS_URI"] = "<CycloneDDS><Domain><General>" + general + "</General></Domain></CycloneDDS>";
  };
  with("<Interfaces><NetworkInterface name=\"nosuch0\"/></Interfaces>");
  auto found = faults(claim.domain());
  EXPECT_EQ(std::count(found.begin(), found.end(), "wrong interface"), 1) << output_;
  EXPECT_NE(output_.find("name one of"), std::string::npos) << output_;
  with("<Interfaces><NetworkInterface name=\"lo\"/></Interfaces><AllowMulticast>false</AllowMulticast>");
  found = faults(claim.domain());
  EXPECT_EQ(std::count(found.begin(), found.end(), "missing multicast"), 1) << output_;
  // By this host's own limit, which is not for a test to change.
  std::uint64_t limit_bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> limit_bytes;
  EXPECT_EQ(std::count(found.begin(), found.end(), "small socket buffers"), limit_bytes < 1024 * 1024 ? 1 : 0) << limit_bytes << output_;
}

TEST_F(Introspection, TheDoctorFindsQosThatDoNotMeetAndAnotherVersion) {
  const DomainClaim claim;
  const Process deaf = foreign(claim.domain(), "silent_qos");
  const Process other = foreign(claim.domain(), "other_idl");
  const auto found = faults(claim.domain());
  EXPECT_EQ(std::count(found.begin(), found.end(), "differing QoS"), 1) << output_;
  EXPECT_EQ(std::count(found.begin(), found.end(), "differing IDL hash"), 1) << output_;
}

/// What each shell offers for command lines; the last word of each is what is being typed.
class Completion : public Introspection {
 protected:
  using Words = std::vector<std::string>;

  /// What a shell offers for each of the lines, blanks around each word.
  [[nodiscard]] Words offers(const std::string& shell, const std::vector<Words>& lines) const {
    Process script({program("constrictor"), "completion", shell});
    EXPECT_EQ(script.wait(20s), 0) << script.errors();
    write("constrictor." + shell, script.output());
    std::string text = shell == "zsh" ? "autoload -Uz compinit && compinit -u -D\n" : "";
    text += "source " + (dir_ / ("constrictor." + shell)).string() + "\n";
    if (shell != "fish") {
      // As the shell calls it; zsh by its bash-compatible completion, which picks those that begin as typed later.
      text += "offer() {\n" + std::string(shell == "zsh" ? "emulate -L sh\n" : "") +
              "COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _constrictor; echo \"\" ${COMPREPLY[@]} \"\"\n}\n";
    }
    for (const auto& words : lines) {
      if (shell == "fish") {
        std::string line = "constrictor";
        for (const auto& word : words) line += " " + word;
        text += "echo '' (complete -C '" + line + "' | string replace -r '\\t.*' '') ''\n";
      } else {
        text += "offer constrictor";
        for (const auto& word : words) text += " '" + word + "'";
        text += "\n";
      }
    }
    write("offer." + shell, text);
    Process process({"/usr/bin/" + shell, (dir_ / ("offer." + shell)).string()}, environment_);
    EXPECT_EQ(process.wait(30s), 0) << process.errors();
    Words offered;
    std::istringstream output(process.output());
    for (std::string line; std::getline(output, line);) offered.push_back(line);
    return offered;
  }
};

TEST_F(Completion, EveryShellOffersTheWordsOfTheSubcommandAndNoOthers) {
  struct Case {
    Words typed;
    std::string offered;
    std::string not_offered;
  };
  const std::vector<Case> cases = {
      {{""}, "teleop", "echo"},
      {{"te"}, "teleop", "topic"},
      {{"topic", ""}, "echo", "teleop"},
      {{"topic", "echo", ""}, "joint_state", "hz"},
      {{"topic", "echo", "--ti"}, "--timeout", "--count"},
      {{"task", "wait", "--"}, "--event", "--line-colour"},
      {{"task", "wait", "--"}, "--end", "--path"},
      {{"task", "wait", "--event", ""}, "line_lost", "--timeout"},
      {{"task", "start", ""}, "follow_line", "wait"},
      {{"task", "start", "rotate", "--"}, "--direction", "--event"},
      {{"task", "start", "follow_line", "--line-colour", "b"}, "blue", "backwards"},
      {{"completion", ""}, "fish", "list"},
      {{"node", "info", "n"}, "navigation", "list"}};
  std::vector<Words> lines;
  for (const auto& c : cases) lines.push_back(c.typed);
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const Words offered = offers(shell, lines);
    ASSERT_EQ(offered.size(), cases.size()) << shell;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      EXPECT_NE(offered[i].find(" " + cases[i].offered + " "), std::string::npos) << shell << " " << cases[i].offered << ": " << offered[i];
      if (shell == "zsh" && !cases[i].not_offered.starts_with(cases[i].typed.back())) continue;
      EXPECT_EQ(offered[i].find(" " + cases[i].not_offered + " "), std::string::npos) << shell << " " << cases[i].not_offered << ": " << offered[i];
    }
  }
}

}  // namespace
}  // namespace constrictor::testing
