// A process that is not part of a run and sends impossible barrier messages.
#pragma once

#include <unistd.h>

#include <limits>
#include <string>

#include "constrictor/topics.hpp"
#include "cyclone/endpoint.hpp"
#include "runtime/wire.hpp"

namespace constrictor::testing {

/// Sends messages whose types are correct and whose values are impossible, or belong to another run.
class Stranger {
 public:
  explicit Stranger(dds_entity_t participant)
      : hello_(participant, barrier_topics::kHello, 64),
        ready_(participant, barrier_topics::kReady, 64),
        done_(participant, barrier_topics::kTickDone, 64),
        epoch_(participant, barrier_topics::kEpochStart, 8),
        tick_(participant, barrier_topics::kTick, 8),
        resume_(participant, barrier_topics::kResume, 8),
        refused_(participant, barrier_topics::kRefused, 8),
        state_(participant, barrier_topics::kRunState, 8),
        control_(participant, barrier_topics::kRunControl, 8) {}

  [[nodiscard]] bool matched_members() const {
    return epoch_.readers() > 3 && tick_.readers() > 3 && resume_.readers() > 3;
  }
  [[nodiscard]] bool matched() const {
    return matched_members() && hello_.readers() > 4 && ready_.readers() > 0 && done_.readers() > 0;
  }
  void learn(const msg::RunState& run) { run_ = run; }
  void send_all() {
    send_hellos();
    for (const char* name : {"navigation", "planner", "physics", "nobody", ""}) {
      for (const std::uint64_t run_id : {run_.run_id, run_.run_id + 1, std::uint64_t{0}}) {
        for (const std::uint32_t incarnation : {0u, 1u, 2u, std::numeric_limits<std::uint32_t>::max()}) {
          msg::Ready ready{};
          dds::set_text(ready.component, name);
          ready.run_id = run_id;
          ready.epoch = run_.epoch;
          ready.incarnation = incarnation;
          ready_.write(ready);
          send_done(name, run_id, incarnation);
        }
      }
    }
    command();
  }

  /// Sends the message with which the conductor of another run refuses a process.
  void refuse(const char* name, pid_t pid) {
    msg::Refused refused{};
    dds::set_text(refused.component, name);
    refused.run_id = run_.run_id + 1;
    refused.incarnation = 1;
    refused.pid = pid;
    ::gethostname(refused.host, sizeof refused.host - 1);
    refused_.write(refused);
  }
  /// Sends a conductor's messages: of another run, or with impossible values.
  void command() {
    msg::EpochStart epoch{};
    epoch.run_id = run_.run_id + 1;
    epoch.epoch = 9;
    epoch_.write(epoch);
    epoch.run_id = run_.run_id;
    epoch.epoch = 0;
    epoch_.write(epoch);
    msg::Tick tick{};
    tick.run_id = run_.run_id + 1;
    tick.index = std::numeric_limits<std::int64_t>::max();
    tick.final_tick = true;
    tick_.write(tick);
    tick.run_id = run_.run_id;
    tick.epoch = run_.epoch;
    tick.index = -5;
    tick.final_tick = false;
    tick_.write(tick);
    std::string block = "garbage";
    msg::Resume resume{};
    dds::set_text(resume.component, "navigation");
    resume.incarnation = 1;
    resume.index = std::numeric_limits<std::int64_t>::max();
    resume.checkpoint = {7, 7, reinterpret_cast<std::uint8_t*>(block.data()), false};
    resume_.write(resume);
    msg::RunState state{};
    state.run_id = run_.run_id + 1;
    state.pace = std::numeric_limits<double>::quiet_NaN();
    state_.write(state);
    msg::RunControl control{};
    dds::set_text(control.source, "stranger");
    control.sequence_number = 1;
    control.command = 200;
    control.pace = std::numeric_limits<double>::infinity();
    control_.write(control);
  }

 private:
  void send_done(const char* name, std::uint64_t run_id, std::uint32_t incarnation) {
    const auto done_at = [&](std::int64_t index) {
      msg::TickDone done{};
      dds::set_text(done.component, name);
      done.run_id = run_id;
      done.epoch = run_.epoch;
      done.incarnation = incarnation;
      done.index = index;
      return done;
    };
    for (const std::int64_t index : {std::numeric_limits<std::int64_t>::min(), std::int64_t{-1}, std::int64_t{1} << 40,
                                     std::numeric_limits<std::int64_t>::max()}) {
      msg::TickDone done = done_at(index);
      done_.write(done);
      done.published_count = done.consumed_count = 255;
      done_.write(done);
    }
    // For the current tick: damaged checkpoints, huge lengths, and topics that the member does not write.
    std::string endless(8, '\xff');
    for (std::string block :
         {std::string("x"), endless, endless + endless, std::string(8, '\0') + endless, std::string(16, '\0') + "x"}) {
      msg::TickDone done = done_at(run_.tick);
      done.checkpoint = {static_cast<std::uint32_t>(block.size()), static_cast<std::uint32_t>(block.size()),
                         reinterpret_cast<std::uint8_t*>(block.data()), false};
      done_.write(done);
    }
    for (std::int64_t index = run_.tick - 2; index < run_.tick + 14; ++index) {
      msg::TickDone done = done_at(index);
      done.published_count = 2;
      done.published[0] = {63, 1};
      done.published[1] = {topics::kMissionStatus.id, std::numeric_limits<std::uint64_t>::max()};
      done_.write(done);
    }
  }
  void send_hellos() {
    for (const char* name : {"planner", "navigation", "nobody", ""}) {
      msg::Hello hello{};
      dds::set_text(hello.component, name);
      hello.incarnation = 1000;
      hello.pid = -1;
      hello.reads = hello.writes = ~std::uint64_t{0};
      hello_.write(hello);  // without period and latency
      hello.period_ticks = hello.latency_ticks = 1;
      hello_.write(hello);  // with the hashes of another IDL and another configuration
    }
  }
  msg::RunState run_{};
  dds::Writer<msg::Hello> hello_;
  dds::Writer<msg::Ready> ready_;
  dds::Writer<msg::TickDone> done_;
  dds::Writer<msg::EpochStart> epoch_;
  dds::Writer<msg::Tick> tick_;
  dds::Writer<msg::Resume> resume_;
  dds::Writer<msg::Refused> refused_;
  dds::Writer<msg::RunState> state_;
  dds::Writer<msg::RunControl> control_;
};

}  // namespace constrictor::testing
