#include "client/request_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "client/goal_reader.hpp"
#include "client/polling.hpp"
#include "client/request_writer.hpp"
#include "client/run_attachment.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/kept_samples.hpp"

namespace constrictor {
namespace {

using namespace std::chrono_literals;
constexpr auto kRepeat = 200ms;
constexpr auto kAnswerBound = 5s;
constexpr auto kSettleBound = 1s;          // a run that is faster than real time may never be quiet
constexpr auto kEventBound = 1s;           // after this time, a TaskStatus also proves the end of a goal
constexpr std::size_t kMostAnswers = 256;  // kept for callers that ask late

constexpr const char* kNoAnswerText =
    "no answer within 5 s; if the run is paused, the request is obeyed when the run resumes (constrictor resume)";

}  // namespace

struct RequestClient::Endpoints {
  Endpoints(std::uint32_t number, std::optional<dds::Domain> joined, dds_entity_t here, std::chrono::nanoseconds lease,
            bool by_hand)
      : domain_number(number),
        own(std::move(joined)),
        participant(here),
        authority(dds::Reader<msg::Authority>::member(participant, std::string(topics::kAuthority.name))),
        answer(dds::Reader<msg::RequestAnswer>::member(participant, std::string(topics::kRequestAnswer.name))),
        stops(dds::Reader<msg::StopState>::member(participant, std::string(topics::kStopState.name))),
        stop(participant, barrier_topics::kEmergencyStop),
        request(participant, lease.count(), by_hand) {}
  static std::unique_ptr<Endpoints> join(std::uint32_t number, std::chrono::nanoseconds lease, bool by_hand) {
    dds::Domain joined(number);
    const dds_entity_t here = joined.participant();
    return std::make_unique<Endpoints>(number, std::move(joined), here, lease, by_hand);
  }
  std::uint32_t domain_number;
  std::optional<dds::Domain> own;  ///< empty: the participant is the caller's
  dds_entity_t participant;
  dds::Reader<msg::Authority> authority;
  dds::Reader<msg::RequestAnswer> answer;
  dds::Reader<msg::StopState> stops;
  dds::Writer<msg::EmergencyStop> stop;
  RequestWriter request;
  std::optional<GoalReader> goals;
};

RequestClient::RequestClient(std::unique_ptr<Endpoints> endpoints, RequestClientOptions options)
    : options_(std::move(options)), endpoints_(std::move(endpoints)), sequence_(first_sequence_number()) {
  if (!options_.key) options_.key = run_key(endpoints_->domain_number);
}

RequestClient::RequestClient(std::uint32_t domain, const RequestClientOptions& options)
    : RequestClient(Endpoints::join(domain, options.lease, options.lease_by_hand), options) {}

RequestClient::RequestClient(std::int32_t participant, std::uint32_t domain, const RequestClientOptions& options)
    : RequestClient(
          std::make_unique<Endpoints>(domain, std::nullopt, participant, options.lease, options.lease_by_hand),
          options) {}

RequestClient::~RequestClient() = default;

bool RequestClient::connected() const { return endpoints_->request.heard(); }

bool RequestClient::connect(std::chrono::milliseconds bound) {
  const auto end = WaitClock::now() + bound;
  while (!connected() || !authority()) {
    if (WaitClock::now() > end || interrupted()) return false;
    std::this_thread::sleep_for(kPoll);
    poll();
  }
  // The oldest of the messages that the topic keeps arrives first: its source may have no authority any more.
  for (auto last = WaitClock::now(), settled = last + kSettleBound;
       WaitClock::now() < std::min(settled, last + dds::KeptSamples::kQuiet) && !interrupted();) {
    const auto before = authority()->header.sequence_number;
    std::this_thread::sleep_for(kPoll);
    poll();
    if (authority()->header.sequence_number != before) last = WaitClock::now();
  }
  return true;
}

bool RequestClient::connect_to_stop(std::chrono::milliseconds bound) {
  const auto end = WaitClock::now() + bound;
  while (!connected() && endpoints_->stop.readers() == 0) {
    if (WaitClock::now() > end || interrupted()) return false;
    std::this_thread::sleep_for(kPoll);
    poll();
  }
  return true;
}

void RequestClient::connect_or_throw(std::chrono::milliseconds bound) {
  if (connect(bound)) return;
  if (interrupted()) throw CommandError("interrupted before a request was sent", CommandError::Cause::kInterrupted);
  const char* missing = connected() ? "no message on topic \"authority\"" : "no reader of topic \"request/v2\"";
  throw CommandError(
      fmt::format("run {}: {} (is `input` running? see `constrictor status --run {}`)", domain(), missing, domain()),
      CommandError::Cause::kNoAnswer);
}

std::uint64_t RequestClient::ask(msg::Request request) {
  dds::set_text(request.source, options_.source);
  request.robot_id = options_.robot_id;
  request.level = options_.level;
  request.detached = options_.detached;
  request.header.sequence_number = ++sequence_;
  request.header.run_id = options_.key->run_id;
  set_text(request.token, options_.key->token);
  if (request.kind == msg::kRequestEmergencyStop) {
    take_authority();  // messages that arrived before this request cannot confirm it
    authority_.stop_asked();
    take_stop_states();
    plant_stop_.stop_asked(options_.source);
    send_to_plant(request);
  }
  unanswered_.asked(request, WaitClock::now());
  endpoints_->request.write(request);
  return sequence_;
}

std::uint64_t RequestClient::ask(std::uint8_t kind) {
  msg::Request request{};
  request.kind = kind;
  request.parameters = no_parameters();
  return ask(request);
}

std::uint64_t RequestClient::move(std::uint8_t motion, double speed_m_s, double curvature_1_m, double angle_rad) {
  msg::Request request{};
  request.kind = msg::kRequestMotion;
  request.parameters = no_parameters();
  request.motion = motion;
  request.speed_m_s = speed_m_s;
  request.curvature_1_m = curvature_1_m;
  request.angle_rad = angle_rad;
  return ask(request);
}

std::uint64_t RequestClient::start_goal(const msg::Request& request) {
  static_cast<void>(goals());
  switch (wait_for_answer(ask(request), kAnswerBound)) {
    case Answer::kGranted:
      break;
    case Answer::kRefused:
      throw CommandError("refused: " + refusal_, CommandError::Cause::kRefused);
    case Answer::kNone:
      throw CommandError(kNoAnswerText, CommandError::Cause::kNoAnswer);
    case Answer::kInterrupted:
      throw CommandError("interrupted while waiting for the answer of `input`", CommandError::Cause::kInterrupted);
  }
  const std::uint64_t goal = goal_;
  for (const auto bound = WaitClock::now() + kAnswerBound; WaitClock::now() < bound;
       std::this_thread::sleep_for(kPoll)) {
    poll();
    if (const msg::TaskEvent* answer = goals().answer(goal)) {
      if (answer->goal_state != msg::kGoalRefused) return goal;
      throw CommandError(fmt::format("refused by `navigation`: {}", answer->detail), CommandError::Cause::kRefused);
    }
    if (interrupted())
      throw CommandError("interrupted while waiting for the answer of `navigation`", CommandError::Cause::kInterrupted);
  }
  throw CommandError(
      "`input` forwarded the goal, but `navigation` did not answer within 5 s (is the run paused? see `constrictor "
      "status`)",
      CommandError::Cause::kNoAnswer);
}

GoalTracker::End RequestClient::wait_for_end(std::uint64_t goal, const std::function<void()>& each_poll) {
  const std::uint32_t epoch = goals().epoch();
  std::optional<WaitClock::time_point> status_ended;
  auto input_seen = WaitClock::now();
  for (;; std::this_thread::sleep_for(kPoll)) {
    poll();
    if (each_poll) each_poll();
    const auto now = WaitClock::now();
    if (const auto end = goals().end(goal, false)) return *end;
    // If the event is not lost, it arrives soon after the status.
    if (const auto end = goals().end(goal, true)) {
      if (!status_ended) status_ended = now;
      if (now - *status_ended > kEventBound) return *end;
    }
    if (connected()) input_seen = now;
    if (epoch != 0 && goals().epoch() != epoch) throw CommandError("the run was reset while the goal was running");
    if (now - input_seen > RunAttachment::kInputGrace)
      throw CommandError("the run has ended: `input` is gone", CommandError::Cause::kNoAnswer);
    if (interrupted()) throw CommandError("interrupted while the goal was running", CommandError::Cause::kInterrupted);
  }
}

const GoalTracker& RequestClient::goals() {
  if (!endpoints_->goals) {
    endpoints_->goals.emplace(participant());
    endpoints_->goals->poll();
  }
  return endpoints_->goals->goals();
}

bool RequestClient::release(std::chrono::milliseconds bound) {
  // wait_for_answer() would throw after an interruption, but an interrupted client must still return authority.
  const std::uint64_t number = ask(msg::kRequestRelease);
  const auto end = WaitClock::now() + bound;
  while (!answer(number) && WaitClock::now() < end) {
    std::this_thread::sleep_for(kPoll);
    poll();
  }
  const msg::RequestAnswer* answered = answer(number);
  return answered ? answered->granted || !holds_authority() : false;
}

void RequestClient::assert_alive() const {
  if (options_.lease_by_hand) endpoints_->request.assert_alive();
}

void RequestClient::flush() const { endpoints_->request.flush(std::chrono::nanoseconds(1s).count()); }

std::uint32_t RequestClient::domain() const { return endpoints_->domain_number; }
std::int32_t RequestClient::participant() const { return endpoints_->participant; }

void RequestClient::take_authority() {
  endpoints_->authority.take([this](const msg::Authority& authority) { authority_.take(authority); });
}

void RequestClient::take_stop_states() {
  endpoints_->stops.take([this](const msg::StopState& state) { plant_stop_.take(state); });
}

void RequestClient::send_to_plant(const msg::Request& stop) const {
  msg::EmergencyStop message{};
  message.robot_id = stop.robot_id;
  set_text(message.source, text_of(stop.source));
  message.sequence_number = stop.header.sequence_number;
  endpoints_->stop.write(message);
}

bool RequestClient::plant_has_received_stop() const {
  return endpoints_->stop.readers() > 0 && dds_wait_for_acks(endpoints_->stop.get(), DDS_SECS(1)) == DDS_RETCODE_OK;
}

void RequestClient::poll() {
  endpoints_->answer.take([this](const msg::RequestAnswer& answer) {
    if (options_.source != answer.source) return;
    // `input` decides on a request once. Later answers under the same number repeat this decision, without goal and
    // reason.
    answers_.try_emplace(answer.request_sequence, answer);
    if (answers_.size() > kMostAnswers) answers_.erase(answers_.begin());
    unanswered_.answered(answer.request_sequence);
  });
  take_authority();
  take_stop_states();
  const std::uint64_t stop = unanswered_.stop();
  if (stop != 0 && (authority_.stop_latched() || plant_stop_.stop_latched())) {
    msg::RequestAnswer answer{};
    answer.granted = true;  // even if another source requested the stop
    answers_.try_emplace(stop, answer);
    unanswered_.answered(stop);
  }
  if (endpoints_->goals) endpoints_->goals->poll();
  unanswered_.repeat(WaitClock::now(), kRepeat, [this](const msg::Request& request) {
    if (request.kind == msg::kRequestEmergencyStop) send_to_plant(request);
    endpoints_->request.write(request);
  });
  assert_alive();
}

bool RequestClient::holds_authority() const {
  return authority() && authority()->level == options_.level && options_.source == authority()->source;
}

const msg::RequestAnswer* RequestClient::answer(std::uint64_t number) const {
  const auto found = answers_.find(number);
  return found == answers_.end() ? nullptr : &found->second;
}

RequestClient::Answer RequestClient::wait_for_answer(std::uint64_t number, std::chrono::milliseconds bound) {
  const auto end = WaitClock::now() + bound;
  for (;; std::this_thread::sleep_for(kPoll)) {
    poll();
    if (const msg::RequestAnswer* found = answer(number)) {
      if (found->granted) goal_ = found->goal_id;
      else refusal_ = found->reason;
      return found->granted ? Answer::kGranted : Answer::kRefused;
    }
    if (interrupted()) return Answer::kInterrupted;
    if (WaitClock::now() > end) return Answer::kNone;
  }
}

}  // namespace constrictor
