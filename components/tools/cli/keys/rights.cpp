#include "cli/keys/rights.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <stdexcept>

#include "constrictor/topics.hpp"

namespace constrictor::cli {
namespace {

/// A list element of permissions.
std::string topics_element(const char* kind, const std::set<std::string>& topics) {
  if (topics.empty()) return {};
  std::string text = fmt::format("        <{}>\n          <topics>\n", kind);
  for (const auto& topic : topics) text += fmt::format("            <topic>{}</topic>\n", topic);
  return text +
         fmt::format("          </topics>\n          <partitions><partition></partition></partitions>\n        </{}>\n",
                     kind);
}

std::string time_text(std::chrono::system_clock::time_point time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

void read_what_runs_publish(Rights& rights, bool simulation) {
  for (const auto& topic : topics::kInfos) {
    if (simulation || !topic.simulation_only) rights.subscribe.emplace(topic.name);
  }
  for (const auto& topic : barrier_topics::kInfos) {
    if (std::string_view(topic.writers) != "clients") rights.subscribe.emplace(topic.name);
  }
}

}  // namespace

Rights rights_of_member(const std::vector<std::string>& lines, bool conducts) {
  namespace wire = barrier_topics;
  Rights rights;
  for (const auto& line : lines) {
    if (line.starts_with("reads ")) rights.subscribe.insert(line.substr(6));
    else if (line.starts_with("writes ")) rights.publish.insert(line.substr(7));
    else throw std::runtime_error(fmt::format("--topics: found '{}', accepted 'reads TOPIC' or 'writes TOPIC'", line));
  }
  rights.publish.insert({wire::kHello, wire::kWaiting, wire::kStatus, wire::kLog});
  rights.subscribe.insert({wire::kHello, wire::kRefused});
  if (conducts) {
    rights.publish.insert(
        {wire::kEpochStart, wire::kTick, wire::kResume, wire::kRefused, wire::kRunState, wire::kRunControlAnswer});
    rights.subscribe.insert({wire::kReady, wire::kTickDone, wire::kStatus, wire::kRunControl, wire::kEmergencyStop});
  } else {
    rights.publish.insert({wire::kReady, wire::kTickDone});
    rights.subscribe.insert({wire::kEpochStart, wire::kTick, wire::kResume, wire::kRunState});
  }
  return rights;
}

Rights rights_of_operator() {
  namespace wire = barrier_topics;
  Rights rights{{wire::kRequest, wire::kRunControl, wire::kEmergencyStop, wire::kLog}, {}};
  read_what_runs_publish(rights, true);
  return rights;
}

Rights rights_of_client() {
  Rights rights{{barrier_topics::kRequest, barrier_topics::kEmergencyStop}, {}};
  read_what_runs_publish(rights, false);
  return rights;
}

Rights rights_of_observer() {
  Rights rights;
  read_what_runs_publish(rights, true);
  return rights;
}

std::string permissions_document(const std::string& subject, const Rights& rights, int days) {
  const auto now = std::chrono::system_clock::now();
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
     xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd">
  <permissions>
    <grant name="constrictor">
      <subject_name>{}</subject_name>
      <validity>
        <not_before>{}</not_before>
        <not_after>{}</not_after>
      </validity>
      <allow_rule>
        <domains><id_range><min>0</min><max>229</max></id_range></domains>
{}{}      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
)",
                     subject, time_text(now - std::chrono::hours(24)), time_text(now + std::chrono::hours(24 * days)),
                     topics_element("publish", rights.publish), topics_element("subscribe", rights.subscribe));
}

std::string governance_document() {
  return R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
     xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
  <domain_access_rules>
    <domain_rule>
      <domains><id_range><min>0</min><max>229</max></id_range></domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
      <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
      <rtps_protection_kind>ENCRYPT</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>true</enable_discovery_protection>
          <enable_liveliness_protection>true</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>NONE</metadata_protection_kind>
          <data_protection_kind>NONE</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
)";
}

}  // namespace constrictor::cli
