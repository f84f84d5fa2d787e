// The latch through which requests of clients enter a run. Any thread adds a request; `input` takes all of them at a
// tick boundary, in an order that does not depend on their arrival.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

/// GUID of the DDS writer through which a source sends. All zeros: unknown.
using WriterId = std::array<std::uint8_t, 16>;

/// A request of a client, or the death of a source.
struct ClientEvent {
  std::string source;
  bool died = false;  ///< the source's writer has gone or has lost its liveliness; `request` is empty then
  msg::Request request{};
  WriterId writer{};        ///< of the request, or the one that died
  std::string refusal;      ///< not empty: `input` must refuse the request for this reason
  std::uint32_t times = 1;  ///< of a refusal: how many requests it stands for
};

/// A source whose requests were answered before and that is not known to be dead.
struct LivingSource {
  std::string source;
  WriterId writer{};
};

/// Order of what latch() returns: refusals, then requests, then deaths. Requests are ordered by level (highest first),
/// source, writer (in the order of their first requests) and sequence_number.
///
/// Three pools bound what is kept between two ticks, for each source and for all sources: emergency stops (1 and 8);
/// release, clear stop and stand, which let the robot stand (4 and 16); all other requests (12 and 48). If a source has
/// filled its share of a pool, its oldest motion is dropped, or its oldest request if it has no motion there. If the
/// pool is full, the oldest request of the lowest level is dropped. Dropped requests are refused, stops excepted. A
/// request that is repeated with its sequence number before the tick counts once.
class ClientRequests {
 public:
  static constexpr std::size_t kMostRefusals =
      20;  ///< refusals between two ticks that are answered one by one; more are only counted

  static constexpr std::size_t kMostStrangers = 4;

  void add(const msg::Request& request, const WriterId& writer = {});
  /// Adds an invalid request, which `input` must refuse.
  void add_refused(const msg::Request& request, const std::string& reason);
  /// Adds a request of a process that may not command the run. `input` refuses at most kMostStrangers of them between
  /// two ticks, so that strangers cannot use up the answers to refused requests of others.
  void add_stranger(const msg::Request& request, const std::string& reason);
  void add_death(const std::string& source);
  /// latch() calls `lives(writer)`, which returns whether the writer is alive or may still be discovered. Without it,
  /// all writers count as alive.
  void check_writers_with(std::function<bool(const WriterId&)> lives);
  /// Takes everything that was added since the last call. Sources of `living` whose writer is no longer alive are
  /// reported as dead, also if they died while the process of `input` was being restarted.
  [[nodiscard]] std::vector<ClientEvent> latch(const std::vector<LivingSource>& living = {});
  /// How many requests were dropped because a pool was full.
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  void drop(ClientEvent item);
  void refuse(ClientEvent item, const std::string& reason);

  mutable std::mutex mutex_;
  std::vector<ClientEvent> items_;  ///< in the order of their arrival
  std::vector<ClientEvent> refused_;
  std::size_t strangers_ = 0;  ///< since the last latch()
  std::uint64_t dropped_ = 0;
  std::function<bool(const WriterId&)> lives_;
};

}  // namespace constrictor
