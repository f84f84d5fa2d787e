// Names of constants: made from the IDL by the generator, and looked up both ways.
#include "constrictor/constants.hpp"

#include <gtest/gtest.h>

#include "idl/generator/constant_groups.hpp"

namespace constrictor {
namespace {

generator::Model model_of(const std::string& text) {
  generator::Model model;
  generator::parse_idl("made_up.idl", text, model);
  return model;
}

std::string refusal_of(const std::string& text) {
  try {
    static_cast<void>(generator::constant_groups(model_of(text)));
  } catch (const std::exception& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ConstantGroups, AreTheConstantsThatACommentNames) {
  const auto groups = generator::constant_groups(
      model_of("const octet kSizeSmall = 0;\nconst octet kSizeVeryLarge = 1;\nconst long kMaxSizes = 9;\n"
               "const octet kSidewaysNo = 0;\n"
               "@final struct S {\n  octet size;  // kSize...; of the box\n  octet way;  // [-] one of kSideways...\n"
               "  long length;  // see kOther...\n};"));
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].prefix, "kSize");
  EXPECT_EQ(groups[0].names, (std::vector<std::string>{"small", "very_large"}));
  EXPECT_EQ(groups[1].prefix, "kSideways");
}

TEST(ConstantGroups, RejectConstantsOutsideAGroupAndValuesWithGaps) {
  EXPECT_EQ(
      refusal_of("const octet kSizeSmall = 0;\n"),
      "made_up.idl:1: kSizeSmall belongs to no group; accepted: a name whose beginning stands in the comment of a "
      "field, followed by \"...\"");
  EXPECT_EQ(
      refusal_of("const octet kSizeSmall = 0;\nconst octet kSizeLarge = 2;\n"
                 "@final struct S {\n  octet size;  // kSize...\n};"),
      "made_up.idl:2: kSizeLarge: found value 2, accepted 1; constants of a group stand together and count from 0");
  EXPECT_EQ(refusal_of("@final struct S {\n  octet size;  // kSize...\n};"),
            "made_up.idl: the comment of S.size names kSize..., but no constant begins with kSize");
}

TEST(Constants, HaveNamesInBothDirections) {
  EXPECT_STREQ(name_of(constants::kColour, msg::kColourGreen), "green");
  EXPECT_STREQ(name_of(constants::kTask, msg::kTaskFollowLine), "follow_line");
  EXPECT_EQ(words_of(constants::kEvent, msg::kEventObjectPregraspLost), "object pregrasp lost");
  for (const ConstantGroup* group : constants::kAll) {
    for (std::size_t value = 0; value < group->names.size(); ++value) {
      const auto octet = static_cast<std::uint8_t>(value);
      EXPECT_EQ(value_of(*group, name_of(*group, octet)), octet) << group->prefix << value;
      EXPECT_EQ(value_of(*group, words_of(*group, octet)), octet) << group->prefix << value;
    }
  }
}

TEST(Constants, AreFoundWhateverTheirCaseAndSeparators) {
  EXPECT_EQ(value_of(constants::kEvent, "Object-Pregrasp Lost"), msg::kEventObjectPregraspLost);
  EXPECT_EQ(value_of(constants::kColour, "GREEN"), msg::kColourGreen);
  EXPECT_EQ(value_of(constants::kColour, "gree"), std::nullopt);
  EXPECT_EQ(value_of(constants::kColour, "greens"), std::nullopt);
  EXPECT_EQ(value_of(constants::kColour, ""), std::nullopt);
}

TEST(Constants, WithoutANameAreAQuestionMark) {
  EXPECT_STREQ(name_of(constants::kColour, msg::kColourCount), "?");
  EXPECT_STREQ(name_of(constants::kColour, 255), "?");
}

TEST(Constants, AreListedForPeople) {
  EXPECT_EQ(listed(constants::kColour, 1), "green, red, blue, yellow");
  EXPECT_EQ(listed(constants::kCommand), "start, cancel");
  EXPECT_EQ(names_of(constants::kCommand), (std::vector<std::string>{"start", "cancel"}));
  EXPECT_TRUE(names_of(constants::kCommand, 9).empty());
}

TEST(Constants, BelongToFieldsWhoseValuesAreThenLimited) {
  EXPECT_EQ(Description<msg::Blob>::k_colour.constants, &constants::kColour);
  EXPECT_EQ(Description<msg::Blob>::k_colour.max, msg::kColourCount - 1);
  EXPECT_EQ(Description<msg::Blob>::k_bearing_rad.constants, nullptr);
  EXPECT_EQ(Description<msg::Request>::k_level.constants, &constants::kAuthority);
  EXPECT_EQ(Description<msg::Request>::k_level.min, msg::kAuthorityPlanner) << "a narrower @range counts";
  EXPECT_EQ(Description<msg::Request>::k_level.max, msg::kAuthorityOperator);
}

}  // namespace
}  // namespace constrictor
