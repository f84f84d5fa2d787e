// A decoded sample as people want to see it. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "cyclone/type_node.hpp"

namespace constrictor::cli {

struct SampleView {
  bool no_arrays = false;        ///< arrays as "<23 values>"
  bool full = false;             ///< also bytes, such as the pixels of an image, as numbers
  std::optional<int> precision;  ///< decimal places of floating-point numbers
};

/// Replaces sequences of bytes by an object with their number and SHA-256, and for an image its encoding. `type` is the
/// type of the sample.
void summarise_bytes(nlohmann::ordered_json& sample, const dds::TypeNode& type);

/// Applies the other choices of a view to a sample or to a part of it.
void apply(nlohmann::ordered_json& sample, const SampleView& view);

/// The part of a sample that a path names, with dots between its parts: "header.tick", "blobs.0.colour". Empty if the
/// sample has no such part; `problem` is then set to a text that says what was found and what is accepted.
std::optional<nlohmann::ordered_json> part_of(const nlohmann::ordered_json& sample, const std::string& path,
                                              std::string& problem);

/// The sample as YAML, with an array of numbers on one line.
std::string as_text(const nlohmann::ordered_json& sample, int depth = 0);

}  // namespace constrictor::cli
