// topic, node, status, doctor and completion on real processes: a run of toys, and programs that are no part of the project.
#include <signal.h>

#include <sstream>

#include "introspection_fixture.hpp"
#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/dds/wire.hpp"
#include "runtime/domain_claim.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

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

// What was said of a wait is kept for late observers.
TEST_F(Introspection, StatusTellsNothingOfAWaitThatIsOver) {
  Process run = toys();
  ASSERT_TRUE(run.wait_for("simulated", 20s)) << run.output() << run.errors();
  const json node = json_of({"node", "info", "control"});
  ASSERT_TRUE(node.is_array() && !node.empty()) << output_;
  const auto pid = node[0]["pid"].get<pid_t>();
  ASSERT_EQ(::kill(pid, SIGSTOP), 0);
  EXPECT_TRUE(run.wait_for("physics waits for TickDone of ", 20s)) << run.output();
  EXPECT_EQ(command({"status"}), 0);
  const auto wait = output_.find("physics waits for TickDone of ");
  ASSERT_NE(wait, std::string::npos) << "as long as it lasts: " << output_;
  const long tick = std::stol(output_.substr(output_.find("at tick ", wait) + 8));
  ASSERT_EQ(::kill(pid, SIGCONT), 0);
  // Each component's status comes every 50 ticks.
  EXPECT_TRUE(eventually([&] { return json_of({"status"})["tick"] > tick + 120; })) << output_;
  EXPECT_EQ(command({"status"}), 0);
  EXPECT_EQ(output_.find("waits for"), std::string::npos) << output_;
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

TEST_F(Introspection, StatusTellsWhoHasAuthorityAndWhatWasRefusedAndGoesOnTellingIt) {
  // The real input, beside toys whose parameters it does not ask for.
  Process run = toys("  - {components: [overview], program: toy_host}\n  - {components: [input]}\n");
  ASSERT_TRUE(run.wait_for("simulated", 20s)) << run.output() << run.errors();
  Process watch = start({"status", "--watch"});
  ASSERT_TRUE(watch.wait_for("authority: nobody", 20s)) << watch.output() << watch.errors();
  ASSERT_EQ(command({"stop"}), 0) << output_;
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left"}), 1) << "refused: " << output_;
  {
    // What is of no run is refused by every member that hears it.
    const dds::Domain stranger(domain());
    const dds::Writer<msg::Tick> ticks(stranger.participant(), dds::barrier_topics::kTick, 1);
    ASSERT_TRUE(eventually([&] { return ticks.readers() >= 2; }));
    ticks.write(msg::Tick{});
    EXPECT_TRUE(eventually([&] {
      command({"status"});
      return flat(output_).find("last refusal: tick: of another epoch") != std::string::npos;
    })) << output_;
  }
  const std::string text = flat(output_);
  EXPECT_NE(text.find("authority: emergency stop "), std::string::npos) << text;
  EXPECT_NE(text.find("; 1 requests refused, the last that of "), std::string::npos) << text;
  EXPECT_NE(text.find(" is latched"), std::string::npos) << "the reason: " << text;
  const json status = json_of({"status"});
  EXPECT_EQ(status["authority"]["level"], "emergency stop") << output_;
  EXPECT_EQ(status["authority"]["refused"], 1);
  EXPECT_NE(status["authority"]["refusal"].get<std::string>().find(" is latched"), std::string::npos);
  for (const auto& component : status["components"]) {
    const bool listens = component["component"] != "physics";  // who writes the ticks
    EXPECT_EQ(component["refused"], listens ? 1 : 0) << component;
    EXPECT_EQ(component["last_refusal"], listens ? "tick: of another epoch" : "") << component;
  }
  EXPECT_TRUE(watch.wait_for("authority: emergency stop ", 20s)) << "the same program, later: " << watch.output();
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
  EXPECT_EQ(watch.wait(20s), 0) << "it ends with the run: " << watch.output();
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

TEST_F(Introspection, TheDoctorFindsAConfigurationThatCannotBeReadOrIsWrong) {
  using Faults = std::vector<std::string>;
  const DomainClaim claim;
  environment_["CYCLONEDDS_URI"] = "file:///nosuch/cyclonedds.xml";
  EXPECT_EQ(faults(claim.domain()), (Faults{"unreadable configuration", "no DDS"})) << output_;
  EXPECT_NE(output_.find("cannot read /nosuch/cyclonedds.xml"), std::string::npos) << output_;
  EXPECT_NE(output_.find("cure what stands above first"), std::string::npos) << output_;
  write("unclosed.xml", "<CycloneDDS><Domain>\n");
  for (const std::string wrong : {"<CycloneDDS><Domain></CycloneDDS>", "<CycloneDDS><Domain><Nonsense>3</Nonsense></Domain></CycloneDDS>",
                                  "file://UNCLOSED"}) {
    environment_["CYCLONEDDS_URI"] = wrong == "file://UNCLOSED" ? "file://" + (dir_ / "unclosed.xml").string() : wrong;
    EXPECT_EQ(faults(claim.domain()), Faults{"no DDS"}) << wrong << output_;
    EXPECT_NE(output_.find("unset CYCLONEDDS_URI, or correct it"), std::string::npos) << output_;
  }
}

TEST_F(Introspection, TheDoctorFindsAnEmptyDomainAndOneTopicOfTwoTypes) {
  const DomainClaim claim;
  EXPECT_EQ(faults(claim.domain()), std::vector<std::string>{"nobody there"}) << output_;
  const Process talker = foreign(claim.domain(), "final");
  const dds::Domain domain(claim.domain());
  const auto other = dds::Reader<msg::RunState>::observer(domain.participant(), "weather");
  EXPECT_EQ(faults(claim.domain()), std::vector<std::string>{"differing type"}) << output_;
  EXPECT_NE(output_.find("foreign::Weather"), std::string::npos) << output_;
  EXPECT_NE(output_.find("constrictor::msg::RunState"), std::string::npos) << output_;
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
