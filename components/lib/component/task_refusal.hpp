// How the programs that request tasks classify navigation's refusals.
#pragma once

#include <string>
#include <string_view>

namespace constrictor {

/// A refusal that passes by itself begins with this text (TaskEvent.detail, TaskStatus.reason): the same request may be
/// accepted later. Every other refusal concerns the request: to repeat it unchanged is pointless.
inline constexpr std::string_view kNotReady = "not ready: ";

[[nodiscard]] inline bool passes_by_itself(const std::string& refusal) { return refusal.starts_with(kNotReady); }

}  // namespace constrictor
