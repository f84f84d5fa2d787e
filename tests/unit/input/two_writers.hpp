// Judges what `input` made of two writers of different strength that asked at once: by the order of its rulings (an answer each)
// and the requests alone, not by the arbiter.
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
  /// A task start, a motion or a release; of an operator or of an external planner, each with a name of its own.
  void asked(const msg::Request& r) { asked_[{r.source, r.header.sequence_number}] = r; }
  // What came out, each in the order of its writing.
  void heard(const msg::RequestAnswer& m) { at_[m.header.tick].answers.push_back(m); }
  void heard(const msg::TaskCommand& m) {
    if (m.command == msg::kCommandStart) at_[m.header.tick].starts.push_back(m.goal_id);
  }
  void heard(const msg::MotionCommand& m) { at_[m.header.tick].motions.push_back(m.level); }
  void heard(const msg::Authority& m) { at_[m.header.tick].authority.push_back(m.level); }

  /// Both were never obeyed: while the operator holds nothing of the other goes on, and in a tick in which it releases all that is
  /// obeyed of the one comes before the release's ruling, and all of the other after it.
  void judge() {
    for (const auto& [tick, now] : at_) {
      SCOPED_TRACE(::testing::Message() << "tick " << tick);
      std::vector<std::uint64_t> starts;          // that must go on, in this order
      std::vector<std::uint8_t> motion;           // that must go on as the last word, or none
      bool external_spoke = false;
      bool operator_obeyed = false;
      for (const auto& answer : now.answers) {
        const auto known = asked_.find({answer.source, answer.request_sequence});
        ASSERT_NE(known, asked_.end()) << answer.source << " " << answer.request_sequence;
        const msg::Request& r = known->second;
        ++answered;
        const bool by_operator = r.level == msg::kAuthorityOperator;
        if (by_operator) {
          EXPECT_FALSE(external_spoke) << "the stronger is ruled on first";
        } else {
          external_spoke = true;
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
        holder_ = r.level;  // also by a task that finds no room in this tick
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
      EXPECT_EQ(now.starts, starts) << "one by one, in the order of the rulings";
      // A motion of an earlier tick ends at a release, without one of this tick: stand.
      const std::vector<std::uint8_t> stand{msg::kAuthorityNone};
      EXPECT_TRUE(now.motions == motion || (motion.empty() && now.motions == stand)) << "motions: " << now.motions.size();
      if (now.answers.empty() && now.authority.empty()) continue;
      EXPECT_EQ(now.authority, std::vector{holder_}) << "it is said in each tick of a ruling";
    }
  }

  int answered = 0;
  int of_operator = 0;          ///< obeyed
  int of_external = 0;
  int refused_to_external = 0;
  int ticks_of_both = 0;        ///< one after the other, with a release between

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
