// The commands topic, node and status with real processes: a run of toy components, and programs of other projects.
#include <signal.h>

#include <algorithm>
#include <sstream>

#include "client/components.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "introspection_fixture.hpp"
#include "runtime/wire.hpp"

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

TEST_F(Introspection, ReadsAppendableTypesInTheNewerEncodingXcdr2) {
  const DomainClaim claim;
  const Process talker = foreign(claim.domain(), "appendable");
  const json sample = json_of({"topic", "echo", "tide", "--count", "1", "--run", std::to_string(claim.domain())});
  ASSERT_TRUE(sample.is_object()) << output_;
  EXPECT_EQ(sample["flag"], 9);
  EXPECT_EQ(sample["level"], 2.75);
  EXPECT_EQ(sample["gusts"], json::parse(R"([{"speed":1.5,"strength":2}])"));
  EXPECT_GT(sample["count"], 0);
}

TEST_F(Introspection, ShowsTheBytesIfNoWriterDescribesTheType) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  const Process talker = foreign(claim.domain(), "untyped");
  const json sample = json_of({"topic", "echo", "weather", "--count", "1", "--run", number});
  ASSERT_TRUE(sample.contains("cdr")) << output_;
  const std::string bytes = sample["cdr"];
  EXPECT_EQ(bytes.size(), 2 * sample["size"].get<std::size_t>());
  EXPECT_EQ(bytes.substr(0, 4), "0001");                             // CDR, little-endian
  EXPECT_NE(bytes.find("54726f6e646865696d00"), std::string::npos);  // "Trondheim"
  EXPECT_EQ(command({"topic", "echo", "weather", "--count", "1", "--run", number}), 0);
  EXPECT_NE(output_.find("does not describe the type"), std::string::npos) << output_;
}

TEST_F(Introspection, MeasuresTheRateAndDelayOfAForeignTopic) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  const Process talker = foreign(claim.domain(), "untyped");
  const json rate = json_of({"topic", "hz", "weather", "--for", "1", "--run", number});
  EXPECT_GT(rate["rate_hz"], 20.0) << rate;  // the talker sends one message in 10 ms, or fewer on a busy machine
  EXPECT_LT(rate["rate_hz"], 105.0) << rate;
  EXPECT_GT(rate["greatest_interval_s"], 0.008);
  const json delay = json_of({"topic", "delay", "weather", "--for", "1", "--run", number});
  EXPECT_GT(delay["least_s"], 0.0);
  EXPECT_LT(delay["least_s"], 0.5);
}

TEST_F(Introspection, ATopicWithoutAWriterEndsWithStatusOne) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  EXPECT_EQ(command({"topic", "echo", "joint_state", "--timeout", "2", "--run", number}), 1);
  EXPECT_NE(output_.find("waiting up to 2 s for a writer of 'joint_state'"), std::string::npos) << output_;
  EXPECT_NE(output_.find("no writer of 'joint_state'"), std::string::npos) << output_;
}

TEST_F(Introspection, AnUnknownTopicIsAnErrorWithTheClosestNameAndNotATimeout) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(command({"topic", "echo", "joint_sate", "--timeout", "60", "--run", number}), 70);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 30s);
  EXPECT_NE(output_.find("no topic 'joint_sate' in DDS domain " + number + ", did you mean 'joint_state'?"),
            std::string::npos)
      << output_;
}

TEST_F(Introspection, ADomainWithoutProcessesIsAnErrorForCommandsThatListThem) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  for (const char* subcommand : {"topic", "node"}) {
    EXPECT_EQ(command({subcommand, "list", "--run", number}), 70) << output_;
    EXPECT_NE(output_.find("no process in DDS domain " + number), std::string::npos) << output_;
    EXPECT_EQ(command({subcommand, "list", "--json", "--run", number}), 70) << output_;
  }
}

TEST_F(Introspection, EchoShowsNamesOfConstantsAndTheUsedPartOfArrays) {
  const DomainClaim claim;
  const std::string number = std::to_string(claim.domain());
  const dds::Domain domain(claim.domain());
  const dds::Writer<msg::TaskStatus> tasks(domain.participant(), "task/status", 1);
  msg::TaskStatus task{};
  task.task = msg::kTaskExplore;
  tasks.write(task);
  const dds::Writer<msg::JointState> states(domain.participant(), "joint_state", 1);
  msg::JointState state{};
  state.joint_count = 3;
  for (int i = 0; i < 64; ++i) state.position_rad[i] = i;
  states.write(state);
  EXPECT_EQ(command({"topic", "echo", "task/status", "--count", "1", "--field", "task", "--run", number}), 0);
  EXPECT_EQ(output_, "explore\n");
  EXPECT_EQ(command({"topic", "echo", "joint_state", "--count", "1", "--field", "position_rad", "--run", number}), 0);
  EXPECT_EQ(output_, "[0.0,1.0,2.0]\n");
  // JSON output has the same names. Its arrays are whole, so that scripts find them at a fixed length.
  const json named = json_of({"topic", "echo", "task/status", "--count", "1", "--run", number});
  EXPECT_EQ(named["task"], "explore");
  EXPECT_EQ(named["goal_state"], "idle");
  const json whole = json_of({"topic", "echo", "joint_state", "--count", "1", "--run", number});
  EXPECT_EQ(whole["position_rad"].size(), 64u);
  EXPECT_EQ(whole["position_rad"][63], 63.0);
}

