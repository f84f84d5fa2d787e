// Where requests from outside the run (operators, external planners) enter it. Any thread adds; the input layer takes everything
// at a tick boundary, in an order that does not depend on arrival.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

/// The writer through which a source speaks, by its DDS GUID. All zeros: unknown, nothing is concluded from it.
using WriterId = std::array<std::uint8_t, 16>;

/// A request from outside, or the news that a source is gone.
struct OutsideItem {
  std::string source;
  bool died = false;        ///< the source's writer is gone or lost its liveliness; `request` is empty then
  msg::Request request{};
  WriterId writer{};        ///< who wrote it, or who died
  std::string refusal;      ///< not empty: not to be ruled on, but refused for this reason
  std::uint32_t times = 1;  ///< of a refusal: how many requests it stands for
};

/// A source that was ruled on before and is not known to be dead.
struct LivingSource {
  std::string source;
  WriterId writer{};
};

/// The latch. What is taken at a tick was added before it; refusals first, then the strongest level first, then by source, writer
/// (in the order in which they came) and sequence_number, deaths last.
///
/// What is kept between two ticks is bounded for each source and in all, apart for emergency stops (1 and 8), for what only
/// makes the robot stand or gives it back (release, clear stop, stand: 4 and 16), and for everything else (12 and 48). The newest
/// wins: when a source has no room left its oldest motion goes, else its oldest request; when there is none at all, the oldest of
/// the lowest level. What goes is refused. A request that is repeated under its number before the tick counts once.
class OutsideRequests {
 public:
  static constexpr std::size_t kMostRefusals = 20;  ///< answered between two ticks; further ones are only counted

  void add(const msg::Request& request, const WriterId& writer = {});
  /// One that is not fit to be ruled on.
  void add_refused(const msg::Request& request, const std::string& reason);
  void add_death(const std::string& source);
  /// `lives(writer)`: whether a writer is there, or may still be found. Asked in latch(). Without it every writer lives.
  void watch_writers(std::function<bool(const WriterId&)> lives);
  /// Everything since the last call, in order. `living`: whoever of these has no living writer is among the dead; also one that
  /// died while nobody listened, because the process that did was being restarted.
  [[nodiscard]] std::vector<OutsideItem> latch(const std::vector<LivingSource>& living = {});
  /// How many requests found no room.
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  void drop(OutsideItem item);
  void refuse(OutsideItem item, const std::string& reason);

  mutable std::mutex mutex_;
  std::vector<OutsideItem> items_;      ///< in the order of their arrival
  std::vector<OutsideItem> refused_;
  std::uint64_t dropped_ = 0;
  std::function<bool(const WriterId&)> lives_;
};

}  // namespace constrictor
