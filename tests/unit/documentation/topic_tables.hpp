// The tables of topics in idl/README.md, made from the table of topics in code and from the ports of all components.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>

#include "barrier/member.hpp"

namespace constrictor::documentation {

/// Every component of this build as a member of the barrier, by name. They have made their ports and do not run.
const std::map<std::string, std::unique_ptr<const Member>>& members();

/// Names of the components that read a member topic.
std::set<std::string> readers_of(const TopicInfo& topic);

/// `readme` with new tables between their markers. Throws std::runtime_error if it has no such markers.
std::string with_topic_tables(const std::string& readme);

}  // namespace constrictor::documentation
