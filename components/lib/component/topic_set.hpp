// A set of member topics.
#pragma once

#include <cstddef>
#include <cstdint>

#include "constrictor/topics.hpp"

namespace constrictor {

/// On the wire (`Hello.reads`, `Hello.writes`) a set is a bit mask: bit i stands for the topic with id i.
class TopicSet {
 public:
  constexpr TopicSet() = default;
  [[nodiscard]] static constexpr TopicSet from_bits(std::uint64_t bits) { return TopicSet(bits); }
  template <class... Topics>
  [[nodiscard]] static constexpr TopicSet of(const Topics&... topic) {
    TopicSet set;
    (set.insert(topic.id), ...);
    return set;
  }

  /// False for an id that no topic has.
  [[nodiscard]] constexpr bool contains(std::size_t id) const { return id < msg::kMaxTopics && (bits_ >> id & 1) != 0; }
  /// `id` must be below msg::kMaxTopics.
  constexpr void insert(std::size_t id) { bits_ |= std::uint64_t{1} << id; }
  constexpr void erase(std::size_t id) { bits_ &= ~(std::uint64_t{1} << id); }
  [[nodiscard]] constexpr bool empty() const { return bits_ == 0; }
  [[nodiscard]] constexpr std::uint64_t bits() const { return bits_; }
  constexpr TopicSet& operator|=(TopicSet other) {
    bits_ |= other.bits_;
    return *this;
  }
  constexpr bool operator==(const TopicSet&) const = default;

 private:
  constexpr explicit TopicSet(std::uint64_t bits) : bits_(bits) {}
  std::uint64_t bits_ = 0;
};

}  // namespace constrictor
