// The barrier's messages as values, independent of DDS. They have the names of their wire forms in
// idl/constrictor/barrier.idl.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "component/component.hpp"
#include "component/topic_set.hpp"

namespace constrictor {

/// Names one sequence of ticks.
struct EpochId {
  std::uint64_t run_id = 0;
  std::uint32_t epoch = 0;
  bool operator==(const EpochId&) const = default;
};

/// A member announces itself to the conductor and to the other members.
struct Hello {
  std::string component;
  std::uint64_t run_id = 0;  ///< the run that it belongs to; 0: any run
  std::uint32_t incarnation = 1;
  std::int32_t pid = 0;
  std::string host;
  std::string release;  ///< version of the program; empty: not known, or a program of another project
  std::string idl_hash;
  std::string config_hash;
  std::string component_hash;  ///< of the component's own configuration and scenario file, see component_hash()
  std::string numeric_profile;
  Timing timing;
  TopicSet reads;
  TopicSet writes;
  std::string proof;  ///< proof that the writer has the run's token; empty: it has none
};

/// Hello.component_hash of a component, made from the hashes of the two files in hexadecimal.
std::string component_hash(const std::string& scenario, const std::string& configuration);
/// The part of a Hello.component_hash that stands for the scenario file; empty if it was not made by component_hash().
std::string scenario_part(const std::string& component_hash);
/// The same hash for a member that takes the place of one with another configuration, at real-time pace.
std::string replacing(const std::string& component_hash);
/// Stands in place of the predecessor's state for a member that cannot read that state: the member begins anew.
inline constexpr std::string_view kBeginAnew = "begin anew";
/// Whether a hash is one of replacing().
bool replaces(const std::string& component_hash);

/// Compares IDL hash, release, configuration hash, scenario and numeric profile, which all members of a run have in
/// common. Release and scenario are compared only if both are known. Returns all that differ, with both values; empty
/// if none differs.
std::optional<std::string> difference(const Hello& hello, const Hello& ours);

/// A member has finished a step.
struct TickDone {
  /// One message that the step wrote, as canonical bytes (reflect.hpp) with its header.
  struct Written {
    std::uint8_t topic = 0;
    std::string bytes;
  };
  struct Count {
    std::uint8_t topic = 0;
    std::uint64_t count = 0;
  };
  std::string component;
  EpochId epoch;
  std::uint32_t incarnation = 1;
  std::int64_t index = 0;
  std::vector<Count> published;  ///< of every topic that the member writes: samples since the epoch began
  std::vector<Count> consumed;   ///< newest sequence number of each input that the step saw
  std::array<std::uint8_t, 32> output_hash{};
  bool end_of_run = false;
  std::string state;             ///< of the member, opaque; empty if it keeps no checkpoint
  std::vector<Written> written;  ///< by this step; empty if the member keeps no checkpoint
};

/// The data from which the plant's successor continues, besides the conductor's own state: the plant's state after it
/// has measured for a tick, and what it wrote since its previous sample.
struct PlantCheckpoint {
  std::string state;  ///< empty: the plant keeps no checkpoint
  std::vector<TickDone::Written> written;
};

/// Lets a restarted member continue: the state after its last finished step, and its last outputs, oldest first.
struct Resume {
  std::string component;
  EpochId epoch;
  std::uint32_t incarnation = 1;
  std::int64_t index = -1;
  std::uint64_t seed = 1;
  std::string state;
  std::vector<TickDone::Written> outputs;
};

/// Packs a checkpoint for the wire, little-endian: length of the state (u64), the state, number of outputs (u64), and
/// of each output its topic id (u8), length (u64) and bytes. Empty if there is neither state nor output. The result
/// uses the memory of `memory`, whose content is lost.
std::string pack_checkpoint(const std::string& state, const std::vector<TickDone::Written>& outputs,
                            std::string memory = {});
/// The inverse. Any process may send the bytes: returns false, and leaves `state` and `outputs` empty, unless they are
/// exactly one checkpoint whose outputs belong to known topics. Both keep the memory that they have.
bool unpack_checkpoint(std::string_view block, std::string& state, std::vector<TickDone::Written>& outputs);

}  // namespace constrictor
