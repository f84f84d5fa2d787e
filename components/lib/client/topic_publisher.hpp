// Publishes messages that are given as text or objects on any topic, checked, for tools.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "client/command_error.hpp"
#include "client/run_registry.hpp"
#include "cyclone/discovery.hpp"

namespace constrictor {

/// Why a program that is not a member of a run must not publish on this topic; empty: it may. `endpoints`: of the
/// domain. In a domain with a run, the topics of members, plant and conductor are theirs: the members refuse what
/// others write there, but observers would show it as if it were true. Pure.
[[nodiscard]] std::string publishing_refusal(const std::string& topic, const std::vector<dds::Endpoint>& endpoints);

/// True for the topics on which clients command a run; their readers obey a message once, however often it is written.
[[nodiscard]] bool publishes_commands(const std::string& topic);

class TopicPublisher {
 public:
  /// Looks for endpoints of the topic until discovery has settled (at most 1.5 s), to learn its type. `type`: the name
  /// of the type where the topic has no endpoint ("JointState" or "constrictor::msg::JointState"); empty: that of the
  /// endpoints, or of the table of topics. Throws CommandError if the topic must not be written, or its type is not
  /// known. `participant` must outlive this object. `source`, `key`: of commands; an empty key is found by run_key().
  TopicPublisher(std::int32_t participant, std::uint32_t domain, std::string topic, const std::string& type,
                 std::string source, std::optional<RunKey> key = {});
  ~TopicPublisher();

  /// The message with what clients need not give: on `request/v2`, `run_control/v2` and `emergency_stop`, the fields
  /// source, robot_id, token, run_id and sequence_number that it leaves out are filled in; numbers rise with each call.
  [[nodiscard]] nlohmann::ordered_json completed(nlohmann::ordered_json message);
  /// The encoded message. Throws std::invalid_argument as dds::TypeTree::encode() does.
  [[nodiscard]] std::vector<std::uint8_t> encode(const nlohmann::ordered_json& message) const;
  /// The message that a receiver decodes from these bytes.
  [[nodiscard]] nlohmann::ordered_json decode(const std::vector<std::uint8_t>& bytes) const;

  /// Creates the writer (the first call), and returns the number of readers that it has matched.
  int readers();
  /// Why readers of the topic cannot receive what this object writes: "control: type: ...", one for each such reader.
  [[nodiscard]] std::vector<std::string> mismatched_readers() const;
  /// Writes a message; it never blocks. The newest 64 are kept for late readers.
  void write(const std::vector<std::uint8_t>& bytes);
  /// Waits until all reliable readers have what was written. False if they have not within `bound`.
  bool flush(std::chrono::milliseconds bound) const;

  [[nodiscard]] const std::string& type() const { return type_; }

 private:
  struct Parts;
  std::string topic_;
  std::string type_;
  std::string source_;
  RunKey key_;
  std::uint64_t sequence_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace constrictor
