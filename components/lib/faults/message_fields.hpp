// Numbers inside a message of any topic, by the path of their field.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "component/ports.hpp"

namespace constrictor {

/// Why `path` ("position_rad[3]", "pose.position.x") names no floating-point number in messages of the topic; empty if
/// it names one. Throws std::out_of_range unless `topic_id` is below topics::kCount.
[[nodiscard]] std::optional<std::string> not_a_real_number(std::size_t topic_id, const std::string& path);

/// A copy of the sample in which `amount` is added to the number at `path`, for which not_a_real_number() must be
/// empty.
[[nodiscard]] Sample with_bias(std::size_t topic_id, const Sample& sample, const std::string& path, double amount);

}  // namespace constrictor
