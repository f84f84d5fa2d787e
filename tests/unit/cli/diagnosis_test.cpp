// The rules of `constrictor doctor`: each test puts one fault into the facts of a correct run. doctor_test
// (tests/integration) produces the same faults with real processes.
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "cli/introspection/diagnosis.hpp"
#include "component/data_path.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor::cli {
namespace {

dds::Guid guid(std::uint8_t number) {
  dds::Guid made{};
  made[0] = number;
  return made;
}

dds::Endpoint endpoint(std::uint8_t participant, bool writer, const std::string& topic, const std::string& user_data) {
  dds::Endpoint made;
  made.participant = guid(participant);
  made.writer = writer;
  made.topic = topic;
  made.type = "T";
  made.user_data = user_data;
  made.qos.reliable = made.qos.transient_local = true;
  return made;
}

/// The facts of a run without faults.
Facts sound() {
  Facts facts;
  facts.domain = 7;
  facts.runs = {7};
  facts.interfaces = {{"lo", true, false}, {"eth0", true, true}, {"eth1", false, true}, {"tun0", true, false}};
  facts.receive_buffer_max_bytes = 8'000'000;
  facts.participants = {{guid(1), "here", 11, "physics"}, {guid(2), "here", 12, "control"}};
  facts.endpoints = {endpoint(1, true, "barrier/tick", "physics"), endpoint(2, false, "barrier/tick", "control"),
                     endpoint(2, true, "joint_command", "control")};
  facts.idl_hash = "aaa";
  msg::Hello hello{};
  dds::set_text(hello.component, "control");
  dds::set_text(hello.idl_hash, "aaa");
  facts.hellos = {hello};
  return facts;
}

/// Names of the faults that diagnose() finds.
std::vector<std::string> faults(const Facts& facts) {
  std::vector<std::string> names;
  for (const auto& finding : diagnose(facts)) {
    names.push_back(finding.fault);
    EXPECT_FALSE(finding.cure.empty());
  }
  return names;
}

using Names = std::vector<std::string>;

std::string on_interface(const std::string& attributes, const std::string& more = "") {
  return "<CycloneDDS><Domain><General><Interfaces><NetworkInterface " + attributes + "/></Interfaces>" + more +
         "</General></Domain></CycloneDDS>";
}

TEST(Diagnosis, NamesALatchedStopAndItsSource) {
  Facts facts = sound();
  facts.stops.emplace_back();
  facts.stops.back().robot_id = 1;
  EXPECT_TRUE(diagnose(facts).empty()) << "it is not latched";
  facts.stops.back().stopped = true;
  facts.stops.back().since_tick = 12;
  std::snprintf(facts.stops.back().source, sizeof facts.stops.back().source, "bus_watchdog");
  const auto found = diagnose(facts);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault.name(), "latched stop");
  EXPECT_NE(found[0].what.find("robot 1 holds its posture since tick 12 because of the emergency stop of bus_watchdog"),
            std::string::npos)
      << found[0].what;
  EXPECT_NE(found[0].cure.find("constrictor clear-stop"), std::string::npos);
}

TEST(Diagnosis, FindsNoFaultInACorrectRun) { EXPECT_EQ(faults(sound()), Names{}); }

TEST(Diagnosis, NamesTheDomainOfTheRunIfTheExaminedDomainIsEmpty) {
  Facts facts = sound();
  facts.domain = 8;
  facts.participants.clear();
  facts.endpoints.clear();
  ASSERT_EQ(faults(facts), Names{"wrong domain"});
  EXPECT_NE(diagnose(facts).front().cure.find("--run 7"), std::string::npos);
  facts.runs.clear();
  EXPECT_EQ(faults(facts), Names{"empty domain"});
}

TEST(Diagnosis, FindsInterfacesThatDoNotExistOrAreDown) {
  Facts facts = sound();
  facts.dds_configuration = on_interface("name=\"eth0\"");
  EXPECT_EQ(faults(facts), Names{});
  facts.dds_configuration = on_interface("name=\"eth7\"");
  EXPECT_EQ(faults(facts), Names{"wrong interface"});
  facts.dds_configuration = on_interface("name=\"eth1\"");
  EXPECT_EQ(faults(facts), Names{"wrong interface"});
}

