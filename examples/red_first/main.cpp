// red_first: an external planner on the installed package that flies the case study its own way: red before green. It reads what any
// observer may read, asks `input` for authority, and starts the task layer's tasks.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "constrictor/messages.hpp"
#include "retrieval.hpp"
#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/dds/outside_link.hpp"
#include "runtime/dds/wait_set.hpp"
#include "runtime/unanswered_requests.hpp"

namespace {

namespace msg = constrictor::msg;
using constrictor::dds::Reader;
using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t g_stop = 0;

/// A name of this process's own: another process under the same name would count as another source, and this one as dead.
const std::string kName = "red_first." + std::to_string(::getpid());

/// The robot is to hold within half a second if this process dies.
constexpr std::int64_t kLease_ns = 500'000'000;

class Planner {
 public:
  Planner(std::uint32_t domain, std::vector<std::uint8_t> sequence, double at_s, std::size_t after)
      : at_s_(at_s), wait_for_(after), objects_count_(sequence.size()), domain_(domain), requests_(domain_.participant(), kLease_ns, /*by_hand=*/false), logic_(std::move(sequence), msg::kColourBlue) {
    const dds_entity_t participant = domain_.participant();
    pose_ = Reader<msg::RobotPose>::observer(participant, "guidance/pose");
    line_ = Reader<msg::LinePercept>::observer(participant, "perception/line", 8);
    objects_ = Reader<msg::ObjectPercepts>::observer(participant, "perception/objects", 8);
    status_ = Reader<msg::TaskStatus>::observer(participant, "task/status");
    // Nothing of these may be lost, and what was said before we came counts: a member's quality of service.
    authority_ = Reader<msg::Authority>::member(participant, "authority");
    answers_ = Reader<msg::RequestAnswer>::member(participant, "request/answer");
    events_ = Reader<msg::TaskEvent>::member(participant, "task/event");
    ticks_ = Reader<msg::Tick>::member(participant, "barrier/tick");
    wait_set_ = constrictor::dds::WaitSet(participant);
    for (const auto reader : {pose_.get(), authority_.get(), answers_.get(), events_.get(), ticks_.get()}) wait_set_.attach(reader);
  }

  /// Until everything is delivered (0), the run ends without (1), or somebody sends SIGTERM (1).
  int run() {
    while (!g_stop && !gone()) {
      listen();
      if (now_s_ < at_s_ || objects_count_ - logic_.remaining().size() < wait_for_) continue;
      if (!asked_ && connected()) {
        std::printf("at %.1f s: asking for authority\n", now_s_);
        ask(request(msg::kRequestTake));
        asked_ = true;
      }
      if (mine_ != commanding_) {
        commanding_ = mine_;
        std::printf("at %.1f s: authority %s\n", now_s_, mine_ ? "gained" : "lost");
        if (mine_) logic_.take_over(now_s_);
      }
      if (!commanding_) continue;
      if (const auto order = logic_.decide(now_s_)) send(*order);
      if (logic_.done()) {
        std::printf("at %.1f s: everything is delivered, %d setbacks\n", now_s_, logic_.setbacks());
        ask(request(msg::kRequestRelease));
        while (mine_ && !gone() && !g_stop) listen();  // until the release has arrived
        return 0;
      }
      std::fflush(stdout);
    }
    return 1;
  }

 private:
  void listen() {
    wait_set_.wait(std::chrono::milliseconds(200));
    pose_.take([this](const msg::RobotPose& pose) {
      now_s_ = static_cast<double>(pose.header.time_ns) * 1e-9;
      logic_.locate({pose.x_m, pose.y_m, pose.yaw_rad, pose.body_yaw_rad});
    });
    authority_.take([this](const msg::Authority& authority) {
      mine_ = authority.level == msg::kAuthorityExternal && std::string(authority.source) == kName;
    });
    answers_.take([this](const msg::RequestAnswer& answer) {
      if (std::string(answer.source) != kName) return;
      unanswered_.answered(answer.request_sequence);
      if (answer.granted) return;
      std::printf("request %llu was refused: %s\n", static_cast<unsigned long long>(answer.request_sequence), answer.reason);
    });
    unanswered_.repeat(Clock::now(), std::chrono::milliseconds(500), [this](const msg::Request& wish) { requests_.write(wish); });
    status_.take([this](const msg::TaskStatus& status) {
      logic_.know({own(status.goal_id), status.task, status.state, status.carrying});
    });
    events_.take([this](const msg::TaskEvent& event) {
      if (event.event != msg::kEventNone) std::printf("event %d of task %d, colour %d\n", event.event, event.task, event.colour);
      logic_.hear({own(event.goal_id), event.event, event.goal_state, event.colour});
    });
    line_.take([this](const msg::LinePercept& line) {
      logic_.see({line.visible && line.colour == msg::kColourBlue, line.lookahead_m, line.offset_m, line.heading_rad});
    });
    objects_.take([this](const msg::ObjectPercepts& percepts) {
      std::vector<retrieval::Thing> things;
      for (std::size_t i = 0; i < std::min<std::size_t>(percepts.blob_count, msg::kMaxBlobs); ++i) {
        const msg::Blob& blob = percepts.blobs[i];
        if (blob.kind == msg::kBlobUndecided) continue;
        things.push_back({blob.colour, blob.kind == msg::kBlobZone, blob.range_m, blob.bearing_rad});
      }
      logic_.see(things);
    });
    ticks_.take([this](const msg::Tick& tick) { over_ = over_ || tick.final_tick; });
  }

