// red_first: an external planner that is built with the installed package. It retrieves the objects in an order of its
// own, red before green. It reads topics as an observer, takes authority, and starts the tasks of the task layer.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "client/request_client.hpp"
#include "client/run_registry.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/messages.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/wait_set.hpp"
#include "retrieval.hpp"

namespace {

namespace constants = constrictor::constants;
namespace msg = constrictor::msg;
using constrictor::dds::Reader;

volatile std::sig_atomic_t g_stop = 0;

constrictor::RequestClientOptions client_options() {
  constrictor::RequestClientOptions options;
  options.source = constrictor::unique_source("red_first");
  return options;
}

class Planner {
 public:
  Planner(std::uint32_t domain, std::vector<std::uint8_t> sequence, double at_s, std::size_t after)
      : at_s_(at_s),
        wait_for_(after),
        objects_count_(sequence.size()),
        client_(domain, client_options()),
        logic_(std::move(sequence), msg::kColourBlue) {
    const dds_entity_t participant = client_.participant();
    pose_ = Reader<msg::RobotPose>::observer(participant, "guidance/pose");
    line_ = Reader<msg::LinePercept>::observer(participant, "perception/line", 8);
    objects_ = Reader<msg::ObjectPercepts>::observer(participant, "perception/objects", 8);
    status_ = Reader<msg::TaskStatus>::observer(participant, "task/status");
    // Reliable and from the beginning of the epoch, as members read: the logic needs every event.
    events_ = Reader<msg::TaskEvent>::member(participant, "task/event");
    ticks_ = Reader<msg::Tick>::member(participant, "barrier/tick");
    wait_set_ = constrictor::dds::WaitSet(participant);
    for (const auto reader : {pose_.get(), events_.get(), ticks_.get()}) wait_set_.attach(reader);
  }

  /// Returns 0 when all objects are delivered, 1 if the run ends before or after SIGTERM or Ctrl-C.
  int run() {
    while (!g_stop && !gone()) {
      listen();
      if (now_s_ < at_s_ || objects_count_ - logic_.remaining().size() < wait_for_) continue;
      if (!asked_ && client_.connected()) {
        std::printf("at %.1f s: asking for authority\n", now_s_);
        numbers_.push_back(client_.ask(msg::kRequestTake));
        asked_ = true;
      }
      if (client_.holds_authority() != commanding_) {
        commanding_ = !commanding_;
        std::printf("at %.1f s: authority %s\n", now_s_, commanding_ ? "gained" : "lost");
        if (commanding_) logic_.take_over(now_s_);
      }
      if (!commanding_) continue;
      if (const auto order = logic_.decide(now_s_)) send(*order);
      if (logic_.done()) {
        std::printf("at %.1f s: everything is delivered, %d setbacks\n", now_s_, logic_.setbacks());
        client_.release();
        return 0;
      }
      std::fflush(stdout);
    }
    if (client_.holds_authority() && !gone())
      std::printf("authority %s\n", client_.release() ? "released" : "ends with this program: no answer");
    return 1;
  }

 private:
  void listen() {
    wait_set_.wait(std::chrono::milliseconds(200));
    pose_.take([this](const msg::RobotPose& pose) {
      now_s_ = static_cast<double>(pose.header.time_ns) * 1e-9;
      logic_.take(retrieval::Pose{pose.x_m, pose.y_m, pose.yaw_rad, pose.body_yaw_rad});
    });
    client_.poll();
    std::erase_if(numbers_, [this](std::uint64_t number) {
      const msg::RequestAnswer* answer = client_.answer(number);
      if (answer && !answer->granted)
        std::printf("request %llu was refused: %s\n", static_cast<unsigned long long>(number), answer->reason);
      return answer != nullptr;
    });
    status_.take([this](const msg::TaskStatus& status) {
      logic_.take(retrieval::GoalStatus{own(status.goal_id), status.task, status.goal_state, status.carrying});
    });
    events_.take([this](const msg::TaskEvent& event) {
      if (event.event != msg::kEventNone) {
        std::printf("event \"%s\" of task \"%s\", colour %s\n", words_of(constants::kEvent, event.event).c_str(),
                    words_of(constants::kTask, event.task).c_str(), name_of(constants::kColour, event.colour));
      }
      logic_.take(retrieval::GoalEvent{own(event.goal_id), event.event, event.goal_state, event.colour});
    });
    line_.take([this](const msg::LinePercept& line) {
      logic_.take(retrieval::Line{line.visible && line.colour == msg::kColourBlue, line.lookahead_m, line.offset_m,
                                  line.heading_rad});
    });
    objects_.take([this](const msg::ObjectPercepts& percepts) {
      std::vector<retrieval::Percept> percepts_in_view;
      for (std::size_t i = 0; i < std::min<std::size_t>(percepts.blob_count, msg::kMaxBlobs); ++i) {
        const msg::Blob& blob = percepts.blobs[i];
        if (blob.kind == msg::kBlobUndecided) continue;
        percepts_in_view.push_back({blob.colour, blob.kind == msg::kBlobZone, blob.range_m, blob.bearing_rad});
      }
      logic_.take(percepts_in_view);
    });
    ticks_.take([this](const msg::Tick& tick) { over_ = over_ || tick.final_tick; });
  }

