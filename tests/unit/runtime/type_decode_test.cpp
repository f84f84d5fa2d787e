// Samples are decoded by the description of their type. The bytes are written by hand from the standard (OMG DDS-XTypes
// 1.3, section 7.4).
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>

#include "cyclone/type_node.hpp"

namespace constrictor::dds {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Kind = TypeNode::Kind;
using Node = std::shared_ptr<const TypeNode>;

// DDS_XTypes_TK_...
constexpr std::uint8_t kBoolean = 1;
constexpr std::uint8_t kByte = 2;
constexpr std::uint8_t kInt32 = 4;
constexpr std::uint8_t kUint16 = 6;
constexpr std::uint8_t kFloat64 = 10;

Node primitive(std::uint8_t kind) {
  TypeNode node;
  node.primitive = kind;
  return std::make_shared<TypeNode>(node);
}
Node of_kind(Kind kind, Node element = nullptr, std::vector<std::uint32_t> bounds = {}) {
  TypeNode node;
  node.kind = kind;
  node.element = std::move(element);
  node.bounds = std::move(bounds);
  return std::make_shared<TypeNode>(node);
}
TypeNode structure(const std::vector<std::pair<std::string, Node>>& members,
                   TypeNode::Extensibility extensibility = TypeNode::Extensibility::kFinal) {
  TypeNode node;
  node.kind = Kind::kStruct;
  node.extensibility = extensibility;
  for (const auto& [name, type] : members) {
    TypeNode::Member member;
    member.name = name;
    member.id = static_cast<std::uint32_t>(node.members.size());
    member.type = type;
    node.members.push_back(member);
  }
  return node;
}
/// { octet a; double b; string s; sequence<long> n; }
TypeNode mixed() {
  return structure({{"a", primitive(kByte)},
                    {"b", primitive(kFloat64)},
                    {"s", of_kind(Kind::kString)},
                    {"n", of_kind(Kind::kSequence, primitive(kInt32))}});
}
const Bytes kMixedXcdr1 = {0,
                           1,
                           0,
                           0,
                           /* a */ 7,
                           0,
                           0,
                           0,
                           0,
                           0,
                           0,
                           0,
                           /* b = 1.5 */ 0,
                           0,
                           0,
                           0,
                           0,
                           0,
                           0xf8,
                           0x3f,
                           /* s */ 3,
                           0,
                           0,
                           0,
                           'h',
                           'i',
                           0,
                           /* padding */ 0,
                           /* n */ 2,
                           0,
                           0,
                           0,
                           1,
                           0,
                           0,
                           0,
                           0xff,
                           0xff,
                           0xff,
                           0xff};
const std::string kMixed = R"({"a":7,"b":1.5,"s":"hi","n":[1,-1]})";

TEST(TypeDecode, ReadsXcdr1InEitherByteOrder) {
  EXPECT_EQ(decode(mixed(), kMixedXcdr1).dump(), kMixed);
  const Bytes big = {0, 0, 0, 0, 7,   0,   0, 0, 0, 0, 0, 0, 0x3f, 0xf8, 0, 0, 0,    0,    0,    0,
                     0, 0, 0, 3, 'h', 'i', 0, 0, 0, 0, 0, 2, 0,    0,    0, 1, 0xff, 0xff, 0xff, 0xff};
  EXPECT_EQ(decode(mixed(), big).dump(), kMixed);
}

TEST(TypeDecode, AlignsEightByteNumbersToFourInXcdr2) {
  const Bytes bytes = {0, 7, 0,   0,   7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xf8, 0x3f, 3,    0,
                       0, 0, 'h', 'i', 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 0xff, 0xff, 0xff, 0xff};
  EXPECT_EQ(decode(mixed(), bytes).dump(), kMixed);
}

TEST(TypeDecode, EveryTruncatedSampleIsNamedAsDamaged) {
  for (std::size_t size = 0; size < kMixedXcdr1.size(); ++size) {
    EXPECT_THROW((void)decode(mixed(), std::span(kMixedXcdr1).first(size)), std::runtime_error) << size;
  }
}

TEST(TypeDecode, RandomBytesNeverLeadToReadsBeyondTheSampleOrEndlessLoops) {
  std::mt19937 random(20261122);
  int decoded = 0;
  for (int i = 0; i < 20'000; ++i) {
    Bytes bytes = kMixedXcdr1;
    for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    bytes.resize(random() % (bytes.size() + 1));
    try {
      decoded += decode(mixed(), bytes).size() == 4;
    } catch (const std::runtime_error&) {}
  }
  EXPECT_GT(decoded, 0);
}

TEST(TypeDecode, NanBecomesNullAndAnUnknownEnumeratorBecomesItsNumber) {
  TypeNode colour;
  colour.kind = Kind::kEnum;
  colour.primitive = kInt32;
  colour.literals = {{0, "red"}, {1, "green"}};
  const TypeNode type = structure({{"x", primitive(kFloat64)},
                                   {"known", std::make_shared<TypeNode>(colour)},
                                   {"unknown", std::make_shared<TypeNode>(colour)},
                                   {"flag", primitive(kBoolean)}});
  const Bytes bytes = {0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0xf8, 0x7f, 1, 0, 0, 0, 9, 0, 0, 0, 1};
  EXPECT_EQ(decode(type, bytes).dump(), R"({"x":null,"known":"green","unknown":9,"flag":true})");
}

TEST(TypeDecode, ArraysKeepTheirDimensions) {
  const TypeNode type = structure({{"m", of_kind(Kind::kArray, primitive(kUint16), {2, 3})}});
  const Bytes bytes = {0, 1, 0, 0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0};
  EXPECT_EQ(decode(type, bytes).dump(), R"({"m":[[1,2,3],[4,5,6]]})");
}

TEST(TypeDecode, ReadsOptionalMembersAndOlderVersionsOfAnAppendableType) {
  TypeNode type = structure({{"a", primitive(kInt32)}, {"b", primitive(kInt32)}, {"c", primitive(kInt32)}},
                            TypeNode::Extensibility::kAppendable);
  type.members[1].optional = true;
  const Bytes absent = {0, 9, 0, 0, 12, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 6, 0, 0, 0};
  EXPECT_EQ(decode(type, absent).dump(), R"({"a":5,"b":null,"c":6})");
  const Bytes older = {0, 9, 0, 0, 4, 0, 0, 0, 5, 0, 0, 0};
  EXPECT_EQ(decode(type, older).dump(), R"({"a":5})");
  const Bytes too_long = {0, 9, 0, 0, 99, 0, 0, 0, 5, 0, 0, 0};
  EXPECT_THROW((void)decode(type, too_long), std::runtime_error);
}

TEST(TypeDecode, AUnionHasItsDiscriminatorAndTheChosenMember) {
  TypeNode type = structure({{"number", primitive(kInt32)}, {"text", of_kind(Kind::kString)}});
  type.kind = Kind::kUnion;
  type.element = primitive(kInt32);
  type.members[0].labels = {1, 2};
  type.members[1].is_default = true;
  EXPECT_EQ(decode(type, Bytes{0, 1, 0, 0, 2, 0, 0, 0, 42, 0, 0, 0}).dump(), R"({"_d":2,"number":42})");
  EXPECT_EQ(decode(type, Bytes{0, 1, 0, 0, 7, 0, 0, 0, 2, 0, 0, 0, 'x', 0}).dump(), R"({"_d":7,"text":"x"})");
}

TEST(TypeDecode, UnknownEncapsulationsAreNamed) {
  for (const Bytes& bytes : {Bytes{0xff, 1, 0, 0, 0}, Bytes{0, 0x0c, 0, 0, 0}, Bytes{0, 3, 0, 0, 0}}) {
    EXPECT_THROW((void)decode(structure({{"a", primitive(kByte)}}), bytes), std::runtime_error);
  }
}

}  // namespace
}  // namespace constrictor::dds
