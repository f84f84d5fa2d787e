#include "cli/run_ending.hpp"

#include <fmt/format.h>

namespace constrictor::cli {

void RunEnding::signal_received(int number, bool begun, Time now) {
  if (requested()) {
    if (now - first_signal_at_ < kSameWish) return;
    at_once_ = true;
    kill_reason_ = "a second signal arrived";
    return;
  }
  first_signal_ = number;
  first_signal_at_ = now;
  if (!begun) kill_reason_ = "the run had not begun";
}

void RunEnding::accepted(Time now) {
  if (!accepted_at_) accepted_at_ = now;
}

void RunEnding::failed(const std::string& reason) {
  if (kill_reason_.empty()) kill_reason_ = reason;
}

std::string RunEnding::kill_reason(Time now) const {
  if (kill_reason_.empty() && accepted_at_ && now - *accepted_at_ > kEndBound)
    return fmt::format("the run did not end within {} s of the conductor's answer", kEndBound.count());
  return kill_reason_;
}

}  // namespace constrictor::cli
