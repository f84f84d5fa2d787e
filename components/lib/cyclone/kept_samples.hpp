// When the samples that writers keep for late readers have arrived at a new reader.
#pragma once

#include <chrono>
#include <cstdint>

namespace constrictor::dds {

/// A writer sends the samples that it keeps one after the other, the oldest first; a program that wants the newest must
/// wait for the last of them. They have arrived when a sample arrives that was written after the reader began, or when
/// none has arrived for a moment. Only now_ns() reads a clock; the other functions get times as arguments.
class KeptSamples {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// They arrive within this time of each other.
  static constexpr std::chrono::milliseconds kQuiet{50};

  /// `begun_ns`: when the reader began [ns since 1970], in the same clock as the writers' times.
  explicit KeptSamples(std::int64_t begun_ns) : begun_ns_(begun_ns) {}
  /// A sample arrived; `source_time_ns`: when it was written.
  void arrived(std::int64_t source_time_ns, Time now) {
    complete_ = complete_ || source_time_ns > begun_ns_;
    last_ = now;
    any_ = true;
  }
  /// True if the newest sample is among those that have arrived. False before the first sample.
  [[nodiscard]] bool complete(Time now) const { return any_ && (complete_ || now - last_ > kQuiet); }

  /// The time of day [ns since 1970], for the constructor.
  static std::int64_t now_ns() {
    const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count();
  }

 private:
  std::int64_t begun_ns_;
  bool complete_ = false;
  bool any_ = false;
  Time last_{};
};

}  // namespace constrictor::dds
