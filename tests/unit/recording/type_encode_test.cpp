// Encodes samples from JSON by the description of their type. The bytes must equal those of cdr_of(), which
// message_cdr_test.cpp compares with Cyclone's encoder. Values that the IDL does not accept must be refused.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/type_node.hpp"
#include "cyclone/type_tree.hpp"
#include "recording/message_cdr.hpp"
#include "unit/idl/random_message.hpp"

namespace constrictor::dds {
namespace {

using Json = nlohmann::ordered_json;

class TypeEncode : public ::testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<dds::TypeTree> tree(const std::string& type) const {
    return dds::TypeTree::known(domain_.participant(), "constrictor::msg::" + type);
  }
  /// The message that `json` becomes; fails if it is not exactly one.
  template <class T>
  [[nodiscard]] std::shared_ptr<const T> made(const char* json) const {
    const auto bytes = tree(Description<T>::kName)->encode(Json::parse(json));
    return message_of<T>(mcap::bytes_of(std::string(bytes.begin(), bytes.end())));
  }
  /// Why `json` is refused.
  [[nodiscard]] std::string refusal(const std::string& type, const char* json) const {
    try {
      static_cast<void>(tree(type)->encode(Json::parse(json)));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  }
  const DomainClaim claim_;
  const dds::Domain domain_{claim_.domain()};
};

TEST_F(TypeEncode, WhatWasDecodedBecomesTheSameBytesForEachType) {
  std::set<std::string> seen;
  const auto same = [&]<class T>() {
    if (!seen.insert(Description<T>::kName).second) return;
    const auto type = tree(Description<T>::kName);
    ASSERT_TRUE(type) << Description<T>::kName;
    testing::RandomFiller filler(29);
    for (int i = 0; i < 20; ++i) {
      T message{};
      Description<T>::visit(message, filler);
      const std::string cdr = cdr_of(message);
      const auto json = type->decode({reinterpret_cast<const std::uint8_t*>(cdr.data()), cdr.size()});
      const auto bytes = type->encode(json);
      ASSERT_EQ(std::string(bytes.begin(), bytes.end()), cdr) << Description<T>::kName << " " << json;
    }
  };
#define CONSTRICTOR_MEMBER_TOPIC(constant, Type, ...) same.template operator()<msg::Type>();
#define CONSTRICTOR_UNCOUNTED_TOPIC(constant, Type, ...) same.template operator()<msg::Type>();
#include "constrictor/topic_table.def"
#undef CONSTRICTOR_MEMBER_TOPIC
#undef CONSTRICTOR_UNCOUNTED_TOPIC
  EXPECT_GT(seen.size(), 30u);
}

TEST_F(TypeEncode, LeftOutFieldsAreZeroAndNamesAndShortListsAreAccepted) {
  const auto request = made<msg::Request>(
      R"({"source": "me.1", "kind": "task", "task": "follow_path", "level": "external", "parameters":
          {"line_colour": "blue", "timeout_s": null}, "path": {"x_m": [0, 1.5], "y_m": [0, -0.5]}})");
  ASSERT_TRUE(request);
  EXPECT_STREQ(request->source, "me.1");
  EXPECT_EQ(request->task, msg::kTaskFollowPath);
  EXPECT_EQ(request->level, msg::kAuthorityExternal);
  EXPECT_EQ(request->parameters.line_colour, msg::kColourBlue);
  EXPECT_TRUE(std::isnan(request->parameters.timeout_s));
  EXPECT_EQ(request->path.point_count, 2);
  EXPECT_EQ(request->path.x_m[1], 1.5);
  EXPECT_EQ(request->path.y_m[1], -0.5);
  EXPECT_EQ(request->path.x_m[2], 0.0);
  EXPECT_EQ(request->header.tick, 0);
}

TEST_F(TypeEncode, BytesMayBeABinaryValue) {
  Json image = {{"width", 1}, {"height", 2}, {"data", Json::binary({1, 2, 3, 4, 5, 255})}};
  const auto bytes = tree("CameraImage")->encode(image);
  const auto message = message_of<msg::CameraImage>(mcap::bytes_of(std::string(bytes.begin(), bytes.end())));
  ASSERT_TRUE(message);
  ASSERT_EQ(message->data._length, 6u);
  EXPECT_EQ(message->data._buffer[5], 255);
}

TEST_F(TypeEncode, RefusalsNameTheFieldWhatWasFoundAndWhatIsAccepted) {
  EXPECT_EQ(refusal("RunControl", R"({"pase": 2})").substr(0, 40), "message: there is no field 'pase'; accep");
  EXPECT_TRUE(refusal("JointState", R"({"joint_cout": 2})").ends_with(", did you mean 'joint_count'?"));
  EXPECT_EQ(refusal("Request", R"({"level": "operatr"})"),
            "level: found \"operatr\", accepted planner, external, operator, did you mean 'operator'?");
  EXPECT_EQ(refusal("Request", R"({"level": 1, "task": "fly"})"),
            "task: found \"fly\", accepted none, follow_line, search_object, track_object, pregrasp, grasp, drop, "
            "rotate, explore, follow_path");
  EXPECT_EQ(refusal("Request", R"({})"), "level: found nothing, accepted planner, external, operator");
  EXPECT_EQ(refusal("Request", R"({"level": 4})"), "level: found 4, accepted planner, external, operator");
  EXPECT_EQ(refusal("Request", R"({"level": "none"})"), "level: found \"none\", accepted planner, external, operator");
  EXPECT_EQ(refusal("Request", R"({"level": 2.5})"), "level: found 2.5, accepted planner, external, operator");
  EXPECT_EQ(refusal("Request", R"({"level": 2, "robot_id": 65536})"),
            "robot_id: found 65536, accepted a whole number from 0 to 65535");
  EXPECT_EQ(refusal("Request", R"({"level": 2, "robot_id": -1})"),
            "robot_id: found -1, accepted a whole number from 0 to 65535");
  EXPECT_EQ(refusal("Request", R"({"level": 2, "path": {"point_count": 65}})"),
            "path.point_count: found 65, accepted a whole number from 0 to 64");
  EXPECT_EQ(refusal("Request", R"({"level": 2, "parameters": {"timeout_s": "soon"}})"),
            "parameters.timeout_s: found \"soon\", accepted a number, or null for NaN");
  EXPECT_EQ(refusal("JointState", R"({"position_rad": [0, null]})"),
            "position_rad[1]: found null, accepted a finite number");
  EXPECT_EQ(refusal("Request", R"({"level": 2, "detached": 1})"), "detached: found 1, accepted true or false");
  EXPECT_EQ(refusal("Request", R"({"level": 2, "source": "a name that is much longer than 31 bytes"})"),
            "source: found \"a name that is much longer than 31 byte..., accepted a text of at most 31 bytes");
  EXPECT_EQ(refusal("Request", R"([1])"), "message: found [1], accepted an object with fields");
}

TEST(TypeEncodeForeign, ArraysOfOtherTypesNeedAllTheirElementsAndUnionsAreNotWritten) {
  const auto number = std::make_shared<dds::TypeNode>();
  number->primitive = 10;  // DDS_XTypes_TK_FLOAT64
  const auto array = std::make_shared<dds::TypeNode>();
  array->kind = dds::TypeNode::Kind::kArray;
  array->element = number;
  array->bounds = {2, 2};
  dds::TypeNode type;
  type.kind = dds::TypeNode::Kind::kStruct;
  type.name = "weather";
  type.members = {{"grid", 0, false, false, {}, array}};
  EXPECT_EQ(dds::decode(type, dds::encode(type, Json::parse(R"({"grid": [[1, 2], [3, 4.5]]})"))).dump(),
            R"({"grid":[[1.0,2.0],[3.0,4.5]]})");
  EXPECT_THROW(static_cast<void>(dds::encode(type, Json::parse(R"({"grid": [[1, 2]]})"))), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(dds::encode(type, Json::parse(R"({"grid": [[1, 2], [3]]})"))), std::invalid_argument);
  type.kind = dds::TypeNode::Kind::kUnion;
  EXPECT_THROW(static_cast<void>(dds::encode(type, Json::object())), std::invalid_argument);
}

}  // namespace
}  // namespace constrictor::dds