TEST_F(Introspection, ListsTopicsNodesAndTheStateOfARun) {
  Process run = toys();
  ASSERT_TRUE(eventually([&] {
    return command({"topic", "list", "--json"}) == 0 && output_.find("joint_state") != std::string::npos;
  })) << output_;
  int barrier = 0;
  for (const json& topic : json_of({"topic", "list"})) {
    if (topic["topic"].get<std::string>().rfind("barrier/", 0) != 0) continue;
    ++barrier;
    EXPECT_FALSE(topic["what"].is_null()) << topic;
  }
  EXPECT_GT(barrier, 3) << output_;
  json sample;
  EXPECT_TRUE(eventually([&] {  // the first sample may be that of tick 0
    sample = json_of({"topic", "echo", "joint_state", "--count", "1"});
    return sample.is_object() && sample["header"]["tick"] > 0;
  })) << output_;
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

  json status;
  EXPECT_TRUE(eventually([&] {  // after a delay the run makes up for lost ticks, faster than its 50 Hz
    status = json_of({"status"});
    const auto& all = status["components"];
    return std::all_of(all.begin(), all.end(), [](const json& component) {
      return component["rate_hz"].is_number() && component["rate_hz"] > 0.0 && component["rate_hz"] < 60.0;
    });
  })) << status;
  EXPECT_EQ(status["components"].size(), 3u);
  for (const auto& component : status["components"]) {
    EXPECT_EQ(component["state"], "running") << component;
    EXPECT_GE(component["step_time_p99_us"], component["step_time_p50_us"]);
  }
  EXPECT_EQ(command({"status"}), 0) << output_;
  std::istringstream lines(output_);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("report in") == std::string::npos) {
      EXPECT_LE(line.size(), 80u) << line;
    }
  }
  EXPECT_EQ(command({"topic", "echo", "joint_state", "--count", "1", "--field", "header.tock"}), 64) << output_;
  EXPECT_NE(output_.find("found 'tock'"), std::string::npos) << output_;
  EXPECT_NE(output_.find("tick"), std::string::npos) << "the error must list the existing fields: " << output_;
  EXPECT_EQ(command({"topic", "hz", "request/v2", "--for", "0.5", "--timeout", "1"}), 1);
  EXPECT_NE(output_.find("request"), std::string::npos) << "the error must name the topic: " << output_;
  EXPECT_EQ(command({"doctor"}), 0) << output_;
  EXPECT_NE(output_.find("no fault found"), std::string::npos);

  Process other = start({"run", (dir_ / "100000_ticks.yaml").string(), "--manifest", (dir_ / "toys.yaml").string(),
                         "--pace", "1x", "--report", (dir_ / "other").string()});
  ASSERT_TRUE(other.wait_for("simulated", 20s)) << other.errors();
  command({"doctor"});
  std::size_t domains = 0;
  for (auto at = output_.find("domain "); at != std::string::npos; at = output_.find("\ndomain ", at + 1)) ++domains;
  EXPECT_EQ(domains, 2u) << "doctor must examine each run: " << output_;
  ASSERT_EQ(command({"status"}), 0) << output_;
  const std::string run_number = "run " + std::to_string(domain()) + ": ";
  EXPECT_NE(output_.find(run_number), std::string::npos) << output_;
  EXPECT_NE(output_.find("choose one for its components: --run "), std::string::npos) << output_;
  EXPECT_NE(output_.find("--run " + std::to_string(domain())), std::string::npos) << output_;
  ASSERT_EQ(command({"status", "--run", std::to_string(domain())}), 0) << output_;
  std::size_t named = 0;
  for (auto at = output_.find("run "); at != std::string::npos; at = output_.find("\nrun ", at + 1)) ++named;
  EXPECT_EQ(named, 2u) << "the run that was asked for, and its state: " << output_;
  EXPECT_EQ(output_.rfind(run_number, 0), 0u) << output_;
  EXPECT_NE(output_.find("\n" + run_number), std::string::npos) << "the state must name its run: " << output_;
  other.signal(SIGTERM);
  EXPECT_TRUE(other.wait(20s));
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

