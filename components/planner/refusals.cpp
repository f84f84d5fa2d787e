#include "planner/refusals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace constrictor {
namespace {

std::string task_name(std::uint8_t task) { return words_of(constants::kTask, task); }

bool about_an_object(std::uint8_t task) {
  return task == msg::kTaskTrackObject || task == msg::kTaskPregrasp || task == msg::kTaskGrasp;
}

}  // namespace

double Refusals::pause_s(int refusals) const {
  constexpr int kMostDoublings = 30;
  const double grown_s = config_.refused_pause_s * std::exp2(std::min(refusals - 1, kMostDoublings));
  return std::min(grown_s, std::max(config_.refused_pause_s, config_.refused_longest_pause_s));
}

void Refusals::accept(std::uint8_t task) {
  memory_.in_a_row = 0;
  memory_.reason.clear();
  std::erase_if(memory_.tasks, [task](const RefusedTask& refused) { return refused.task == task; });
}

void Refusals::count(std::uint8_t task, const std::string& reason, double now_s) {
  if (memory_.in_a_row++ == 0) memory_.since_s = now_s;
  memory_.task = task;
  memory_.direction = msg::kDirectionNone;
  memory_.again = true;
  memory_.reason = reason;
}

void Refusals::wait(std::uint8_t task, const std::string& reason, double now_s) {
  count(task, reason, now_s);
  memory_.next_s = now_s + pause_s(memory_.in_a_row);
}

void Refusals::reject(std::uint8_t task, std::uint8_t direction, const std::string& reason, double now_s) {
  count(task, reason, now_s);
  memory_.direction = direction;
  memory_.again = false;
  memory_.next_s = memory_.in_a_row > 1 ? now_s + pause_s(memory_.in_a_row - 1) : now_s;
  const auto known =
      std::find_if(memory_.tasks.begin(), memory_.tasks.end(), [task](const auto& t) { return t.task == task; });
  RefusedTask& refused = known != memory_.tasks.end() ? *known : memory_.tasks.emplace_back(RefusedTask{task});
  if (refused.count++ == 0) refused.since_s = now_s;
  refused.until_s = now_s + pause_s(refused.count);
}

bool Refusals::barred(std::uint8_t task, double now_s) const {
  return std::any_of(memory_.tasks.begin(), memory_.tasks.end(),
                     [&](const RefusedTask& refused) { return refused.task == task && now_s < refused.until_s; });
}

std::string Refusals::give_up(double now_s) const {
  if (!any()) return {};
  const double nothing_s = now_s - memory_.since_s;
  if (nothing_s > config_.refused_timeout_s)
    return fmt::format("no task was accepted for {:.0f} s; last, {}: {}", nothing_s, task_name(memory_.task),
                       memory_.reason);
  // Other tasks are accepted, but this one is not. A few refusals may be far apart by chance.
  constexpr int kAgain = 3;
  for (const RefusedTask& refused : memory_.tasks) {
    if (about_an_object(refused.task)) continue;  // after some failures the object is put aside
    if (refused.task != memory_.task || refused.count < kAgain || now_s - refused.since_s <= config_.refused_timeout_s)
      continue;
    return fmt::format("{} was refused {} times in {:.0f} s: {}", task_name(refused.task), refused.count,
                       now_s - refused.since_s, memory_.reason);
  }
  return {};
}

std::string Refusals::answer() const {
  if (!any()) return {};
  if (memory_.again) return "waits because its request was refused: " + memory_.reason;
  return fmt::format("does without {}, which was refused: {}", task_name(memory_.task), memory_.reason);
}

}  // namespace constrictor