  /// The run has ended, or its processes died.
  [[nodiscard]] bool gone() const { return over_ || (now_s_ >= 0 && pose_.writers() == 0); }

  /// `input` hears only what is written after it and we have found each other.
  [[nodiscard]] bool connected() const { return requests_.heard(); }

  /// A goal's id on task/event and task/status is (level << 48) + (number of the source << 32) + our own.
  [[nodiscard]] std::uint64_t own(std::uint64_t goal) const {
    return mine_ && goal >> 48 == msg::kAuthorityExternal ? goal & 0xffffffffu : 0;
  }

  msg::Request request(std::uint8_t kind) {
    msg::Request request{};
    request.robot_id = 1;
    constrictor::dds::set_text(request.source, kName);
    request.header.sequence_number = ++sequence_;
    request.level = msg::kAuthorityExternal;
    request.kind = kind;
    request.parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
    return request;
  }
  /// What is not answered is said again: `input` hears nothing while its process is being restarted.
  void ask(const msg::Request& wish) {
    unanswered_.asked(wish, Clock::now());
    requests_.write(wish);
  }
  void send(const retrieval::Order& order) {
    std::printf("at %.1f s: %s (task %d, goal %llu)\n", now_s_, logic_.stage().c_str(), order.task,
                static_cast<unsigned long long>(order.goal));
    msg::Request wish = request(msg::kRequestTask);
    wish.command = msg::kCommandStart;
    wish.goal_id = order.goal;
    wish.task = order.task;
    wish.parameters.line_colour = order.line_colour;
    wish.parameters.object_colour = order.object_colour;
    wish.parameters.drop_zone_colour = order.zone_colour;
    wish.parameters.direction = order.direction;
    if (order.timeout_s > 0) wish.parameters.timeout_s = order.timeout_s;
    wish.path.point_count = static_cast<std::uint16_t>(order.path.size());
    for (std::size_t i = 0; i < order.path.size(); ++i) std::tie(wish.path.x_m[i], wish.path.y_m[i]) = order.path[i];
    ask(wish);
  }

  double at_s_;
  std::size_t wait_for_, objects_count_;
  constrictor::dds::Domain domain_;
  constrictor::dds::RequestWriter requests_;
  constrictor::UnansweredRequests unanswered_;
  retrieval::Retrieval logic_;
  Reader<msg::RobotPose> pose_;
  Reader<msg::LinePercept> line_;
  Reader<msg::ObjectPercepts> objects_;
  Reader<msg::Authority> authority_;
  Reader<msg::RequestAnswer> answers_;
  Reader<msg::TaskStatus> status_;
  Reader<msg::TaskEvent> events_;
  Reader<msg::Tick> ticks_;
  constrictor::dds::WaitSet wait_set_;
  std::uint64_t sequence_ = 0;
  double now_s_ = -1;
  bool asked_ = false, mine_ = false, commanding_ = false, over_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  std::uint32_t domain = 0;
  std::vector<std::string> order = {"red", "green"};
  double at_s = 5.0;
  std::size_t after = 0;
  CLI::App app{"Retrieves the objects as an external planner, red before green."};
  app.add_option("--domain", domain, "as `constrictor run` prints it")->envname("CONSTRICTOR_DOMAIN")->required();
  const std::vector<std::string> colours = {"", "green", "red", "blue", "yellow"};
  app.add_option("--order", order, "colours in the order of retrieval")->delimiter(',')->check(CLI::IsMember(colours));
  app.add_option("--at", at_s, "[s] simulated time at which it takes the mission over");
  app.add_option("--after", after, "number of objects that others must have delivered by then");
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGTERM, [](int) { g_stop = 1; });
  std::signal(SIGINT, [](int) { g_stop = 1; });
  std::vector<std::uint8_t> sequence;
  for (const auto& colour : order) {
    sequence.push_back(static_cast<std::uint8_t>(std::find(colours.begin(), colours.end(), colour) - colours.begin()));
  }
  try {
    return Planner(domain, std::move(sequence), at_s, after).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "red_first: %s\n", error.what());
    return 70;
  }
}
