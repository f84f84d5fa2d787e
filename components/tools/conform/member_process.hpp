// The process of a member of the run, as the status of the member shows it.
#pragma once

#include <cstdint>
#include <string>

#include "constrictor/messages.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor::conform {

class MemberProcess {
 public:
  /// `participant` must outlive this object. Statuses are known from some time after it was made.
  MemberProcess(dds_entity_t participant, std::string member);

  /// Takes the statuses that have arrived.
  void look();
  /// How often the process has been started in this run, as far as it is known; 0: it is not known.
  [[nodiscard]] std::uint32_t incarnation() const { return incarnation_; }
  /// Messages that the member has refused in this epoch, and the tick of the status that said so; -1: none has.
  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  [[nodiscard]] std::int64_t status_tick() const { return status_tick_; }
  [[nodiscard]] std::uint32_t status_epoch() const { return status_epoch_; }
  /// Kills the process; the launcher starts it again. Returns why not; empty: it was killed.
  [[nodiscard]] std::string kill();

 private:
  std::string member_;
  dds::Reader<msg::ComponentStatus> status_;
  std::uint32_t incarnation_ = 0, status_epoch_ = 0;
  std::uint64_t refused_ = 0;
  std::int64_t status_tick_ = -1;
  int pid_ = 0;
};

}  // namespace constrictor::conform
