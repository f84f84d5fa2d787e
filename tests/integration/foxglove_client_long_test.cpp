// Parameters as npm's @foxglove/ws-protocol, the client of Foxglove's viewers, sees them: of a run, and of a recording.
// Needs npm and the internet.
#include <fstream>

#include "integration/dashboard_run.hpp"
#include "support/npm_packages.hpp"
#include "support/project.hpp"

namespace constrictor::testing {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const std::string kName = "navigation.travel.speed_m_s";

class FoxgloveClient : public DashboardRun, public ::testing::WithParamInterface<const char*> {
 protected:
  static void SetUpTestSuite() {
    install_npm_packages(source_path("tests/integration/node"), {"package.json", "foxglove_client.mjs"}, folder());
  }
  [[nodiscard]] std::vector<std::string> run_options() const override { return {"--record"}; }
  static fs::path folder() { return build_path("foxglove_client"); }
  /// The official client, which calls these methods as soon as it is connected.
  [[nodiscard]] Process client(const json& calls) const {
    return Process(
        {"node", (folder() / "foxglove_client.mjs").string(), std::to_string(port_), GetParam(), calls.dump()});
  }
  /// The next message that the client has printed and for which `wanted` is true; null: none comes.
  static json next(Process& client, std::size_t& read, const std::function<bool(const json&)>& wanted) {
    json found;
    const bool good = eventually([&] {
      std::istringstream lines(client.output());
      std::string line;
      for (std::size_t i = 0; std::getline(lines, line) && !lines.eof(); ++i) {
        if (i < read) continue;
        const json message = json::parse(line, nullptr, false);
        read = i + 1;
        if (!wanted(message)) continue;
        found = message;
        return true;
      }
      return false;
    });
    EXPECT_TRUE(good) << client.output() << client.errors();
    return found;
  }
  static std::function<bool(const json&)> values(const std::string& name, double value) {
    return [=](const json& message) {
      for (const auto& parameter : message.value("parameters", json::array()))
        if (parameter.at("name") == name) return parameter.at("value") == value;
      return false;
    };
  }
  static bool is_status(const json& message) { return message.value("op", "") == "status"; }
  /// Waits until the dashboard knows the parameters of the run or the recording.
  void expect_parameters() const {
    Viewer viewer(port_);
    ASSERT_TRUE(eventually([&] {
      viewer.send_text(R"({"op":"getParameters","parameterNames":[]})");
      return viewer.wait_for("parameterValues").at("parameters").size() > 20;
    }));
  }
};

TEST_P(FoxgloveClient, ReadsChangesAndFollowsTheParametersOfARun) {
  expect_parameters();
  Process viewer = client({{"getParameters", json::array(), "all"},
                           {"subscribeParameterUpdates", {kName}},
                           {"setParameters", {{{"name", kName}, {"value", 900}}}, "refused"},
                           {"setParameters", {{{"name", kName}, {"value", 0.9}}}, "accepted"}});
  std::size_t read = 0;
  const json info = next(viewer, read, [](const json& m) { return m.value("op", "") == "serverInfo"; });
  EXPECT_EQ(info.at("subprotocol"), GetParam());
  const json all = next(viewer, read, [](const json& m) { return m.value("id", "") == "all"; });
  ASSERT_GT(all.at("parameters").size(), 20u);
  const json refusal = next(viewer, read, is_status);
  EXPECT_TRUE(refusal.at("message").get<std::string>().starts_with(kName + ": ")) << refusal;
  const json kept = next(viewer, read, [](const json& m) { return m.value("id", "") == "refused"; });
  EXPECT_TRUE(values(kName, 0.9)(kept) == false && kept.at("parameters").size() == 1) << kept;
  const json changed = next(viewer, read, [](const json& m) { return m.value("id", "") == "accepted"; });
  EXPECT_TRUE(values(kName, 0.9)(changed)) << changed;
  ASSERT_EQ(command({"param", "set", kName, "0.8"}), 0) << output_;
  EXPECT_FALSE(next(viewer, read, values(kName, 0.8)).contains("id")) << "an update, not an answer";
}

TEST_P(FoxgloveClient, ReadsAndFollowsTheParametersOfARecordingButCannotChangeThem) {
  expect_parameters();
  ASSERT_EQ(command({"param", "set", kName, "0.9"}), 0) << output_;
  watch_recording();
  expect_parameters();
  Process viewer =
      client({{"subscribeParameterUpdates", {kName}}, {"setParameters", {{{"name", kName}, {"value", 0.8}}}, "set"}});
  std::size_t read = 0;
  EXPECT_EQ(next(viewer, read, is_status).at("message"), kName + ": a recording cannot be changed");
  const json kept = next(viewer, read, [](const json& m) { return m.value("id", "") == "set"; });
  ASSERT_EQ(kept.at("parameters").size(), 1u);
  EXPECT_FALSE(values(kName, 0.8)(kept) || values(kName, 0.9)(kept)) << "the value at the begin: " << kept;
  Viewer page(port_);
  EXPECT_TRUE(page.ask("pace", R"({"pace":0})").starts_with("paused"));
  EXPECT_TRUE(page.ask("resume", "{}").starts_with("playing"));
  next(viewer, read, values(kName, 0.9));
}

INSTANTIATE_TEST_SUITE_P(, FoxgloveClient, ::testing::Values("foxglove.sdk.v1", "foxglove.websocket.v1"),
                         [](const auto& test) { return std::string(test.param).substr(9, 3); });

}  // namespace
}  // namespace constrictor::testing
