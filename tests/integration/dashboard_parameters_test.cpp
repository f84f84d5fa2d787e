// Parameters by the Foxglove WebSocket protocol: viewers read, change and follow those of a run.
#include "integration/dashboard_run.hpp"

namespace constrictor::testing {
namespace {

using nlohmann::json;

const std::string kName = "navigation.travel.speed_m_s";
const std::string kChoice = "control.motion.travel.method";

class DashboardParameters : public DashboardRun {
 protected:
  void SetUp() override {
    DashboardRun::SetUp();
    Viewer viewer(port_);
    ASSERT_TRUE(eventually([&] {
      return ask(viewer, {{"op", "getParameters"}, {"parameterNames", {kName, kChoice}}, {"id", "1"}})
                 .at("parameters")
                 .size() == 2;
    })) << "the components have not announced their parameters";
  }
  /// Sends a message and returns the next parameterValues.
  static json ask(Viewer& viewer, const json& message) {
    EXPECT_TRUE(viewer.send_text(message.dump()));
    return viewer.wait_for("parameterValues");
  }
  static json set(Viewer& viewer, const std::string& name, const json& value, const std::string& id = "set") {
    return ask(viewer, {{"op", "setParameters"}, {"parameters", {{{"name", name}, {"value", value}}}}, {"id", id}});
  }
  /// The value of a parameter in a message; null: it is not there.
  static json value_in(const json& message, const std::string& name) {
    if (message.is_null()) return nullptr;
    for (const auto& parameter : message.at("parameters")) {
      if (parameter.at("name") == name) return parameter.at("value");
    }
    return nullptr;
  }
  /// What `constrictor param get --json` says.
  json by_command(const std::string& name) {
    EXPECT_EQ(command({"param", "get", name, "--json"}), 0) << output_;
    json printed = json::parse(output_, nullptr, false);
    if (printed.is_array() && !printed.empty()) printed = printed.front();
    return printed.is_object() ? printed.value("value", json()) : json();
  }
};

TEST_F(DashboardParameters, AreThoseOfTheCommandWithTheSameValues) {
  Viewer viewer(port_);
  const json info = viewer.wait_for("serverInfo");
  for (const char* capability : {"parameters", "parametersSubscribe"}) {
    const json& offered = info.at("capabilities");
    EXPECT_NE(std::find(offered.begin(), offered.end(), capability), offered.end()) << capability;
  }
  const json all = ask(viewer, {{"op", "getParameters"}, {"parameterNames", json::array()}, {"id", "all"}});
  EXPECT_EQ(all.at("id"), "all");
  ASSERT_EQ(command({"param", "list", "--json"}), 0) << output_;
  const json listed = json::parse(output_);
  ASSERT_GT(listed.size(), 20u);
  EXPECT_EQ(all.at("parameters").size(), listed.size());
  for (const auto& parameter : listed) EXPECT_EQ(value_in(all, parameter.at("name")), parameter.at("value"));
  EXPECT_EQ(value_in(all, kChoice), "undulation") << "a value with a name is its name";
  std::map<std::string, std::string> types;
  for (const auto& parameter : all.at("parameters")) types[parameter.at("name")] = parameter.value("type", "none");
  EXPECT_EQ(types[kName], "float64");
  EXPECT_EQ(types[kChoice], "none");
  ASSERT_TRUE(viewer.send_text(R"({"op":"getParameters","parameterNames":["a.b"]})"));
  const json status = viewer.wait_for("status");
  EXPECT_EQ(status.at("level"), 1);
  EXPECT_NE(status.at("message").get<std::string>().find("a.b"), std::string::npos) << status;
  const json none = viewer.wait_for("parameterValues");
  EXPECT_TRUE(none.at("parameters").empty());
  EXPECT_FALSE(none.contains("id"));
}

TEST_F(DashboardParameters, AreChangedOrRefusedWithTheReasonAndTheTrueValue) {
  Viewer viewer(port_);
  const json before = by_command(kName);
  ASSERT_NE(before, 0.9);
  const json accepted = set(viewer, kName, 0.9, "mine");
  EXPECT_EQ(accepted.at("id"), "mine");
  EXPECT_EQ(value_in(accepted, kName), 0.9);
  EXPECT_TRUE(eventually([&] { return by_command(kName) == 0.9; }));
  EXPECT_EQ(value_in(set(viewer, kChoice, "rolling"), kChoice), "rolling");
  EXPECT_TRUE(eventually([&] { return by_command(kChoice) == "rolling"; }));

  const auto expect_refused = [&](const std::string& name, const json& value, const std::string& reason,
                                  const json& true_value) {
    // Without an id, too: viewers show what their user has written.
    ASSERT_TRUE(
        viewer.send_text(json{{"op", "setParameters"}, {"parameters", {{{"name", name}, {"value", value}}}}}.dump()));
    const json status = viewer.wait_for("status");
    EXPECT_EQ(status.at("level"), 2);
    const std::string message = status.at("message");
    EXPECT_TRUE(message.starts_with(name + ": ")) << message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
    const json values = viewer.wait_for("parameterValues");
    EXPECT_EQ(value_in(values, name), true_value) << values;
  };
  expect_refused(kName, 900, "accepted", 0.9);
  expect_refused(kName, true, "found true, accepted ", 0.9);
  expect_refused(kName, nullptr, "found null, accepted ", 0.9);
  expect_refused(kName, "fast", "found \"fast\", accepted ", 0.9);
  expect_refused(kChoice, "walking", "accepted one of undulation", "rolling");
  expect_refused("navigation.nothing", 1, "there is no such parameter", nullptr);
  expect_refused("navigation.travel.speeed_m_s", 1, "did you mean 'navigation.travel.speed_m_s'?", nullptr);

  const json both = ask(viewer, {{"op", "setParameters"},
                                 {"parameters", {{{"name", kName}, {"value", 900}}, {{"name", kChoice}, {"value", 0}}}},
                                 {"id", "both"}});
  EXPECT_EQ(value_in(both, kName), 0.9) << "one refusal does not refuse the rest";
  EXPECT_EQ(value_in(both, kChoice), "undulation") << "a number is accepted for a name, as by `param set`";
}

TEST_F(DashboardParameters, ReachViewersThatHaveSubscribedWhoeverChangesThem) {
  Viewer follower(port_), other(port_), everything(port_);
  const std::string second = "navigation.follow_line.steering.kp";
  const auto subscription = [](const char* op, const json& names) {
    return json{{"op", op}, {"parameterNames", names}}.dump();
  };
  ASSERT_TRUE(follower.send_text(subscription("subscribeParameterUpdates", {kName})));
  ASSERT_TRUE(everything.send_text(subscription("subscribeParameterUpdates", json::array())));
  ASSERT_EQ(value_in(set(follower, second, 5.5), second), 5.5);  // the subscription was obeyed before
  EXPECT_EQ(value_in(everything.wait_for("parameterValues"), second), 5.5);
  ASSERT_EQ(command({"param", "set", kName, "0.85"}), 0) << output_;
  EXPECT_EQ(value_in(follower.wait_for("parameterValues"), kName), 0.85) << "and nothing about the other parameter";
  EXPECT_EQ(value_in(everything.wait_for("parameterValues"), kName), 0.85);
  EXPECT_EQ(value_in(set(other, kName, 0.8), kName), 0.8);
  EXPECT_EQ(value_in(follower.wait_for("parameterValues"), kName), 0.8);
  // What waits for its tick counts, too; a reset brings the defaults back.
  ASSERT_EQ(command({"param", "set", kName, "0.75", "--at-tick", "1000000"}), 0) << output_;
  EXPECT_EQ(value_in(follower.wait_for("parameterValues"), kName), 0.75);
  ASSERT_TRUE(follower.send_text(subscription("unsubscribeParameterUpdates", json::array())));
  ASSERT_EQ(value_in(set(follower, kName, 0.95), kName), 0.95);
  ASSERT_EQ(command({"param", "set", kName, "0.7"}), 0) << output_;
  EXPECT_EQ(value_in(set(follower, second, 4.0), second), 4.0) << "the next message is this answer";
}

TEST_F(DashboardParameters, APageOfAnotherSiteMayReadButNotChangeThem) {
  dashboard_->signal(SIGTERM);
  ASSERT_TRUE(dashboard_->wait(20s));
  watch({"--allow-origin", "https://app.foxglove.dev"});
  Viewer page(port_, {"foxglove.websocket.v1", "https://app.foxglove.dev", ""});
  json before;
  ASSERT_TRUE(eventually([&] {
    before = value_in(ask(page, {{"op", "getParameters"}, {"parameterNames", {kName}}}), kName);
    return !before.is_null();
  }));
  ASSERT_TRUE(page.send_text(
      json{{"op", "setParameters"}, {"parameters", {{{"name", kName}, {"value", 0.9}}}}, {"id", "x"}}.dump()));
  EXPECT_NE(page.wait_for("status").at("message").get<std::string>().find("may watch, but not command"),
            std::string::npos);
  EXPECT_EQ(value_in(page.wait_for("parameterValues"), kName), before);
  EXPECT_EQ(by_command(kName), before);
}

class RecordedParameters : public DashboardParameters {
 protected:
  [[nodiscard]] std::vector<std::string> run_options() const override { return {"--record"}; }
};

TEST_F(RecordedParameters, AreShownAsTheyWereAndCannotBeChanged) {
  ASSERT_EQ(command({"param", "set", kName, "0.9"}), 0) << output_;
  watch_recording();
  Viewer viewer(port_), follower(port_);
  json before;
  const json get = {{"op", "getParameters"}, {"parameterNames", {kName}}};
  ASSERT_TRUE(eventually([&] { return !(before = value_in(ask(viewer, get), kName)).is_null(); }));
  EXPECT_NE(before, 0.9) << "the recording stands near its begin";
  ASSERT_TRUE(follower.send_text(json{{"op", "subscribeParameterUpdates"}, {"parameterNames", {kName}}}.dump()));
  EXPECT_EQ(value_in(set(follower, kName, 0.8), kName), before);
  Viewer page(port_);
  EXPECT_TRUE(page.ask("pace", R"({"pace":0})").starts_with("paused"));
  EXPECT_TRUE(page.ask("resume", "{}").starts_with("playing"));
  EXPECT_EQ(value_in(follower.wait_for("parameterValues"), kName), 0.9);
  Viewer refused(port_);
  set(refused, kName, 0.8);
  ASSERT_TRUE(
      refused.send_text(json{{"op", "setParameters"}, {"parameters", {{{"name", kName}, {"value", 1}}}}}.dump()));
  EXPECT_EQ(refused.wait_for("status").at("message"), kName + ": a recording cannot be changed");
}

}  // namespace
}  // namespace constrictor::testing
