// The Foxglove WebSocket protocol: frames against bytes that follow from its specification, and whatever clients send.
#include "dashboard/protocol.hpp"

#include <gtest/gtest.h>

#include <random>

#include "dashboard/viewer_parameters.hpp"

namespace constrictor::dashboard {
namespace {

using namespace std::string_literals;

// Source: https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md, tables of the binary messages.
TEST(Frames, HaveTheBytesOfTheSpecification) {
  EXPECT_EQ(message_data(0x01020304, 0x1112131415161718, "ab"),
            "\x01\x04\x03\x02\x01\x18\x17\x16\x15\x14\x13\x12\x11"s + "ab");
  EXPECT_EQ(service_response(7, 9, "{}"), "\x03\x07\0\0\0\x09\0\0\0\x04\0\0\0json{}"s);
  const Parsed call = parse_frame("\x02\x05\0\0\0\x06\0\0\0\x04\0\0\0json{\"ticks\":3}"s);
  ASSERT_EQ(call.refusal, "");
  const auto& action = std::get<ServiceCall>(call.actions.at(0));
  EXPECT_EQ(action.service, 5u);
  EXPECT_EQ(action.call, 6u);
  EXPECT_EQ(action.request.at("ticks"), 3);
}

TEST(Texts, OfTheServerHaveTheFieldsOfTheSpecification) {
  const auto info = nlohmann::json::parse(server_info("run 1", "s"));
  EXPECT_EQ(info.at("op"), "serverInfo");
  EXPECT_EQ(info.at("capabilities"), nlohmann::json::array({"services", "parameters", "parametersSubscribe"}));
  const auto channels = nlohmann::json::parse(advertise({{3, "t", "cdr", "a/msg/B", "int32 x", "ros2msg"}}));
  EXPECT_EQ(channels.at("op"), "advertise");
  EXPECT_EQ(channels.at("channels").at(0).at("schemaName"), "a/msg/B");
  const auto services = nlohmann::json::parse(advertise_services({{1, "pause"}}));
  EXPECT_EQ(services.at("services").at(0).at("name"), "pause");
  EXPECT_EQ(nlohmann::json::parse(status(2, "\xff")).at("level"), 2) << "text that is not UTF-8 is replaced";
}

TEST(Texts, OfRefusalsNameTheirObjectOnce) {
  EXPECT_EQ(named("task", "found 'fly'"), "task: found 'fly'");
  EXPECT_EQ(named("task", "task: found 'fly'"), "task: found 'fly'");
  EXPECT_EQ(named("task", "tasks: none"), "task: tasks: none");
}

TEST(Texts, OfClientsAreCheckedFieldByField) {
  const Parsed good =
      parse_text(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2},{"id":3,"channelId":4}]})");
  EXPECT_EQ(good.refusal, "");
  ASSERT_EQ(good.actions.size(), 2u);
  EXPECT_EQ(std::get<Subscribe>(good.actions[1]).channel, 4u);
  EXPECT_EQ(
      std::get<Unsubscribe>(parse_text(R"({"op":"unsubscribe","subscriptionIds":[8]})").actions.at(0)).subscription,
      8u);
  for (const char* wrong : {"", "[]", "{}", R"({"op":3})", R"({"op":"fly"})", R"({"op":"subscribe"})",
                            R"({"op":"subscribe","subscriptions":{}})", R"({"op":"subscribe","subscriptions":[3]})",
                            R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":2}]})",
                            R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":2}]})",
                            R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":2}]})",
                            R"({"op":"unsubscribe","subscriptionIds":["1"]})"}) {
    const Parsed parsed = parse_text(wrong);
    EXPECT_NE(parsed.refusal, "") << wrong;
    EXPECT_TRUE(parsed.actions.empty()) << wrong;
  }
}

