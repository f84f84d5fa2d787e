// A part and its surroundings in one process, without DDS and without a clock: for tests of the conformance checks.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "barrier/local_run.hpp"
#include "conform/part_port.hpp"
#include "conform/part_stand.hpp"

namespace constrictor::testing {

class LocalPart final : public conform::PartPort, private conform::StandBoard {
 public:
  /// `part`: the factory of the part. `more`: other members; the plant first, if the surroundings have none.
  LocalPart(const std::string& part, ComponentFactory factory, const Setup& setup,
            std::vector<ComponentFactory> more = {}, long interrupt_at = 0)
      : part_(part), interrupt_at_(interrupt_at), run_(members(part, std::move(factory), std::move(more)), setup) {}

  void begin_epoch() override { run_.reset(++seed_ % 2 + 1); }
  [[nodiscard]] std::string restart() override {
    run_.restart(part_);
    ++incarnation_;
    return {};
  }
  [[nodiscard]] std::uint32_t incarnation() override { return incarnation_; }
  [[nodiscard]] std::uint64_t refused() override { return run_.member(part_).counters().refused; }

 private:
  std::vector<ComponentFactory> members(const std::string& part, ComponentFactory factory,
                                        std::vector<ComponentFactory> more) {
    for (auto& one : conform::stand_factories(conform::part_place(part), *this)) more.push_back(std::move(one));
    more.push_back(std::move(factory));
    return more;
  }
  void exchange(std::vector<conform::Letter> outgoing) override {
    if (interrupt_at_ > 0 && ++advances_ == interrupt_at_) throw conform::PartGone("interrupted");
    outgoing_ = std::move(outgoing);
    if (run_.advance(1) != 1) throw conform::PartGone("the run has ended");
  }
  void begin_tick(const Tick&) override {}
  std::vector<Sample> take(std::size_t topic) override {
    std::vector<Sample> taken;
    std::erase_if(outgoing_, [&](const conform::Letter& letter) {
      if (letter.topic == topic) taken.push_back(letter.sample);
      return letter.topic == topic;
    });
    return taken;
  }
  void deliver(const Tick& tick, std::vector<conform::Letter> arrived) override {
    arrived_ = std::move(arrived);
    tick_ = tick.index;
    epoch_ = tick.epoch;
  }
  [[nodiscard]] bool finished() const override { return false; }

  std::string part_;
  long interrupt_at_, advances_ = 0;
  std::uint64_t seed_ = 0;
  std::uint32_t incarnation_ = 1;
  std::vector<conform::Letter> outgoing_;
  LocalRun run_;
};

}  // namespace constrictor::testing
