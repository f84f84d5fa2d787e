// The conductor's answers to commands on `run_control`, by source. Without DDS and clock.
#pragma once

#include <algorithm>
#include <cereal/cereal.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/string.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Keeps the newest answer for each source. Each process that sends commands is a source of its own, so a long run has
/// many of them: if there are more than kMost, the source whose last answer is the oldest is removed.
class RunControlAnswers {
 public:
  static constexpr std::size_t kMost = 256;

  /// The answer that was given to this command before; null if the command is new, or its answer is no longer kept.
  [[nodiscard]] const msg::RunControlAnswer* given(const msg::RunControl& command) const {
    const auto source = sources_.find(command.source);
    if (source == sources_.end() || source->second.answer.sequence_number != command.sequence_number) return nullptr;
    return &source->second.answer;
  }
  /// Number of the newest answered command of a source; 0 if no command of this source was answered.
  [[nodiscard]] std::uint64_t newest(const std::string& source) const {
    const auto known = sources_.find(source);
    return known == sources_.end() ? 0 : known->second.answer.sequence_number;
  }
  /// Keeps an answer, unless a command of this source with a higher number has been answered already.
  void keep(const msg::RunControlAnswer& answer) {
    if (answer.sequence_number <= newest(answer.source)) return;
    if (sources_.size() >= kMost && !sources_.contains(answer.source)) remove_oldest();
    sources_[answer.source] = {answer, ++answers_};
  }

  /// The answers and their order. Answers are plain structs: only the same release can read them.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(sources_, answers_);
  }

 private:
  struct Source {
    msg::RunControlAnswer answer{};
    std::uint64_t order = 0;  ///< position of its newest answer among all answers
    template <class Archive>
    void serialize(Archive& archive) {
      auto bytes = cereal::binary_data(&answer, sizeof answer);
      archive(bytes, order);
    }
  };
  void remove_oldest() {
    sources_.erase(std::min_element(sources_.begin(), sources_.end(),
                                    [](const auto& a, const auto& b) { return a.second.order < b.second.order; }));
  }
  std::map<std::string, Source> sources_;
  std::uint64_t answers_ = 0;
};

}  // namespace constrictor
