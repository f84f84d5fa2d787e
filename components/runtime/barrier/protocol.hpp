// The barrier's messages as values, independent of how they travel. The wire forms are in idl/constrictor/barrier.idl.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/component.hpp"

namespace constrictor {

/// Names one sequence of ticks.
struct EpochId {
  std::uint64_t run_id = 0;
  std::uint32_t epoch = 0;
  bool operator==(const EpochId&) const = default;
};

/// A member introduces itself.
struct Greeting {
  std::string component;
  std::uint64_t run_id = 0;    ///< in which it wants to take part; 0: in any
  std::uint32_t incarnation = 1;
  std::int32_t pid = 0;
  std::string host;
  std::string idl_hash;
  std::string config_hash;
  std::string component_hash;  ///< of the component's own configuration file; empty: it has none
  std::string numeric_profile;
  Timing timing;
  std::uint64_t reads = 0;
  std::uint64_t writes = 0;
};

/// The first thing, with both values, in which `greeting` is of another run than `ours`: IDL, configuration, numeric profile.
std::optional<std::string> difference(const Greeting& greeting, const Greeting& ours);

/// A step is done.
struct StepDone {
  /// One message written by the step, as canonical bytes with its header; empty bytes where no checkpoint is kept.
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
  std::vector<Count> published;  ///< cumulative, every topic it writes
  std::vector<Count> consumed;   ///< newest sequence number of each input that the step saw
  std::array<std::uint8_t, 32> output_hash{};
  bool end_of_run = false;
  std::string state;             ///< runtime's and component's, opaque; empty where no checkpoint is kept
  std::vector<Written> written;
};

/// What a restarted member needs: the state after its last finished step and its last outputs, oldest first.
struct Resumption {
  std::string component;
  EpochId epoch;
  std::uint32_t incarnation = 1;
  std::int64_t index = -1;
  std::uint64_t seed = 1;
  std::string state;
  std::vector<StepDone::Written> outputs;
};

/// A checkpoint as it travels, little-endian: length of the state (u64), state, number of outputs (u64), and of each its topic
/// (u8), length (u64) and bytes. Empty if there is neither state nor output.
std::string pack_checkpoint(const std::string& state, const std::vector<StepDone::Written>& outputs);
/// The inverse, of bytes from anybody; false, and both empty, if they are not exactly one checkpoint of known topics.
bool unpack_checkpoint(const std::string& block, std::string& state, std::vector<StepDone::Written>& outputs);

}  // namespace constrictor
