// The expressions of `topic echo --filter`, and how samples are shown.
#include "cli/introspection/sample_filter.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/introspection/sample_view.hpp"
#include "cli/introspection/topic_pub.hpp"
#include "cli/usage.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;

const Json kSample = Json::parse(R"({"header": {"tick": 600}, "event": "line_lost", "visible": true, "offset_m": null,
  "other": "line_lost", "detail": "two words", "blobs": [{"colour": "red", "range_m": 1.5},
  {"colour": "green", "range_m": -3}], "none": []})");

bool accepts(const std::string& expression) { return SampleFilter(expression).accepts(kSample); }

std::string problem(const std::string& expression) {
  try {
    static_cast<void>(accepts(expression));
  } catch (const FilterError& error) {
    return error.what();
  }
  return "";
}

TEST(SampleFilter, ComparesFieldsWithNumbersTextsAndOtherFields) {
  EXPECT_TRUE(accepts("header.tick == 600"));
  EXPECT_FALSE(accepts("header.tick != 600.0"));
  EXPECT_TRUE(accepts("header.tick>5e2"));
  EXPECT_FALSE(accepts("header.tick > 600"));
  EXPECT_TRUE(accepts("header.tick >= 600"));
  EXPECT_TRUE(accepts("header.tick <= 600"));
  EXPECT_FALSE(accepts("header.tick < -1"));
  EXPECT_TRUE(accepts("event == line_lost"));
  EXPECT_TRUE(accepts("event == other"));
  EXPECT_FALSE(accepts("event == 'other'"));
  EXPECT_TRUE(accepts("detail == \"two words\""));
  EXPECT_TRUE(accepts("visible"));
  EXPECT_TRUE(accepts("visible == true"));
  EXPECT_FALSE(accepts("none"));
}

TEST(SampleFilter, AndBindsStrongerThanOr) {
  EXPECT_TRUE(accepts("visible or visible and event == x"));
  EXPECT_FALSE(accepts("(visible or visible) and event == x"));
  EXPECT_TRUE(accepts("not event == x"));
  EXPECT_FALSE(accepts("not visible or not visible"));
  EXPECT_TRUE(accepts("not (event == x or header.tick == 1)"));
}

TEST(SampleFilter, NanEqualsNullAndIsNeitherSmallerNorLarger) {
  EXPECT_TRUE(accepts("offset_m == null"));
  EXPECT_FALSE(accepts("offset_m < 0"));
  EXPECT_FALSE(accepts("offset_m >= 0"));
}

TEST(SampleFilter, AnIndexSelectsAnElementAndAStarAnyOfThem) {
  EXPECT_TRUE(accepts("blobs.1.colour == green"));
  EXPECT_FALSE(accepts("blobs.0.colour == green"));
  EXPECT_TRUE(accepts("blobs.*.colour == green"));
  EXPECT_FALSE(accepts("blobs.*.colour == blue"));
  EXPECT_FALSE(accepts("blobs.2.colour == green"));  // there are two
  EXPECT_FALSE(accepts("none.*.colour == green"));
  EXPECT_TRUE(accepts("blobs.*.range_m < -2.5"));
}

TEST(SampleFilter, ErrorsNameWhatWasFoundAndWhatIsAccepted) {
  EXPECT_EQ(problem("evnt == line_lost").substr(0, 63),
            "there is no field 'evnt', did you mean 'event'?; accepted are h");
  EXPECT_EQ(problem("blobs.x.colour == red"), "found 'x' after a list, accepted an index or *");
  EXPECT_EQ(problem("event.x == 1"), "found 'x' after a plain value, which has no parts");
  EXPECT_EQ(problem("event < 3"), "< compares numbers only, found \"line_lost\" and 3.0");
  EXPECT_EQ(problem("header.tick = 3").substr(0, 22), "found '=' at column 13");
  EXPECT_EQ(problem("header.tick =="), "found the end at column 15, accepted a field, a number or a text");
  EXPECT_EQ(problem("(visible"), "found the end at column 9, accepted )");
  EXPECT_EQ(problem("visible event"), "found 'event' at column 9, accepted and, or, a comparison, or the end");
  EXPECT_EQ(problem("'x == 3"), "the quote at column 1 has no end");
  EXPECT_EQ(problem(""), "found the end at column 1, accepted a field, a number or a text");
  EXPECT_EQ(problem(std::string(10'000, '(')), "more than 100 nested \"not\" and parentheses");
}

TEST(SampleView, RoundsAndReplacesArraysByTheirLength) {
  Json sample = Json::parse(R"({"x": [0.123456, -0.00001], "n": 3, "parts": [{"y": 2.5}], "t": "a"})");
  apply(sample, {false, false, 2});
  EXPECT_EQ(sample.dump(), R"({"x":[0.12,0.0],"n":3,"parts":[{"y":2.5}],"t":"a"})");
  apply(sample, {true, false, {}});
  EXPECT_EQ(sample.dump(), R"({"x":"<2 values>","n":3,"parts":"<1 value>","t":"a"})");
}

TEST(SampleView, BytesBecomeTheirNumberAndChecksum) {
  const auto byte = std::make_shared<dds::TypeNode>();
  byte->primitive = 2;  // DDS_XTypes_TK_BYTE
  const auto bytes = std::make_shared<dds::TypeNode>();
  bytes->kind = dds::TypeNode::Kind::kSequence;
  bytes->element = byte;
  dds::TypeNode type;
  type.kind = dds::TypeNode::Kind::kStruct;
  type.members = {{"data", 0, false, false, {}, bytes}};
  Json sample = Json::parse(R"({"data": [97, 98, 99]})");
  summarise_bytes(sample, type);
  // SHA-256 of "abc": FIPS 180-2, appendix B.1.
  EXPECT_EQ(sample.dump(), R"({"data":{"bytes":3,"sha256":"ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f2)"
                           R"(0015ad"}})");
}

TEST(PublishedMessage, IsJsonOrYaml) {
  const Json expected =
      Json::parse(R"({"a": {"x": 1, "y": -2.5}, "t": "on the way", "list": [true, null, "7"], "n": 3})");
  EXPECT_EQ(parse_message(expected.dump()), expected);
  EXPECT_EQ(parse_message("{a: {x: 1, y: -2.5}, t: on the way, list: [true, .nan, '7'], n: 3}"), expected);
  EXPECT_EQ(parse_message("a:\n  x: 1\n  y: -2.5\nt: on the way\nlist:\n- true\n- null\n- \"7\"\nn: 3\n"), expected);
  EXPECT_EQ(parse_message(""), Json::object());
  EXPECT_EQ(parse_message("{big: 18446744073709551615}")["big"], 18446744073709551615u);
  EXPECT_THROW(static_cast<void>(parse_message("{a: [}")), UsageError);
}

}  // namespace
}  // namespace constrictor::cli