// DDS keeps the last Waiting message of a member for late readers, even when the wait is over.
TEST_F(Introspection, StatusDoesNotShowAWaitThatIsOver) {
  Process run = toys();
  ASSERT_TRUE(run.wait_for("simulated", 20s)) << run.output() << run.errors();
  EXPECT_EQ(command({"node", "info", "contrl"}), 70);
  EXPECT_NE(output_.find("hosts such a component, did you mean 'control'? ("), std::string::npos) << output_;
  const json node = json_of({"node", "info", "control"});
  ASSERT_TRUE(node.is_array() && !node.empty()) << output_;
  const auto pid = node[0]["pid"].get<pid_t>();
  ASSERT_EQ(::kill(pid, SIGSTOP), 0);
  EXPECT_TRUE(run.wait_for("physics waits for TickDone of ", 20s)) << run.output();
  EXPECT_EQ(command({"status"}), 0);
  const auto wait = output_.find("physics waits for TickDone of ");
  ASSERT_NE(wait, std::string::npos) << "status must show the wait while it lasts: " << output_;
  const long tick = std::stol(output_.substr(output_.find("at tick ", wait) + 8));
  ASSERT_EQ(::kill(pid, SIGCONT), 0);
  // Each component sends its status every 50 ticks; after 120 ticks every status is newer than the wait.
  EXPECT_TRUE(eventually([&] { return json_of({"status"})["tick"] > tick + 120; })) << output_;
  EXPECT_EQ(command({"status"}), 0);
  EXPECT_EQ(output_.find("waits for"), std::string::npos) << output_;
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
}

TEST_F(Introspection, StatusShowsAuthorityAndRefusalsAndStatusWatchUpdatesThem) {
  // `input` is the real component, the other members are toys. It does not ask toys for their parameters.
  Process run = toys("  - {components: [overview], program: toy_host}\n  - {components: [input]}\n");
  ASSERT_TRUE(run.wait_for("simulated", 20s)) << run.output() << run.errors();
  Process watch = start({"status", "--watch"});
  ASSERT_TRUE(watch.wait_for("authority: none", 20s)) << watch.output() << watch.errors();
  ASSERT_EQ(command({"stop"}), 0) << output_;
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left"}), 1) << "refused: " << output_;
  {
    // Every member that receives this tick refuses it, because it belongs to no run.
    const dds::Domain stranger(domain());
    const auto components = read_components(stranger.participant());
    ASSERT_EQ(components.size(), 3u) << "the client library must list physics, overview and input";
    EXPECT_EQ(components.at("input").state, msg::kComponentRunning);
    const dds::Writer<msg::Tick> ticks(stranger.participant(), barrier_topics::kTick, 1);
    ASSERT_TRUE(eventually([&] { return ticks.readers() >= 2; }));
    ticks.write(msg::Tick{});
    EXPECT_TRUE(eventually([&] {
      command({"status"});
      return flat(output_).find("last refusal: barrier/tick.writer: found a process that has not announced itself") !=
             std::string::npos;
    })) << output_;
  }
  const std::string text = flat(output_);
  EXPECT_NE(text.find("authority: EMERGENCY STOP "), std::string::npos) << text;
  EXPECT_NE(text.find("; 1 request refused, the last one from "), std::string::npos) << text;
  EXPECT_NE(text.find(" is latched"), std::string::npos) << "the reason of the refusal must be shown: " << text;
  const json status = json_of({"status"});
  EXPECT_EQ(status["authority"]["level"], "emergency stop") << output_;
  EXPECT_EQ(status["authority"]["refused"], 1);
  EXPECT_NE(status["authority"]["refusal"].get<std::string>().find(" is latched"), std::string::npos);
  for (const auto& component : status["components"]) {
    const bool listens = component["component"] != "physics";  // the plant writes the ticks and does not read them
    EXPECT_EQ(component["refused"], listens ? 1 : 0) << component;
    EXPECT_EQ(component["last_refusal"],
              listens ? "barrier/tick.writer: found a process that has not announced itself as this member" : "")
        << component;
  }
  EXPECT_TRUE(watch.wait_for("authority: EMERGENCY STOP ", 20s))
      << "status --watch must show the new authority: " << watch.output();
  run.signal(SIGTERM);
  EXPECT_TRUE(run.wait(20s));
  EXPECT_EQ(watch.wait(20s), 0) << "status --watch must end with the run: " << watch.output();
}

}  // namespace
}  // namespace constrictor::testing
