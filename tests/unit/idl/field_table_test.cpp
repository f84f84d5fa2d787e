// The table of fields agrees with the IDL.
#include "constrictor/field_table.hpp"

#include <gtest/gtest.h>

#include "constrictor/messages.hpp"

namespace constrictor {
namespace {

const FieldEntry& field(std::string_view type, std::string_view name) {
  for (const FieldEntry& each : *fields_of(type)) {
    if (each.info.name == name) return each;
  }
  throw std::out_of_range(std::string(name));
}

TEST(FieldTable, NamesStructuresLengthsAndTheFieldThatCountsAnArray) {
  EXPECT_EQ(fields_of("constrictor::msg::Nothing"), nullptr);
  EXPECT_EQ(fields_of("JointState"), nullptr);
  const auto& fields = *fields_of("constrictor::msg::ObjectPercepts");
  const FieldEntry& blobs = field("constrictor::msg::ObjectPercepts", "blobs");
  EXPECT_EQ(blobs.type, "constrictor::msg::Blob");
  EXPECT_EQ(blobs.length, 16u);
  ASSERT_GE(blobs.count_at, 0);
  EXPECT_STREQ(fields[static_cast<std::size_t>(blobs.count_at)].info.name, "blob_count");
  EXPECT_EQ(field("constrictor::msg::ObjectPercepts", "header").type, "constrictor::msg::Header");
  EXPECT_EQ(field("constrictor::msg::ObjectPercepts", "header").length, 0u);
  EXPECT_STREQ(field("constrictor::msg::Blob", "colour").info.constants->prefix, "kColour");
}

TEST(FieldTable, ATextIsNoArrayAndAnArrayWithoutACountIsWhole) {
  EXPECT_EQ(field("constrictor::msg::TaskStatus", "reason").length, 0u);
  EXPECT_EQ(field("constrictor::msg::Tick", "visible").length, static_cast<std::size_t>(msg::kMaxTopics));
  EXPECT_EQ(field("constrictor::msg::DesiredTrajectory", "shape_rad").length, 64u);
  EXPECT_GE(field("constrictor::msg::DesiredTrajectory", "shape_rad").count_at, 0);
}

}  // namespace
}  // namespace constrictor
