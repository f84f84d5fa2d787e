// Which commands on `run_control` are new: each source numbers its own, rising. Pure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace constrictor {

/// Remembers the newest number of each source. Every process that commands is a source of its own, so they become many in a long run:
/// beyond kMost, the one that has been silent for the most commands is forgotten.
class ControlSources {
 public:
  static constexpr std::size_t kMost = 256;

  /// True if this number of this source is newer than all that were taken of it.
  [[nodiscard]] bool take(const std::string& source, std::uint64_t number) {
    const auto known = sources_.find(source);
    if (known == sources_.end() && sources_.size() >= kMost) forget_oldest();
    if (known != sources_.end() && number <= known->second.number) return false;
    sources_[source] = {number, ++commands_};
    return true;
  }

 private:
  struct Source {
    std::uint64_t number = 0;
    std::uint64_t last_command = 0;  ///< of all sources' commands, which one was its last
  };
  void forget_oldest() {
    sources_.erase(std::min_element(sources_.begin(), sources_.end(),
                                    [](const auto& a, const auto& b) { return a.second.last_command < b.second.last_command; }));
  }
  std::map<std::string, Source> sources_;
  std::uint64_t commands_ = 0;
};

}  // namespace constrictor
