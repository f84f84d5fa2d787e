// The barrier's messages as values, independent of how they travel. The wire forms are in idl/constrictor/barrier.idl.
#pragma once

#include <array>
#include <cstdint>
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
  std::uint32_t incarnation = 1;
  std::int32_t pid = 0;
  std::string host;
  std::string idl_hash;
  std::string config_hash;
  std::string numeric_profile;
  Timing timing;
  std::uint64_t reads = 0;
  std::uint64_t writes = 0;
};

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

/// Flattens outputs into one block and back; parse throws std::runtime_error on damage.
std::string pack_outputs(const std::string& state, const std::vector<StepDone::Written>& outputs);
void unpack_outputs(const std::string& block, std::string& state, std::vector<StepDone::Written>& outputs);

}  // namespace constrictor
