// The dashboard of a run of toy components, with viewers that are right, slow, hostile and foreign.
#include <random>

#include "integration/dashboard_viewer.hpp"
#include "integration/run_command_fixture.hpp"
#include "recording/message_cdr.hpp"

namespace constrictor::testing {
namespace {

using nlohmann::json;

class DashboardTest : public RunCommand {
 protected:
  DashboardTest() { environment_["XDG_RUNTIME_DIR"] = dir_.string(); }
  /// Starts a run of `ticks` ticks and its dashboard.
  void begin(long ticks, std::vector<std::string> more = {}, const std::string& pace = "4x") {
    launcher_.emplace(run(ticks, "r", {"--pace", pace, "--in-process"}));
    ASSERT_GT(domain_of(*launcher_), 0u) << launcher_->errors();
    std::vector<std::string> arguments{"dashboard", "--port", "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    dashboard_.emplace(command(arguments));
    ASSERT_TRUE(dashboard_->wait_for("Ctrl-C ends the dashboard", 20s)) << dashboard_->errors();
    const std::string output = dashboard_->output();
    port_ = static_cast<std::uint16_t>(std::stoi(output.substr(output.find("127.0.0.1:") + 10)));
  }
  [[nodiscard]] long memory_kib() const {
    std::ifstream status("/proc/" + std::to_string(dashboard_->pid()) + "/status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
    return 0;
  }
  void end() {
    launcher_->signal(SIGINT);
    EXPECT_EQ(launcher_->wait(60s), 130) << launcher_->errors();
    EXPECT_EQ(dashboard_->wait(20s), exit_status::kOk) << dashboard_->errors();
  }

  std::optional<Process> launcher_, dashboard_;
  std::uint16_t port_ = 0;
};

TEST_F(DashboardTest, ShowsEachTopicAsItIsAndDoesNotChangeTheRun) {
  ASSERT_EQ(run(1500, "alone", {"--in-process"}).wait(60s), exit_status::kOk);
  begin(1500);
  Viewer viewer(port_);
  ASSERT_EQ(viewer.status, 101) << viewer.headers;
  EXPECT_NE(viewer.headers.find("foxglove.sdk.v1"), std::string::npos);
  EXPECT_EQ(viewer.wait_for("serverInfo").value("name", ""),
            "Constrictor run " + std::to_string(domain_of(*launcher_)));
  const std::uint32_t channel = viewer.channel_of("joint_state");
  ASSERT_GT(channel, 0u);
  ASSERT_TRUE(viewer.send_text(Viewer::subscribe(77, channel)));
  const MessageCodec* codec = find_codec("JointState");
  ASSERT_TRUE(codec);
  std::int64_t tick = -1;
  for (int i = 0; i < 50;) {
    const auto message = viewer.receive();
    ASSERT_TRUE(message);
    if (message->text) continue;
    ASSERT_GT(message->bytes.size(), 17u);
    EXPECT_EQ(message->bytes.substr(0, 5), std::string("\1\x4d\0\0\0", 5));
    const std::string cdr = message->bytes.substr(13);
    const auto header = codec->header({reinterpret_cast<const std::uint8_t*>(cdr.data()), cdr.size()});
    ASSERT_TRUE(header);
    EXPECT_GT(header->tick, tick);
    tick = header->tick;
    ++i;
  }
  ASSERT_TRUE(viewer.send_text(R"({"op":"unsubscribe","subscriptionIds":[77]})"));
  EXPECT_EQ(launcher_->wait(60s), exit_status::kOk) << launcher_->errors();
  EXPECT_EQ(state_hash("r"), state_hash("alone"));
  EXPECT_EQ(dashboard_->wait(20s), exit_status::kOk);
  EXPECT_NE(dashboard_->output().find("the run has ended"), std::string::npos) << dashboard_->output();
}

TEST_F(DashboardTest, AViewerPausesStepsAndResumesTheRun) {
  begin(1'000'000);
  Viewer viewer(port_);
  ASSERT_EQ(viewer.status, 101);
  const auto ask = [&](const std::string& name, const std::string& request) { return viewer.ask(name, request); };
  const std::string paused = ask("pause", "{}");
  ASSERT_TRUE(paused.starts_with("paused, next tick ")) << paused;
  const long tick = std::stol(paused.substr(18));
  EXPECT_EQ(ask("step", R"({"ticks":3})"), "paused, next tick " + std::to_string(tick + 3));
  EXPECT_EQ(ask("resume", ""), "running");
  EXPECT_NE(ask("step", R"({"ticks":0})").find("failure: step: accepted"), std::string::npos);
  EXPECT_NE(ask("step", R"({"ticks":"3"})").find("failure: step: accepted"), std::string::npos);
  EXPECT_NE(ask("pace", R"({"pace":-1})").find("failure: pace: accepted"), std::string::npos);
  ASSERT_TRUE(viewer.send_binary(Viewer::call(99, 1, "{}")));
  EXPECT_EQ(viewer.wait_for("serviceCallFailure").value("message", ""), "there is no service 99");
  ASSERT_TRUE(viewer.send_binary(Viewer::call(3, 7, "no JSON")));
  const auto failure = viewer.wait_for("serviceCallFailure");
  EXPECT_EQ(failure.value("message", ""), "service call: accepted a JSON object");
  EXPECT_EQ(failure.value("serviceId", 0), 3);
  EXPECT_EQ(failure.value("callId", 0), 7);
  end();
}

TEST_F(DashboardTest, RefusesPagesOfOtherSitesAndNamesThatAreNotItsOwn) {
  begin(1'000'000, {"--allow-origin", "https://app.foxglove.dev"});
  const std::string own = "http://127.0.0.1:" + std::to_string(port_);
  EXPECT_EQ(WebSocket(port_, {"foxglove.sdk.v1", own, ""}).status, 101);
  EXPECT_EQ(WebSocket(port_, {"foxglove.websocket.v1", "", ""}).status, 101);
  EXPECT_EQ(WebSocket(port_, {"foxglove.sdk.v1", "http://evil.example", ""}).status, 403);
  EXPECT_EQ(WebSocket(port_, {"foxglove.sdk.v1", "null", ""}).status, 403);
  EXPECT_EQ(WebSocket(port_, {"foxglove.sdk.v1", "http://evil.example", "evil.example"}).status, 403)
      << "a name of another site that leads to this host";
  EXPECT_EQ(WebSocket(port_, {"chat", "", ""}).status, 400);
  Viewer watcher(port_, {"foxglove.sdk.v1", "https://app.foxglove.dev", ""});
  EXPECT_EQ(watcher.status, 101);
  ASSERT_TRUE(watcher.send_binary(Viewer::call(1, 5, "{}")));
  EXPECT_EQ(watcher.wait_for("serviceCallFailure").value("message", ""),
            "pages of other web sites may watch, but not command");
  Process wrong = command({"dashboard", "--port", "99999"});
  EXPECT_EQ(wrong.wait(20s), exit_status::kUsage);
  EXPECT_EQ(wrong.errors(),
            "dashboard: --port: found '99999', accepted a whole number from 0 to 65535 (see constrictor dashboard "
            "--help)\n");
  Process nowhere = command({"dashboard", "--address", "foo"});
  EXPECT_EQ(nowhere.wait(20s), exit_status::kUsage);
  EXPECT_NE(nowhere.errors().find("--address: found 'foo', accepted an IP address"), std::string::npos)
      << nowhere.errors();
  Process second = command({"dashboard", "--port", std::to_string(port_)});
  EXPECT_EQ(second.wait(20s), exit_status::kSoftware);
  EXPECT_NE(second.errors().find("choose another one with --port"), std::string::npos) << second.errors();
  end();
}

TEST_F(DashboardTest, ASlowViewerDelaysNobodyAndCostsBoundedMemory) {
  begin(1'000'000, {}, "8x");
  Viewer viewer(port_), slow(port_);
  const std::uint32_t channel = viewer.channel_of("joint_state");
  ASSERT_GT(channel, 0u);
  const long before_kib = memory_kib();
  // Many subscriptions make much data of one topic: about 500 times 1.6 KiB for each tick.
  for (std::uint32_t i = 0; i < 500; ++i) ASSERT_TRUE(slow.send_text(Viewer::subscribe(i, channel)));
  ASSERT_TRUE(viewer.send_text(Viewer::subscribe(1, channel)));
  std::size_t received = 0;
  while (received < 400) {
    const auto message = viewer.receive(5s);
    ASSERT_TRUE(message) << received;
    received += message->text ? 0 : 1;
  }
  EXPECT_LT(memory_kib() - before_kib, 64 << 10);
  end();
  EXPECT_NE(dashboard_->output().find("messages were dropped"), std::string::npos) << dashboard_->output();
}

TEST_F(DashboardTest, WhateverClientsSendItGoesOnServing) {
  begin(1'000'000);
  std::mt19937 random(20261122);
  const std::vector<std::string> good = {Viewer::subscribe(1, 1), R"({"op":"unsubscribe","subscriptionIds":[1]})",
                                         Viewer::call(1, 1, "{}"), "{}", std::string(1000, '[')};
  for (int round = 0; round < 40; ++round) {
    Viewer client(port_);
    ASSERT_EQ(client.status, 101) << round;
    for (int i = 0; i < 50; ++i) {
      std::string bytes = good[random() % good.size()];
      for (std::uint32_t changes = random() % 4; changes > 0; --changes)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      const bool open = random() % 8 == 0   ? client.send_raw(bytes)
                        : random() % 2 == 0 ? client.send_text(bytes)
                                            : client.send_binary(bytes);
      if (!open) break;
    }
  }
  for (int i = 0; i < 200; ++i) {
    const WebSocket hasty(port_, {"foxglove.sdk.v1", "", std::string(random() % 9000, 'x')});  // closed at once
  }
  Viewer viewer(port_);
  ASSERT_EQ(viewer.status, 101);
  ASSERT_TRUE(viewer.send_text(R"({"op":"fly"})"));
  EXPECT_NE(viewer.wait_for("status").value("message", "").find("found op 'fly'"), std::string::npos);
  EXPECT_TRUE(dashboard_->running());
  end();
}

}  // namespace
}  // namespace constrictor::testing