// Source: as above, the messages about parameters.
TEST(Texts, AboutParametersHaveTheFieldsOfTheSpecification) {
  const auto values = nlohmann::json::parse(
      parameter_values({{"a", 2}, {"b", 3.0, true}, {"c", "foo"}, {"d", "foo", true}}, "request-123"));
  EXPECT_EQ(values, nlohmann::json::parse(R"({"op":"parameterValues","parameters":[{"name":"a","value":2},
      {"name":"b","value":3.0,"type":"float64"},{"name":"c","value":"foo"},{"name":"d","value":"foo"}],
      "id":"request-123"})"));
  EXPECT_FALSE(nlohmann::json::parse(parameter_values({}, "")).contains("id"));
  const Parsed get = parse_text(R"({"op":"getParameters","parameterNames":["a","b"],"id":"7"})");
  EXPECT_EQ(std::get<GetParameters>(get.actions.at(0)).names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(std::get<GetParameters>(get.actions.at(0)).id, "7");
  const Parsed set = parse_text(R"({"op":"setParameters","parameters":[{"name":"a","value":[1]},{"name":"b"}]})");
  EXPECT_EQ(std::get<SetParameters>(set.actions.at(0)).values, (std::vector<ParameterValue>{{"a", {1}}, {"b", {}}}));
  EXPECT_EQ(std::get<SetParameters>(set.actions.at(0)).id, "");
  const Parsed on = parse_text(R"({"op":"subscribeParameterUpdates","parameterNames":[]})");
  EXPECT_TRUE(std::get<SubscribeParameters>(on.actions.at(0)).names.empty());
  const Parsed off = parse_text(R"({"op":"unsubscribeParameterUpdates","parameterNames":["a"]})");
  EXPECT_EQ(std::get<UnsubscribeParameters>(off.actions.at(0)).names.at(0), "a");
  for (const std::string& wrong :
       {R"({"op":"getParameters"})"s, R"({"op":"getParameters","parameterNames":"a"})"s,
        R"({"op":"getParameters","parameterNames":[1]})"s, R"({"op":"getParameters","parameterNames":[],"id":3})"s,
        R"({"op":"setParameters","parameters":[3]})"s, R"({"op":"setParameters","parameters":[{"value":3}]})"s,
        R"({"op":"setParameters","parameters":[{"name":3,"value":3}]})"s,
        R"({"op":"subscribeParameterUpdates","parameterNames":{}})"s,
        R"({"op":"getParameters","parameterNames":[")" + std::string(201, 'a') + R"("]})"}) {
    EXPECT_NE(parse_text(wrong).refusal, "") << wrong;
    EXPECT_TRUE(parse_text(wrong).actions.empty()) << wrong;
  }
}

TEST(ViewerParameters, ReceiveChangesThatTheyDoNotKnow) {
  ParameterMap present = {{"a", {"a", 1}}, {"b", {"b", 2}}};
  ViewerParameters viewer;
  EXPECT_TRUE(viewer.news(present).empty()) << "nothing is subscribed";
  viewer.subscribe({"a", "later"}, present);
  EXPECT_TRUE(viewer.news(present).empty()) << "the viewer knows the values at that time";
  present["a"].value = 3;
  present["b"].value = 4;
  present["later"] = {"later", 5};
  EXPECT_EQ(viewer.news(present), (std::vector<ParameterValue>{{"a", 3}, {"later", 5}}));
  EXPECT_TRUE(viewer.news(present).empty());
  viewer.sent({{"a", 6}});
  EXPECT_EQ(viewer.news(present), (std::vector<ParameterValue>{{"a", 3}})) << "the change did not come into force";
  viewer.subscribe({}, present);
  EXPECT_TRUE(viewer.news(present).empty());
  viewer.unsubscribe({"b"});
  present["b"].value = 7;
  present["new"] = {"new", 8};
  EXPECT_EQ(viewer.news(present), (std::vector<ParameterValue>{{"new", 8}})) << "all but b";
  viewer.subscribe({"b"}, present);
  present["b"].value = 9;
  EXPECT_EQ(viewer.news(present), (std::vector<ParameterValue>{{"b", 9}}));
  viewer.unsubscribe({});
  present["a"].value = 10;
  EXPECT_TRUE(viewer.news(present).empty());
}

TEST(Frames, OfClientsThatAreDamagedAreRefused) {
  const std::string good = "\x02\x05\0\0\0\x06\0\0\0\x04\0\0\0json{\"ticks\":3}"s;
  for (std::size_t size = 0; size < 17; ++size) EXPECT_NE(parse_frame(good.substr(0, size)).refusal, "") << size;
  EXPECT_EQ(parse_frame(good.substr(0, 17)).refusal, "") << "an empty request";
  EXPECT_NE(parse_frame("\x01" + good.substr(1)).refusal, "");
  EXPECT_FALSE(parse_frame(good.substr(0, 8)).failed_call) << "the call is not known";
  for (const std::string& wrong : {good.substr(0, 9), good.substr(0, 16), good.substr(0, 20), good.substr(0, 17) + "3",
                                   good.substr(0, 13) + "cbor{}", good.substr(0, 17) + "no JSON"}) {
    const Parsed parsed = parse_frame(wrong);
    EXPECT_NE(parsed.refusal, "") << wrong;
    ASSERT_TRUE(parsed.failed_call) << wrong;
    EXPECT_EQ(parsed.failed_call->service, 5u);
    EXPECT_EQ(parsed.failed_call->call, 6u);
  }
  std::mt19937 random(20261122);
  std::size_t accepted = 0;
  for (int i = 0; i < 100'000; ++i) {
    std::string bytes = good;
    for (std::uint32_t changes = 1 + random() % 4; changes > 0; --changes)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    const Parsed parsed = parse_frame(bytes);
    EXPECT_NE(parsed.refusal.empty(), parsed.actions.empty());
    accepted += parsed.actions.size();
    static_cast<void>(parse_text(bytes));
  }
  EXPECT_GT(accepted, 0u) << "changes of the numbers alone are accepted";
}

}  // namespace
}  // namespace constrictor::dashboard
