#include "cli/operator_client.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <limits>
#include <thread>
#include <utility>

#include "runtime/dds/domain.hpp"
#include "runtime/dds/outside_link.hpp"
#include "runtime/topics.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
constexpr auto kPoll = 10ms;
constexpr auto kRepeat = 200ms;
constexpr std::size_t kMostAnswers = 256;  // kept for those who ask late

}  // namespace

struct OperatorClient::Endpoints {
  Endpoints(std::uint32_t number, std::chrono::nanoseconds lease)
      : domain(number),
        authority(dds::Reader<msg::Authority>::member(domain.participant(), std::string(topics::kAuthority.name))),
        answer(dds::Reader<msg::RequestAnswer>::member(domain.participant(), std::string(topics::kRequestAnswer.name))),
        request(domain.participant(), lease.count()) {}
  dds::Domain domain;
  dds::Reader<msg::Authority> authority;
  dds::Reader<msg::RequestAnswer> answer;
  dds::RequestWriter request;
};

OperatorClient::OperatorClient(std::uint32_t domain, std::string source, std::chrono::milliseconds lease, bool detached)
    : source_(std::move(source)), detached_(detached), endpoints_(std::make_unique<Endpoints>(domain, lease)) {
  // Rising also from one process of this name to the next.
  sequence_ = static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch()).count());
}

OperatorClient::~OperatorClient() = default;

bool OperatorClient::connect(std::chrono::milliseconds bound) {
  const auto end = Clock::now() + bound;
  while (!endpoints_->request.heard() || !authority()) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(kPoll);
    poll();
  }
  return true;
}

std::uint64_t OperatorClient::ask(msg::Request request) {
  dds::set_text(request.source, source_);
  request.robot_id = 1;
  request.level = msg::kAuthorityOperator;
  request.detached = detached_;
  request.header.sequence_number = ++sequence_;
  if (request.kind == msg::kRequestEmergencyStop) {
    take_authority();  // what is here already is no answer
    authority_.stop_asked();
  }
  unanswered_.asked(request, Clock::now());
  endpoints_->request.write(request);
  return sequence_;
}

std::uint64_t OperatorClient::ask(std::uint8_t kind) {
  msg::Request request{};
  request.kind = kind;
  return ask(request);
}

std::uint64_t OperatorClient::move(std::uint8_t motion, double frequency_hz, double curvature_1_m, double angle_rad) {
  msg::Request request{};
  request.kind = msg::kRequestMotion;
  request.motion = motion;
  request.frequency_hz = frequency_hz;
  request.curvature_1_m = curvature_1_m;
  request.angle_rad = angle_rad;
  return ask(request);
}

std::uint64_t OperatorClient::start(std::uint8_t task, const msg::TaskParameters& parameters) {
  msg::Request request{};
  request.kind = msg::kRequestTask;
  request.command = msg::kCommandStart;
  request.task = task;  // goal_id 0: input numbers it
  request.parameters = parameters;
  return ask(request);
}

void OperatorClient::assert_alive() const { endpoints_->request.assert_alive(); }

void OperatorClient::flush() const { endpoints_->request.flush(std::chrono::nanoseconds(1s).count()); }

std::int32_t OperatorClient::participant() const { return endpoints_->domain.participant(); }

void OperatorClient::take_authority() {
  endpoints_->authority.take([this](const msg::Authority& authority) { authority_.take(authority); });
}

void OperatorClient::poll() {
  endpoints_->answer.take([this](const msg::RequestAnswer& answer) {
    if (source_ != answer.source) return;
    answers_.try_emplace(answer.request_sequence, answer);  // a request is answered once: what comes later under its number is a repetition
    if (answers_.size() > kMostAnswers) answers_.erase(answers_.begin());
    unanswered_.answered(answer.request_sequence);
  });
  take_authority();
  if (const std::uint64_t stop = unanswered_.stop(); stop != 0 && authority_.stop_latched()) {
    msg::RequestAnswer answer{};
    answer.granted = true;  // whoever's word it was
    answers_.try_emplace(stop, answer);
    unanswered_.answered(stop);
  }
  unanswered_.repeat(Clock::now(), kRepeat, [this](const msg::Request& request) { endpoints_->request.write(request); });
}

bool OperatorClient::holds_authority() const {
  return authority() && authority()->level == msg::kAuthorityOperator && source_ == authority()->source;
}

OperatorClient::Answer OperatorClient::wait_for_answer(std::uint64_t number, std::chrono::milliseconds bound) {
  const auto end = Clock::now() + bound;
  for (;;) {
    poll();
    if (const auto answer = answers_.find(number); answer != answers_.end()) {
      if (answer->second.granted) goal_ = answer->second.goal_id;
      else refusal_ = answer->second.reason;
      return answer->second.granted ? Answer::kGranted : Answer::kRefused;
    }
    if (Clock::now() > end) return Answer::kNone;
    assert_alive();
    std::this_thread::sleep_for(kPoll);
  }
}

std::string unique_source(const std::string& what) {
  char host[64] = {};
  ::gethostname(host, sizeof(host) - 1);
  return fmt::format("{}.{:.12}.{}", what, host, ::getpid());
}

msg::TaskParameters no_parameters() {
  msg::TaskParameters parameters{};
  parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
  return parameters;
}

}  // namespace constrictor::cli
