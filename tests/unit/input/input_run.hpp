// The component `input` in a run with a plant that measures nothing and a scripted planner.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "barrier/local_run.hpp"
#include "input/input.hpp"
#include "requests.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {

/// Requests of the planner by tick.
using Script = std::map<std::int64_t, std::vector<msg::Request>>;

/// A run of `input`, a plant that measures nothing, and a planner that writes its requests by tick.
inline std::vector<ComponentFactory> members(std::shared_ptr<ClientRequests> clients, const Script& script) {
  return {testing::idle_plant(), make_input_factory(std::move(clients)),
          testing::scripted_writer<msg::Request>("planner", topics::kPlannerRequest,
                                                 [script](const Tick& tick, const auto& out) {
                                                   const auto entry = script.find(tick.index);
                                                   if (entry == script.end()) return;
                                                   for (const auto& wanted : entry->second) out.write(wanted);
                                                 })};
}

class InputMemberTest : public ::testing::Test {
 protected:
  void run(const Script& script, std::int64_t ticks, std::map<std::int64_t, std::function<void()>> at = {}) {
    clients_ = std::make_shared<ClientRequests>();
    LocalRun local(members(clients_, script), constrictor::Setup{});
    local.subscribe(topics::kTaskCommand,
                    std::function<void(const msg::TaskCommand&)>([&](const auto& m) { commands_.push_back(m); }));
    local.subscribe(topics::kAuthority,
                    std::function<void(const msg::Authority&)>([&](const auto& m) { authority_.push_back(m); }));
    local.subscribe(topics::kRequestAnswer,
                    std::function<void(const msg::RequestAnswer&)>([&](const auto& m) { answers_.push_back(m); }));
    local.subscribe(topics::kMotionCommand,
                    std::function<void(const msg::MotionCommand&)>([&](const auto& m) { motions_.push_back(m); }));
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
      if (const auto entry = at.find(tick); entry != at.end()) entry->second();
      local.advance(1);
    }
  }
  static msg::Request task(std::uint64_t goal) { return request("planner", kPlanner, msg::kRequestTask, 0, goal); }

  std::shared_ptr<ClientRequests> clients_;
  std::vector<msg::TaskCommand> commands_;
  std::vector<msg::MotionCommand> motions_;
  std::vector<msg::Authority> authority_;
  std::vector<msg::RequestAnswer> answers_;
};

}  // namespace constrictor
