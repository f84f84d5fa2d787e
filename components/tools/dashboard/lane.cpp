#include "dashboard/lane.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <stdexcept>
#include <utility>

namespace constrictor::dashboard {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMostWaiting = 16;
constexpr auto kTurn = 50ms;

}  // namespace

void Answers::add(std::function<void()> deliver) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(deliver));
}

void Answers::deliver() {
  std::vector<std::function<void()>> due;
  {
    const std::lock_guard lock(mutex_);
    due.swap(waiting_);
  }
  for (const auto& deliver : due) deliver();
}

Lane::Lane(Answers& answers, Do what, std::string newest_only, std::function<void()> each_turn, Log log)
    : answers_(answers),
      do_(std::move(what)),
      newest_only_(std::move(newest_only)),
      each_turn_(std::move(each_turn)),
      log_(std::move(log)),
      thread_([this] { work(); }) {}

Lane::~Lane() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Lane::add(WebServer::Call call) {
  std::optional<WebServer::Call> replaced, refused;
  {
    const std::lock_guard lock(mutex_);
    if (call.service == newest_only_ && !waiting_.empty() && waiting_.back().service == newest_only_) {
      replaced = std::exchange(waiting_.back(), std::move(call));
    } else if (waiting_.size() < kMostWaiting) {
      waiting_.push_back(std::move(call));
    } else {
      refused = std::move(call);
    }
  }
  changed_.notify_all();
  if (refused) refused->fail("too many commands are waiting for their answers");
  if (replaced) replaced->answer("replaced by a newer call");
}

void Lane::obey(const WebServer::Call& call) {
  try {
    answers_.add([text = do_(call), call] { call.answer(text); });
  } catch (const std::exception& error) {
    answers_.add([text = std::string(error.what()), call] { call.fail(text); });
  }
}

void Lane::work() {
  std::string said;  // the newest error of each_turn_
  for (;;) {
    std::optional<WebServer::Call> call;
    {
      std::unique_lock lock(mutex_);
      const auto due = [this] { return ending_ || !waiting_.empty(); };
      if (each_turn_) changed_.wait_for(lock, kTurn, due);
      else changed_.wait(lock, due);
      if (ending_) return;
      if (!waiting_.empty()) {
        call = std::move(waiting_.front());
        waiting_.pop_front();
      }
    }
    if (call) obey(*call);
    try {
      if (each_turn_) each_turn_();
    } catch (const std::exception& error) {
      if (said != error.what()) log_.error("{}", error.what());
      said = error.what();
    }
  }
}

double request_number(const WebServer::Call& call, const char* key, double low, double high) {
  const auto found = call.request.find(key);
  const bool good =
      found != call.request.end() && found->is_number() && found->get<double>() >= low && found->get<double>() <= high;
  if (!good)
    throw std::invalid_argument(fmt::format("{}: accepted {{\"{}\": {} to {}}}", call.service, key, low, high));
  return found->get<double>();
}

std::string request_text(const WebServer::Call& call, const char* key) {
  const auto found = call.request.find(key);
  if (found == call.request.end() || !found->is_string() || found->get_ref<const std::string&>().size() > 1000)
    throw std::invalid_argument(fmt::format("{}: accepted {{\"{}\": a text}}", call.service, key));
  return found->get<std::string>();
}

}  // namespace constrictor::dashboard
