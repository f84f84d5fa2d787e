#include "conform/exchange_port.hpp"

#include <chrono>
#include <thread>
#include <utility>

#include "client/run_control_client.hpp"
#include "conform/member_process.hpp"
#include "cyclone/domain.hpp"

namespace constrictor::conform {
namespace {

using namespace std::chrono_literals;

constexpr auto kMostSilence = 30s;  // a part that sends nothing for longer counts as failed
constexpr auto kStatusBound = 3s;
constexpr std::int64_t kStatusEvery_ticks = 50;

}  // namespace

/// The topics that an operator writes and reads. Created at the first use, when the run has begun.
struct ExchangePort::Operator {
  Operator(std::uint32_t domain, const std::string& part)
      : participant(dds::create_participant(domain, dds::Reach::kLoopback, "operator")),
        process(participant.get(), part),
        control(participant.get(), domain, 10s) {}
  dds::Entity participant;
  MemberProcess process;
  RunControlClient control;
};

ExchangePort::ExchangePort(std::string part, std::uint32_t domain, bool is_served)
    : part_(std::move(part)), domain_(domain), is_served_(is_served) {}

ExchangePort::~ExchangePort() = default;

ExchangePort::Operator& ExchangePort::client() {
  if (!operator_) operator_ = std::make_unique<Operator>(domain_, part_);
  return *operator_;
}

void ExchangePort::begin_tick(const Tick&) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return awaited_ || ended_ || finished_; });
  current_.clear();
  // A reset may have dropped the last tick after its begin. The checks have then decided nothing for this one.
  if (decided_) current_ = *std::exchange(decided_, std::nullopt);
}

std::vector<Sample> ExchangePort::take(std::size_t topic) {
  const std::lock_guard lock(mutex_);
  std::vector<Sample> taken;
  std::erase_if(current_, [&](const Letter& letter) {
    if (letter.topic == topic) taken.push_back(letter.sample);
    return letter.topic == topic;
  });
  return taken;
}

void ExchangePort::deliver(const Tick& tick, std::vector<Letter> arrived) {
  const std::lock_guard lock(mutex_);
  delivered_ = std::move(arrived);
  delivered_tick_ = tick.index;
  delivered_epoch_ = tick.epoch;
  ++deliveries_;
  awaited_ = false;
  changed_.notify_all();
}

void ExchangePort::exchange(std::vector<Letter> outgoing) {
  std::unique_lock lock(mutex_);
  decided_ = std::move(outgoing);
  awaited_ = true;
  const std::uint64_t before = deliveries_;
  changed_.notify_all();
  const bool came = changed_.wait_for(lock, kMostSilence, [&] { return ended_ || deliveries_ != before; });
  if (ended_) throw PartGone("the run has ended; its log says why");
  if (!came) throw PartGone("the run makes no ticks: " + part_ + " does not finish its step");
  arrived_ = std::exchange(delivered_, {});
  tick_ = delivered_tick_;
  epoch_ = delivered_epoch_;
  client();  // early, so that its reader is matched when the first status is asked for
}

void ExchangePort::begin_epoch() {
  const std::uint32_t before = epoch_;
  Operator& person = client();
  // The conductor answers between two ticks, so the run must go on meanwhile.
  std::string refusal;
  std::atomic<bool> answered{false};
  std::thread asks([&] {
    try {
      person.control.reset(1);
    } catch (const std::exception& error) {
      refusal = error.what();
    }
    answered = true;
  });
  try {
    while (epoch_ == before && !(answered && !refusal.empty())) advance();
  } catch (...) {
    asks.join();
    throw;
  }
  asks.join();
  if (epoch_ == before) throw PartGone("no new epoch begins: " + refusal);
}

ExchangePort::Operator& ExchangePort::fresh_status() {
  Operator& person = client();
  const auto bound = std::chrono::steady_clock::now() + kStatusBound;
  const std::int64_t wanted = tick_ - kStatusEvery_ticks - 2;
  while (true) {
    person.process.look();
    const bool fresh = person.process.status_epoch() == epoch_ && person.process.status_tick() >= wanted;
    if (fresh || std::chrono::steady_clock::now() > bound) return person;
    std::this_thread::sleep_for(10ms);
  }
}

std::uint64_t ExchangePort::refused() { return fresh_status().process.refused(); }

std::uint32_t ExchangePort::incarnation() { return fresh_status().process.incarnation(); }

std::string ExchangePort::restart() {
  if (is_served_) return "the part was started by hand: a part of a manifest is started again";
  return client().process.kill();
}

void ExchangePort::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

void ExchangePort::finish() {
  const std::lock_guard lock(mutex_);
  finished_ = true;
  changed_.notify_all();
}

}  // namespace constrictor::conform
