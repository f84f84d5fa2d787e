// "Did you mean ...?" for misspelt names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace constrictor {

/// The candidate that is most like `name`, if it is like enough to be what a person meant: at most one wrong, missing,
/// surplus or swapped letter in three. Upper and lower case count as equal in this comparison. Else the first
/// candidate that begins with `name`, if this has at least two letters; empty if there is none.
[[nodiscard]] std::string closest_name(std::string_view name, const std::vector<std::string>& candidates);

/// Whether `found` is easily written for `meant`: one letter of at least four is wrong, missing, surplus or
/// swapped with the next one, or one name is the beginning of the other, as `radius` of `radius_m`. Stricter than
/// closest_name(), which takes `min_radius_m` for `max_radius_m`.
[[nodiscard]] bool is_slip_of(std::string_view found, std::string_view meant);

/// ", did you mean 'CANDIDATE'?" for the end of an error message, or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace constrictor
