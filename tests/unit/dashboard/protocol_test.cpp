// The Foxglove WebSocket protocol: frames against bytes that follow from its specification, and whatever clients send.
#include "dashboard/protocol.hpp"

#include <gtest/gtest.h>

#include <random>

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
  EXPECT_EQ(info.at("capabilities"), nlohmann::json::array({"services"}));
  const auto channels = nlohmann::json::parse(advertise({{3, "t", "cdr", "a/msg/B", "int32 x", "ros2msg"}}));
  EXPECT_EQ(channels.at("op"), "advertise");
  EXPECT_EQ(channels.at("channels").at(0).at("schemaName"), "a/msg/B");
  const auto services = nlohmann::json::parse(advertise_services({{1, "pause"}}));
  EXPECT_EQ(services.at("services").at(0).at("name"), "pause");
  EXPECT_EQ(nlohmann::json::parse(status(2, "\xff")).at("level"), 2) << "text that is not UTF-8 is replaced";
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

TEST(Frames, OfClientsThatAreDamagedAreRefused) {
  const std::string good = "\x02\x05\0\0\0\x06\0\0\0\x04\0\0\0json{\"ticks\":3}"s;
  for (std::size_t size = 0; size < 17; ++size) EXPECT_NE(parse_frame(good.substr(0, size)).refusal, "") << size;
  EXPECT_EQ(parse_frame(good.substr(0, 17)).refusal, "") << "an empty request";
  EXPECT_NE(parse_frame("\x01" + good.substr(1)).refusal, "");
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
