// The checkpoint of a plant's process: everything from which its successor continues the run.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace constrictor {

/// Bytes that never change. Two checkpoints share those that are the same in both.
using Blob = std::shared_ptr<const std::string>;

/// `head` is new in each checkpoint. The blobs, to which the head refers by their place, are mostly those of the
/// checkpoint before: a store writes each of them once.
struct Checkpoint {
  std::string head;
  std::vector<Blob> blobs;
};

}  // namespace constrictor
