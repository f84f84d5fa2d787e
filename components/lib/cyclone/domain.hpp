// A participant in a DDS domain, on the loopback interface unless $CYCLONEDDS_URI or the launcher of a run on several
// hosts configures something else.
#pragma once

#include <cstdint>
#include <string>

#include "cyclone/entity.hpp"

namespace constrictor::dds {

/// The networks on which a participant can be discovered if $CYCLONEDDS_URI is not set.
enum class Reach {
  /// The loopback interface, without multicast, up to 120 participants on this host; and the other hosts of a run on
  /// several hosts, see published_dds_configuration(). With the loopback interface alone nothing is sent to other
  /// hosts, but the sockets of Cyclone DDS 0.10 receive on every interface.
  kLoopback,
  kNetwork,  ///< Cyclone DDS's default, which processes of ROS 2 use
};

/// [ms] after its last sample, a writer asks the readers for an acknowledgement; so do samples that follow after more
/// than four fifths of it. Between hosts, the last message of a tick may be lost, and the run stands still until the
/// reader learns that it lacks one. The loopback interface loses a message only if the buffer of a socket is full;
/// there more of these requests would only cost CPU time: with 10 ms, every second or third datagram of a run was one
/// of them.
inline constexpr int kNetworkHeartbeat_ms = 10;
inline constexpr int kLoopbackHeartbeat_ms = 100;

/// The element `Internal` of every configuration that this project makes, as XML. The high-water mark prevents that a
/// writer of images waits for a reader whose process is stopped; keep-last bounds the histories. Larger samples than
/// the largest image are dropped, so that a stranger cannot fill the memory with a few of them. The times let a lost
/// message be sent again within milliseconds. Cyclone's defaults (heartbeats every 100 ms, 100 ms until a lost message
/// is requested) let a barrier over a link that loses 1 % of its packets make 5 times fewer ticks.
[[nodiscard]] std::string internal_settings(int heartbeat_ms);

/// The configuration that applies without $CYCLONEDDS_URI to a run on one host, as XML. deploy/cyclonedds/loopback.xml
/// is the same for other programs.
[[nodiscard]] std::string loopback_configuration();

/// The participant of a Domain, or a further one of a process that has joined `domain` already. Throws as Domain does.
[[nodiscard]] Entity create_participant(std::uint32_t domain, Reach reach, const std::string& identity);

/// Joins `domain`. A process can join each domain only once at a time. Throws Error, or std::runtime_error if the run
/// is secured and the files of the identity cannot be used.
class Domain {
 public:
  /// `identity`: with which the participant joins a secured run, see security_folder(); empty: $CONSTRICTOR_IDENTITY,
  /// or "operator".
  explicit Domain(std::uint32_t domain, Reach reach = Reach::kLoopback, const std::string& identity = {});
  [[nodiscard]] dds_entity_t participant() const { return participant_.get(); }

 private:
  Entity domain_;
  Entity participant_;
};

}  // namespace constrictor::dds
