// Samples of the topics in the table are decoded also if their writer announces no type information.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/raw_reader.hpp"
#include "cyclone/type_tree.hpp"
#include "support/eventually.hpp"

namespace constrictor {
namespace {

TEST(KnownType, EveryTopicOfTheTableHasOneAndOthersHaveNone) {
  const DomainClaim claim;
  const dds::Domain domain(claim.domain());
  const auto text = [&](std::string_view type) {
    const auto tree = dds::TypeTree::known(domain.participant(), "constrictor::msg::" + std::string(type));
    return tree ? tree->text() : "";
  };
  for (const auto& topic : topics::kInfos) EXPECT_FALSE(text(topic.type).empty()) << topic.type;
  for (const auto& topic : barrier_topics::kInfos) EXPECT_FALSE(text(topic.type).empty()) << topic.type;
  EXPECT_EQ(text("Nothing"), "");
}

TEST(KnownType, DecodesASampleByNameAlone) {
  const DomainClaim claim;
  const dds::Domain domain(claim.domain());
  const dds::Entity talker(dds_create_participant(claim.domain(), nullptr, nullptr), "dds_create_participant");
  const dds::Writer<msg::JointState> writer(talker.get(), "joint_state", 8);
  const dds::Discovery discovery(domain.participant());
  std::optional<dds::Endpoint> found;
  ASSERT_TRUE(testing::eventually([&] {
    for (auto& endpoint : discovery.endpoints()) {
      if (endpoint.writer && endpoint.topic == "joint_state") found = endpoint;
    }
    return found.has_value();
  }));
  const dds::RawReader reader(domain.participant(), *found, /*history=*/true);
  msg::JointState state{};
  state.robot_id = 1;
  state.joint_count = 2;
  state.position_rad[1] = 0.25;
  writer.write(state);
  const auto tree = dds::TypeTree::known(domain.participant(), found->type);
  ASSERT_TRUE(tree);
  nlohmann::ordered_json sample;
  ASSERT_TRUE(testing::eventually([&] {
    reader.take([&](const dds::RawSample& raw) { sample = tree->decode(raw.bytes); });
    return !sample.is_null();
  }));
  EXPECT_EQ(sample["joint_count"], 2);
  EXPECT_EQ(sample["position_rad"][1], 0.25);
}

}  // namespace
}  // namespace constrictor
