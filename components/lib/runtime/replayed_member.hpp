// One component of a replay: it is fed by the messages of a recording, in the order of the file.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "barrier/member.hpp"
#include "runtime/component_replay.hpp"

namespace constrictor {

/// The requests of clients in a recording, by source and sequence number.
using RecordedRequests = std::map<std::pair<std::string, std::uint64_t>, msg::Request>;

class ReplayedMember : private MemberSink {
 public:
  /// Receives each sample that the member publishes.
  using OnPublish = std::function<void(const TopicInfo&, const Sample&)>;

  /// `pixels`: whether the recording has the pixels of images. `requests` must outlive this object.
  ReplayedMember(ComponentFactory factory, Setup setup, bool pixels, const RecordedRequests& requests,
                 OnPublish on_publish);

  [[nodiscard]] const Member& member() const { return *member_; }
  void take(const msg::EpochStart& start);
  void take(const msg::Tick& tick);
  /// A step that the member has finished in the run.
  void take(const TickDone& done);
  /// A message that this member reads.
  void take_input(std::uint8_t topic, const Sample& sample);
  /// A message that this member wrote in the run.
  void take_output(std::uint8_t topic, const std::string& canonical);
  /// Lets the component do what it does at the end of a run, after its last step.
  void conclude();
  [[nodiscard]] ReplayResult result() const;

 private:
  // MemberSink
  void publish(const TopicInfo& topic, const Sample& sample) override;
  void done(const TickDone& done) override { replayed_done_ = done; }

  [[nodiscard]] bool over() const { return result_.difference || !result_.stopped.empty(); }
  void advance();
  /// Delivers what the step has consumed. Returns false if a sample has not been read yet.
  [[nodiscard]] bool deliver(const TickDone& done);
  void add_requests(std::int64_t tick);
  void add_stops(std::int64_t tick);
  void compare();
  /// Notes a message up to this tick that only the run or only the replay has.
  void find_missing(std::int64_t tick);
  void compare(std::uint8_t topic, const std::string& recorded, const std::string& replayed);

  bool pixels_;
  const RecordedRequests& requests_;
  OnPublish on_publish_;
  std::unique_ptr<Member> member_;
  std::uint16_t robot_id_;
  bool is_plant_ = false;
  std::map<std::int64_t, msg::Tick> ticks_;
  msg::Tick newest_tick_{};
  std::deque<TickDone> dones_;  ///< not replayed yet
  std::optional<TickDone> replayed_done_;
  std::array<std::deque<Sample>, topics::kCount> inputs_;         ///< not delivered yet
  std::array<std::uint64_t, topics::kCount> delivered_{};         ///< newest sequence number
  std::array<std::deque<std::string>, topics::kCount> recorded_;  ///< outputs, not compared yet
  std::array<std::deque<std::string>, topics::kCount> replayed_;
  std::deque<msg::RequestAnswer> answers_;  ///< of `input`, by which it is known when it took a request
  std::deque<msg::StopState> stops_;        ///< of the plant, likewise for emergency stops
  std::uint64_t stops_received_ = 0;
  ReplayResult result_;
};

}  // namespace constrictor
