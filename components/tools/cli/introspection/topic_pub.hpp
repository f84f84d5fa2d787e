// `constrictor topic pub`: publishes a message on a topic.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cli/introspection/domain_view.hpp"

namespace constrictor::cli {

struct PubOptions {
  std::string topic;
  std::string message;      ///< JSON or YAML; empty: that of `file`, or no field is given
  std::string file;         ///< "-": standard input
  std::string type;         ///< of a topic that has no reader or writer yet
  double rate_hz = 0.0;     ///< 0: once
  std::uint64_t count = 0;  ///< with a rate: number of messages; 0: until interrupted
  double for_s = 0.0;       ///< [s] with a rate; 0: until interrupted
  double wait_s = 5.0;      ///< [s] for a reader; 0: do not wait
  bool check = false;       ///< only print what would be sent
};

/// The text as JSON; text that is not JSON is read as YAML. Throws UsageError with line and column.
nlohmann::ordered_json parse_message(const std::string& text);

/// Returns the exit status: 0; 1 if the topic has no reader. Throws UsageError if the message does not fit the type,
/// and CommandError if the topic must not be written.
int pub_command(const ViewOptions& view, const PubOptions& options);

/// Adds the arguments and the help.
void add_pub_options(CLI::App& app, ViewOptions& view, PubOptions& options);

}  // namespace constrictor::cli