TEST(Diagnosis, FindsMissingMulticastOnlyIfNoPeersAreConfigured) {
  Facts facts = sound();
  facts.dds_configuration = on_interface("name=\"tun0\"");
  EXPECT_EQ(faults(facts), Names{"missing multicast"});
  facts.dds_configuration = on_interface("name=\"eth0\" multicast=\"false\"");
  EXPECT_EQ(faults(facts), Names{"missing multicast"});
  facts.dds_configuration = on_interface("name=\"eth0\"", "<AllowMulticast>false</AllowMulticast>");
  EXPECT_EQ(faults(facts), Names{"missing multicast"});
  facts.dds_configuration += "<Peer Address=\"10.0.0.2\"/>";
  EXPECT_EQ(faults(facts), Names{});
}

TEST(Diagnosis, FindsTwoPlantsAndTwoMembersWithTheSameName) {
  Facts facts = sound();
  facts.endpoints.push_back(endpoint(2, true, "barrier/tick", ""));
  EXPECT_EQ(faults(facts), Names{"two plants"});
  facts = sound();
  facts.endpoints.push_back(endpoint(1, true, "other", "physics,control"));
  EXPECT_EQ(faults(facts), Names{"two members of one name"});
}

TEST(Diagnosis, FindsAMemberWithTheMessagesOfAnotherVersion) {
  Facts facts = sound();
  dds::set_text(facts.hellos[0].idl_hash, "bbb");
  EXPECT_EQ(faults(facts), Names{"differing IDL hash"});
}

TEST(Diagnosis, FindsReadersThatCannotMatchAWriter) {
  Facts facts = sound();
  facts.endpoints[0].qos.reliable = false;
  EXPECT_EQ(faults(facts), Names{"differing QoS"});
  facts = sound();
  facts.endpoints[0].qos.transient_local = false;
  EXPECT_EQ(faults(facts), Names{"differing QoS"});
  facts = sound();
  facts.endpoints[0].qos.representations = {2};  // XCDR2
  EXPECT_EQ(faults(facts), Names{"differing QoS"});
  facts = sound();
  facts.endpoints[0].qos.partitions = {"north"};
  EXPECT_EQ(faults(facts), Names{"differing QoS"});
  facts = sound();
  facts.endpoints[0].type = "Other";
  EXPECT_EQ(faults(facts), Names{"differing type"});
  facts = sound();
  facts.endpoints[1].qos.reliable = facts.endpoints[1].qos.transient_local = false;  // a reader may ask for less
  EXPECT_EQ(faults(facts), Names{});
}

TEST(Diagnosis, FindsSmallSocketBuffersBetweenHosts) {
  Facts facts = sound();
  facts.receive_buffer_max_bytes = 212'992;  // Linux's default
  facts.dds_configuration = on_interface("name=\"eth0\"");
  EXPECT_EQ(faults(facts), Names{"small socket buffers"});
}

// The page for people and the rules must not drift apart.
TEST(Troubleshooting, HasASectionWithCauseAndRemedyForEachFaultAndNoOther) {
  std::ifstream file(data_path(kTroubleshooting));
  std::vector<std::string> headings;
  std::string text;
  std::map<std::string, std::string> sections;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("### ")) headings.push_back(line.substr(4));
    if (line.starts_with("## ")) headings.emplace_back();  // the end of a section
    else if (!headings.empty()) sections[headings.back()] += line + "\n";
  }
  std::erase(headings, "");
  EXPECT_EQ(headings, Names(kFaultNames.begin(), kFaultNames.end()));
  for (const auto& name : headings) {
    EXPECT_NE(sections[name].find("**Cause:**"), std::string::npos) << name;
    EXPECT_NE(sections[name].find("**Remedy:**"), std::string::npos) << name;
  }
  EXPECT_EQ(Fault("two members of one name").anchor(), "two-members-of-one-name");
  EXPECT_EQ(Fault("differing IDL hash").anchor(), "differing-idl-hash") << "as GitHub makes it from the heading";
}

}  // namespace
}  // namespace constrictor::cli
