#include "client/run_monitor.hpp"

#include <utility>

#include "constrictor/topics.hpp"
#include "cyclone/domain_claim.hpp"

namespace constrictor {
namespace {

constexpr std::chrono::milliseconds kClaimEvery{200};

}  // namespace

RunMonitor::RunMonitor(const RunNote& run, std::int32_t participant)
    : run_(run),
      states_(dds::Reader<msg::RunState>::member(participant, barrier_topics::kRunState)),
      statuses_(dds::Reader<msg::ComponentStatus>::member(participant, barrier_topics::kStatus)),
      input_(dds::Reader<msg::Authority>::observer(participant, std::string(topics::kAuthority.name))) {}

void RunMonitor::poll() {
  const auto now = RunAttachment::Clock::now();
  if (run_.on_this_host && now - claim_looked_at_ > kClaimEvery) {
    claim_looked_at_ = now;
    signs_.launcher = domain_claimed(run_.domain);
  }
  states_.take([this](const msg::RunState& state) {
    signs_.run_id = state.run_id;
    ++signs_.states_heard;
    if (!state_ || state_->run_id == state.run_id) state_ = state;
  });
  statuses_.take([this](const msg::ComponentStatus& status) {
    if (state_ && status.run_id == state_->run_id && run_.plant == status.component)
      signs_.plant_ended = status.state == msg::kComponentEnded;
  });
  input_.take([](const msg::Authority&) {});
  signs_.input = input_.writers() > 0;
  attachment_.look(signs_, now);
}

}  // namespace constrictor
