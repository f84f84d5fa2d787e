#include "dashboard/replay_controls.hpp"

#include <fmt/format.h>

namespace constrictor::dashboard {
namespace {

using namespace std::chrono_literals;
using Kind = ReplayRequest::Kind;

constexpr auto kLookEvery = 100ms;

std::string describe(const ReplayState& state) {
  return fmt::format("{} at {:.1f} of {:.1f} s",
                     state.ended    ? "at the end"
                     : state.paused ? "paused"
                                    : "playing",
                     state.position_s, state.length_s);
}

}  // namespace

ReplayControls::ReplayControls(std::uint32_t domain, const Log& log)
    : domain_(domain),
      client_(domain),
      state_(client_.ask({})),
      lane_(
          answers_, [this](const WebServer::Call& call) { return obey(call); }, "seek", [this] { look(); }, log) {}

std::string ReplayControls::obey(const WebServer::Call& call) {
  const std::string& name = call.service;
  ReplayRequest request;
  if (name == "pause") request.kind = Kind::kPause;
  else if (name == "resume") request.kind = Kind::kResume;
  else if (name == "step") request = {Kind::kStep, request_number(call, "ticks", 1, 1e6)};
  else if (name == "pace") request = {Kind::kSpeed, request_number(call, "pace", 0, 1000)};
  else request = {Kind::kSeek, request_number(call, "time_s", 0, 1e9)};
  const ReplayState state = client_.ask(request);
  keep(state);
  return describe(state);
}

void ReplayControls::look() {
  const auto now = std::chrono::steady_clock::now();
  if (client_.gone() || now - looked_ < kLookEvery) return;
  looked_ = now;
  try {
    keep(client_.ask({}));
  } catch (const std::exception&) {}  // over() says it
  if (!client_.gone()) return;
  const std::lock_guard lock(mutex_);
  over_ = true;
}

void ReplayControls::keep(const ReplayState& state) {
  const std::lock_guard lock(mutex_);
  state_ = state;
}

std::string ReplayControls::over() const {
  const std::lock_guard lock(mutex_);
  return over_ ? "the replay has ended" : "";
}

std::optional<nlohmann::json> ReplayControls::replay() const {
  const std::lock_guard lock(mutex_);
  return to_json(state_);
}

std::string ReplayControls::file() const {
  const std::lock_guard lock(mutex_);
  return state_.file;
}

}  // namespace constrictor::dashboard
