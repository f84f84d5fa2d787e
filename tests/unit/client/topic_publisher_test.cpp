// Who may publish on which topic.
#include "client/topic_publisher.hpp"

#include <gtest/gtest.h>

#include "constrictor/topics.hpp"

namespace constrictor {
namespace {

std::vector<dds::Endpoint> writers_of(const std::vector<std::string>& topics) {
  std::vector<dds::Endpoint> list(topics.size());
  for (std::size_t i = 0; i < topics.size(); ++i) {
    list[i].topic = topics[i];
    list[i].writer = true;
  }
  return list;
}

TEST(PublishingRefusal, KeepsEveryTopicOfMembersPlantAndConductorForTheRun) {
  const auto run = writers_of({"run_state", "barrier/tick"});
  for (const auto& topic : topics::kInfos) {
    const std::string why = publishing_refusal(std::string(topic.name), run);
    EXPECT_NE(why.find("belongs to " + std::string(topic.writer)), std::string::npos) << topic.name << ": " << why;
  }
  int of_clients = 0;
  for (const auto& topic : barrier_topics::kInfos) {
    const bool refused = !publishing_refusal(topic.name, run).empty();
    EXPECT_EQ(refused, topic.writers != "clients") << topic.name;
    of_clients += refused ? 0 : 1;
  }
  EXPECT_EQ(of_clients, 3);  // request/v2, run_control/v2, emergency_stop
}

TEST(PublishingRefusal, AMemberThatWaitsForItsRunCountsAsARun) {
  EXPECT_FALSE(publishing_refusal("joint_state", writers_of({"barrier/hello/v2"})).empty());
}

TEST(PublishingRefusal, AllowsEverythingElse) {
  EXPECT_TRUE(publishing_refusal("rt/cmd_vel", writers_of({"run_state"})).empty());
  EXPECT_TRUE(publishing_refusal("joint_state", writers_of({"joint_state", "weather"})).empty());
  auto readers = writers_of({"run_state", "barrier/tick"});
  for (auto& endpoint : readers) endpoint.writer = false;
  EXPECT_TRUE(publishing_refusal("joint_state", readers).empty());
}

}  // namespace
}  // namespace constrictor