  /// True if the run has ended, or its processes are dead.
  [[nodiscard]] bool gone() const { return over_ || (now_s_ >= 0 && pose_.writers() == 0); }

  /// The number that this client gave to a goal; `logic_` uses it. 0 if the goal belongs to another source.
  [[nodiscard]] std::uint64_t own(std::uint64_t goal) const {
    return client_.holds_authority() && constrictor::goal_level(goal) == msg::kAuthorityExternal
               ? constrictor::goal_number(goal)
               : 0;
  }

  void send(const retrieval::Order& order) {
    std::printf("at %.1f s: %s (task \"%s\", goal %llu)\n", now_s_, logic_.stage().c_str(),
                words_of(constants::kTask, order.task).c_str(), static_cast<unsigned long long>(order.goal));
    msg::Request request = constrictor::task_request(order.task);
    request.goal_id = order.goal;
    request.parameters.line_colour = order.line_colour;
    request.parameters.object_colour = order.object_colour;
    request.parameters.drop_zone_colour = order.zone_colour;
    request.parameters.direction = order.direction;
    if (order.timeout_s > 0) request.parameters.timeout_s = order.timeout_s;
    request.path.point_count = static_cast<std::uint16_t>(order.path.size());
    for (std::size_t i = 0; i < order.path.size(); ++i)
      std::tie(request.path.x_m[i], request.path.y_m[i]) = order.path[i];
    numbers_.push_back(client_.ask(request));
  }

  double at_s_;
  std::size_t wait_for_, objects_count_;
  constrictor::RequestClient client_;
  std::vector<std::uint64_t> numbers_;  ///< numbers of the requests that are not answered yet
  retrieval::Retrieval logic_;
  Reader<msg::RobotPose> pose_;
  Reader<msg::LinePercept> line_;
  Reader<msg::ObjectPercepts> objects_;
  Reader<msg::TaskStatus> status_;
  Reader<msg::TaskEvent> events_;
  Reader<msg::Tick> ticks_;
  constrictor::dds::WaitSet wait_set_;
  double now_s_ = -1;
  bool asked_ = false, commanding_ = false, over_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  std::optional<std::uint32_t> domain;
  std::vector<std::string> order = {"red", "green"};
  double at_s = 5.0;
  std::size_t after = 0;
  CLI::App app{"Retrieves the objects as an external planner, red before green."};
  app.add_option("--domain", domain, "DDS domain of the run, as `constrictor run` prints it (default: the only run)")
      ->envname("CONSTRICTOR_DOMAIN");
  app.add_option("--order", order, "colours in the order of retrieval, comma separated")
      ->delimiter(',')
      ->check(CLI::IsMember(constrictor::names_of(constants::kColour, msg::kColourGreen)));
  app.add_option("--at", at_s, "[s] simulated time at which the planner takes the mission over");
  app.add_option("--after", after, "number of objects that other planners must have delivered before");
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGTERM, [](int) { g_stop = 1; });
  std::signal(SIGINT, [](int) { g_stop = 1; });
  std::vector<std::uint8_t> sequence;
  for (const auto& colour : order) sequence.push_back(*constrictor::value_of(constants::kColour, colour));
  try {
    return Planner(constrictor::find_domain(domain), std::move(sequence), at_s, after).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "red_first: %s\n", error.what());
    return 70;
  }
}
