// waypoints: sends the robot along a path and watches how well it keeps to it. The smallest whole external planner: one request, one
// goal, one answer.
//   waypoints --domain 3 --path 0,0 1,0 2,0.5 3,0.5       metres in the map: x along the robot's first direction, y to its left
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "constrictor/messages.hpp"
#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/dds/outside_link.hpp"
#include "runtime/dds/wait_set.hpp"
#include "runtime/unanswered_requests.hpp"

namespace msg = constrictor::msg;
using namespace std::chrono_literals;
using constrictor::dds::Reader;

namespace {

/// A name of this process's own: another process under the same name would count as another source, and this one as dead.
const std::string kName = "waypoints." + std::to_string(::getpid());

msg::Request request(std::uint8_t kind, std::uint64_t sequence_number) {
  msg::Request request{};
  request.robot_id = 1;
  constrictor::dds::set_text(request.source, kName);
  request.header.sequence_number = sequence_number;
  request.level = msg::kAuthorityExternal;
  request.kind = kind;
  request.parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
  return request;
}

msg::Request along(const std::vector<std::string>& points, std::uint64_t sequence_number) {
  msg::Request wish = request(msg::kRequestTask, sequence_number);
  wish.command = msg::kCommandStart;
  wish.task = msg::kTaskFollowPath;
  wish.goal_id = 1;
  if (points.size() > msg::kMaxPathPoints) throw std::runtime_error("--path: more than 64 points");
  for (const auto& text : points) {
    double& x_m = wish.path.x_m[wish.path.point_count];
    double& y_m = wish.path.y_m[wish.path.point_count];
    if (std::sscanf(text.c_str(), "%lf,%lf", &x_m, &y_m) != 2) throw std::runtime_error("--path: found '" + text + "', accepted X,Y");
    ++wish.path.point_count;
  }
  return wish;
}

/// Exit status: 0 if the path was followed to its end.
int follow(std::uint32_t domain, const std::vector<std::string>& points) {
  const constrictor::dds::Domain here(domain);
  // Half a second after this process died the robot holds.
  const constrictor::dds::RequestWriter requests(here.participant(), std::chrono::nanoseconds(500ms).count(), /*by_hand=*/false);
  constrictor::UnansweredRequests unanswered;  // what was not answered is said again
  const auto ask = [&](const msg::Request& wish) {
    unanswered.asked(wish, std::chrono::steady_clock::now());
    requests.write(wish);
  };
  const auto status = Reader<msg::TaskStatus>::observer(here.participant(), "task/status", 8);
  const auto events = Reader<msg::TaskEvent>::member(here.participant(), "task/event");
  const auto authority = Reader<msg::Authority>::member(here.participant(), "authority");
  const auto answers = Reader<msg::RequestAnswer>::member(here.participant(), "request/answer");
  const constrictor::dds::WaitSet wait_set(here.participant());
  for (const auto reader : {status.get(), events.get(), authority.get(), answers.get()}) wait_set.attach(reader);

  // Nobody hears a request before both sides have met; a task request takes authority by itself.
  for (const auto end = std::chrono::steady_clock::now() + 10s; !requests.heard() || status.writers() == 0;) {
    if (std::chrono::steady_clock::now() > end) throw std::runtime_error("nobody on domain " + std::to_string(domain) + " hears requests");
    wait_set.wait(50ms);
    status.take([](const msg::TaskStatus&) {});
  }
  ask(along(points, 1));

  double squares = 0;
  double largest_m = 0;
  int count = 0;
  std::uint8_t state = msg::kGoalIdle;
  bool mine = false;
  std::uint64_t goal = 0;  // as it is on task/status and task/event; 0: not answered yet
  std::vector<msg::TaskEvent> heard;  // events may come before the answer
  for (const auto asked = std::chrono::steady_clock::now(); status.writers() > 0 && state <= msg::kGoalRunning;) {
    wait_set.wait(200ms);
    authority.take([&](const msg::Authority& now) { mine = std::string(now.source) == kName; });
    answers.take([&](const msg::RequestAnswer& answer) {
      if (std::string(answer.source) != kName) return;
      unanswered.answered(answer.request_sequence);
      if (!answer.granted) throw std::runtime_error("refused: " + std::string(answer.reason));
      goal = answer.goal_id;
    });
    unanswered.repeat(std::chrono::steady_clock::now(), 500ms, [&](const msg::Request& wish) { requests.write(wish); });
    events.take([&](const msg::TaskEvent& event) { heard.push_back(event); });
    if (goal == 0) {
      if (std::chrono::steady_clock::now() - asked > 10s) throw std::runtime_error("no answer; is the run paused?");
      continue;
    }
    for (const msg::TaskEvent& event : std::exchange(heard, {})) {
      if (event.goal_id != goal) continue;
      state = event.goal_state;
      if (event.event == msg::kEventNone) std::printf("goal state %d: %s\n", event.goal_state, event.detail);
    }
    status.take([&](const msg::TaskStatus& now) {
      if (now.goal_id != goal || !std::isfinite(now.cross_track_m)) return;
      squares += now.cross_track_m * now.cross_track_m;
      largest_m = std::max(largest_m, std::abs(now.cross_track_m));
      if (count++ % 50 == 0) std::printf("%3.0f %% of the path, %+.3f m from it\n", 100 * now.progress, now.cross_track_m);
    });
    std::fflush(stdout);
  }
  std::printf("cross-track error: %.3f m rms, %.3f m at most, over %d ticks\n", count > 0 ? std::sqrt(squares / count) : 0.0, largest_m, count);
  ask(request(msg::kRequestRelease, 2));
  for (int i = 0; i < 20 && mine; ++i) {
    wait_set.wait(200ms);
    authority.take([&](const msg::Authority& now) { mine = std::string(now.source) == kName; });
  }
  return state == msg::kGoalSucceeded ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::uint32_t domain = 0;
  std::vector<std::string> points = {"0,0", "1,0", "1.5,0.2", "2,0.4", "2.5,0.4", "3,0.4"};
  CLI::App app{"Sends the robot along a path of waypoints as an external planner."};
  app.add_option("--domain", domain, "as `constrictor run` prints it")->envname("CONSTRICTOR_DOMAIN")->required();
  app.add_option("--path", points, "points X,Y in m in the map")->expected(2, 64);
  CLI11_PARSE(app, argc, argv);
  try {
    return follow(domain, points);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "waypoints: %s\n", error.what());
    return 70;
  }
}
