// Checks the outputs of `input` for two writers of different levels that send requests at the same time. The check uses
// the requests and the order of the answers, not the arbiter.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

class TwoWriters {
 public:
  /// A start of a task, a motion or a release, of an operator or an external planner with different names.
  void add_request(const msg::Request& r) { asked_[{r.source, r.header.sequence_number}] = r; }
  // The outputs of `input`, each topic in the order of its samples.
  void add(const msg::RequestAnswer& m) { at_[m.header.tick].answers.push_back(m); }
  void add(const msg::TaskCommand& m) {
    if (m.command == msg::kCommandStart) at_[m.header.tick].starts.push_back(m.goal_id);
  }
  void add(const msg::MotionCommand& m) { at_[m.header.tick].motions.push_back(m.level); }
  void add(const msg::Authority& m) { at_[m.header.tick].authority.push_back(m.level); }

  /// Expects that the two sources are never both obeyed: while the operator has authority, every request of the planner
  /// is refused. In a tick with a release, all granted requests of the operator come before it, and all of the planner
  /// after it.
  void check() {
    for (const auto& [tick, now] : at_) {
      SCOPED_TRACE(::testing::Message() << "tick " << tick);
      std::vector<std::uint64_t> starts;  // goals that must be started, in this order
      std::vector<std::uint8_t> motion;   // the last motion, which must be sent; empty: none
      bool external_came = false;
      bool operator_obeyed = false;
      for (const auto& answer : now.answers) {
        const auto known = asked_.find({answer.source, answer.request_sequence});
        ASSERT_NE(known, asked_.end()) << answer.source << " " << answer.request_sequence;
        const msg::Request& r = known->second;
        ++answered;
        const bool by_operator = r.level == msg::kAuthorityOperator;
        if (by_operator) {
          EXPECT_FALSE(external_came) << "the operator's requests come first";
        } else {
          external_came = true;
          refused_to_external += !answer.granted;
        }
        if (r.kind == msg::kRequestRelease) {
          EXPECT_EQ(answer.granted, holder_ == r.level) << answer.reason;
          if (!answer.granted) continue;
          holder_ = msg::kAuthorityNone;
          if (!motion.empty()) motion = {msg::kAuthorityNone};  // stand
          continue;
        }
        if (!by_operator && holder_ == msg::kAuthorityOperator) {
          EXPECT_FALSE(answer.granted) << "the operator holds authority";
          continue;
        }
        holder_ = r.level;  // also by a task that exceeds the limit of the tick
        if (!answer.granted) {
          EXPECT_NE(std::string(answer.reason).find("task commands in a tick"), std::string::npos) << answer.reason;
          continue;
        }
        ++(by_operator ? of_operator : of_external);
        ticks_of_both += !by_operator && std::exchange(operator_obeyed, false);
        operator_obeyed = operator_obeyed || by_operator;
        if (r.kind == msg::kRequestMotion) {
          motion = {r.level};
        } else {
          EXPECT_EQ(answer.goal_id >> 48, r.level);
          starts.push_back(answer.goal_id);
          motion.clear();  // the task ends it
        }
      }
      EXPECT_EQ(now.starts, starts) << "tasks must be started in the order of the answers";
      // A release ends a motion of an earlier tick: stand.
      const std::vector<std::uint8_t> stand{msg::kAuthorityNone};
      EXPECT_TRUE(now.motions == motion || (motion.empty() && now.motions == stand))
          << "motions: " << now.motions.size();
      if (now.answers.empty() && now.authority.empty()) continue;
      EXPECT_EQ(now.authority, std::vector{holder_}) << "written in each tick with an answer";
    }
  }

  int answered = 0;
  int of_operator = 0;  ///< granted requests
  int of_external = 0;
  int refused_to_external = 0;
  int ticks_of_both = 0;  ///< with granted requests of both, and a release between

 private:
  struct Tick {
    std::vector<msg::RequestAnswer> answers;
    std::vector<std::uint64_t> starts;
    std::vector<std::uint8_t> motions;
    std::vector<std::uint8_t> authority;
  };
  std::map<std::pair<std::string, std::uint64_t>, msg::Request> asked_;
  std::map<std::int64_t, Tick> at_;
  std::uint8_t holder_ = msg::kAuthorityNone;
};

}  // namespace constrictor
