// fastdds_planner: retrieves the objects as an external planner on Fast DDS. It uses the IDL files of Constrictor and
// the contract in idl/CLIENTS.md, but none of its headers and libraries.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "barrierPubSubTypes.h"
#include "guidancePubSubTypes.h"
#include "missionPubSubTypes.h"
#include "participant.hpp"
#include "perceptionPubSubTypes.h"
#include "retrieval.hpp"
#include "taskPubSubTypes.h"

namespace {

namespace msg = constrictor::msg;
using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t g_stop = 0;

/// Source name. It contains the process id: if another process uses the same name, `input` regards this one as dead.
const std::string kName = "fastdds_planner." + std::to_string(::getpid());

struct Options {
  std::uint32_t domain = 0;
  std::vector<std::uint8_t> sequence = {msg::kColourGreen, msg::kColourRed};
  double at_s = 5.0;       ///< [s] simulated time at which the planner takes the mission over
  std::size_t after = 0;   ///< number of objects that other planners must have delivered before
  std::string token_file;  ///< of the run; empty: the one that `constrictor run` writes on this host
};

/// The run's token, which every request carries; empty if there is no such file: the run may have no token.
std::string read_token(const Options& options) {
  std::string file = options.token_file;
  if (file.empty()) {
    const char* runtime = std::getenv("XDG_RUNTIME_DIR");
    file = (runtime && *runtime ? std::string(runtime) + "/constrictor"
                                : "/tmp/constrictor-" + std::to_string(::getuid())) +
           "/run-" + std::to_string(options.domain) + ".token";
  }
  std::string token;
  std::ifstream stream(file);
  if (!std::getline(stream, token) && !options.token_file.empty())
    throw std::runtime_error(file + ": found no token, accepted a file that begins with the run's token");
  return token;
}

/// Exits with status 64 if the arguments are wrong.
Options parse(int argc, char** argv) {
  const auto usage = [](int status) {
    std::fprintf(
        status ? stderr : stdout,
        "usage: fastdds_planner --domain N [--order COLOUR,...] [--at SECONDS] [--after N] [--token-file FILE]\n"
        "  --domain  DDS domain of the run, as `constrictor run` prints it\n"
        "  --order   colours in the order of retrieval: green, red, blue, yellow (default green,red)\n"
        "  --at      simulated time in s at which the planner takes the mission over (default 5)\n"
        "  --after   number of objects that other planners must have delivered before (default 0)\n"
        "  --token-file  file with the token that `constrictor run` prints (default: the one that it writes "
        "on this host)\n");
    std::exit(status);
  };
  Options options;
  bool domain = false;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--help") usage(0);
    if (++i == argc) usage(64);
    if (name == "--domain") {
      options.domain = static_cast<std::uint32_t>(std::atoi(argv[i]));
      domain = true;
    } else if (name == "--at") {
      options.at_s = std::atof(argv[i]);
    } else if (name == "--token-file") {
      options.token_file = argv[i];
    } else if (name == "--after") {
      options.after = static_cast<std::size_t>(std::atoi(argv[i]));
    } else if (name == "--order") {
      options.sequence.clear();
      const std::string names[] = {"", "green", "red", "blue", "yellow"};
      std::string list = std::string(argv[i]) + ",";
      for (std::size_t end = list.find(','); end != std::string::npos; list.erase(0, end + 1), end = list.find(',')) {
        const auto colour = std::find(std::begin(names) + 1, std::end(names), list.substr(0, end));
        if (colour == std::end(names)) usage(64);
        options.sequence.push_back(static_cast<std::uint8_t>(colour - std::begin(names)));
      }
    } else {
      usage(64);
    }
  }
  if (!domain) usage(64);
  return options;
}

/// Connects the topics and requests of the run with the logic of `Retrieval`.
class Planner {
 public:
  explicit Planner(const Options& options)
      : options_(options),
        token_(read_token(options)),
        participant_(options.domain, kName),
        logic_(options.sequence, msg::kColourBlue) {
    requests_ = participant_.write<msg::RequestPubSubType>("request/v2", 32);
    pose_ = participant_.read<msg::RobotPosePubSubType>("guidance/pose", false, 1, [this](const msg::RobotPose& pose) {
      now_s_ = static_cast<double>(pose.header().time_ns()) * 1e-9;
      logic_.take(retrieval::Pose{pose.x_m(), pose.y_m(), pose.yaw_rad(), pose.body_yaw_rad()});
    });
    participant_.read<msg::LinePerceptPubSubType>("perception/line", false, 8, [this](const msg::LinePercept& line) {
      logic_.take(retrieval::Line{line.visible() && line.colour() == msg::kColourBlue, line.lookahead_m(),
                                  line.offset_m(), line.heading_rad()});
    });
    participant_.read<
        msg::ObjectPerceptsPubSubType>("perception/objects", false, 8, [this](const msg::ObjectPercepts& percepts) {
      std::vector<retrieval::Percept> percepts_in_view;
      for (std::size_t i = 0; i < std::min<std::size_t>(percepts.blob_count(), percepts.blobs().size()); ++i) {
        const auto& blob = percepts.blobs()[i];
        if (blob.kind() == msg::kBlobUndecided) continue;
        percepts_in_view.push_back({blob.colour(), blob.kind() == msg::kBlobZone, blob.range_m(), blob.bearing_rad()});
      }
      logic_.take(percepts_in_view);
    });
    participant_.read<msg::AuthorityPubSubType>("authority", true, 8, [this](const msg::Authority& authority) {
      mine_ = authority.level() == msg::kAuthorityExternal && std::string(authority.source()) == kName;
    });
    participant_.read<msg::RequestAnswerPubSubType>(
        "request/answer", true, 288, [this](const msg::RequestAnswer& answer) {
          if (std::string(answer.source()) != kName) return;
          unanswered_.erase(answer.request_sequence());
          if (answer.granted()) return;
          std::printf("request %llu was refused: %s\n", static_cast<unsigned long long>(answer.request_sequence()),
                      answer.reason().c_str());
        });
    participant_.read<msg::TaskStatusPubSubType>("task/status", false, 1, [this](const msg::TaskStatus& status) {
      logic_.take(retrieval::GoalStatus{own(status.goal_id()), status.task(), status.goal_state(), status.carrying()});
    });
    // Reliable and from the beginning of the epoch: the events show which objects were delivered before this planner
    // started.
    participant_.read<msg::TaskEventPubSubType>("task/event", true, 512, [this](const msg::TaskEvent& event) {
      if (event.event() != msg::kEventNone)
        std::printf("event %d of task %d, colour %d\n", event.event(), event.task(), event.colour());
      logic_.take(retrieval::GoalEvent{own(event.goal_id()), event.event(), event.goal_state(), event.colour()});
    });
    participant_.read<msg::TickPubSubType>("barrier/tick", true, 8,
                                           [this](const msg::Tick& tick) { over_ = over_ || tick.final_tick(); });
  }

  /// Returns 0 when all objects are delivered, 1 if the run ends before or after SIGTERM or Ctrl-C.
  int run() {
    while (!g_stop && !gone()) {
      participant_.wait(0.2);
      repeat_unanswered();
      if (now_s_ < options_.at_s || options_.sequence.size() - logic_.remaining().size() < options_.after) continue;
      if (!asked_ && connected()) {
        std::printf("at %.1f s: asking for authority\n", now_s_);
        msg::Request take = request(msg::kRequestTake);
        send(take);
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
        msg::Request release = request(msg::kRequestRelease);
        send(release);
        while (mine_ && !gone() && !g_stop) {  // until `input` has released authority
          participant_.wait(0.2);
          repeat_unanswered();
        }
        return 0;
      }
    }
    return 1;
  }

 private:
  /// True if the run has ended, or its processes are dead.
  bool gone() const {
    eprosima::fastdds::dds::SubscriptionMatchedStatus writers;
    pose_->get_subscription_matched_status(writers);
    return over_ || (now_s_ >= 0 && writers.current_count == 0);
  }
  /// True once `input` has been discovered. `input` does not receive requests that were written earlier.
  bool connected() const {
    eprosima::fastdds::dds::PublicationMatchedStatus readers;
    requests_->get_publication_matched_status(readers);
    return readers.current_count > 0;
  }

  /// The number that this planner gave to a goal; 0 if the goal belongs to another source. The goal id on task/event
  /// and task/status is (level << 48) + (number of the source << 32) + this number.
  std::uint64_t own(std::uint64_t goal) const {
    return mine_ && goal >> 48 == msg::kAuthorityExternal ? goal & 0xffffffffu : 0;
  }

  msg::Request request(std::uint8_t kind) {
    msg::Request request;
    request.robot_id(1);
    request.source(kName);
    request.token(token_);
    request.header().sequence_number(++sequence_);
    request.level(msg::kAuthorityExternal);
    request.kind(kind);
    request.parameters().timeout_s(std::numeric_limits<double>::quiet_NaN());
    return request;
  }
  void send(msg::Request& request) {
    unanswered_[request.header().sequence_number()] = {request, Clock::now()};
    if (!requests_->write(&request)) throw std::runtime_error("cannot write a request");
    std::fflush(stdout);
  }
  /// Repeats unanswered requests under their numbers: `input` receives nothing while its process restarts.
  void repeat_unanswered() {
    for (auto& [number, unanswered] : unanswered_) {
      if (Clock::now() - unanswered.written < std::chrono::milliseconds(500)) continue;
      requests_->write(&unanswered.request);
      unanswered.written = Clock::now();
    }
  }
  void send(const retrieval::Order& order) {
    std::printf("at %.1f s: %s (task %d, goal %llu)\n", now_s_, logic_.stage().c_str(), order.task,
                static_cast<unsigned long long>(order.goal));
    msg::Request task = request(msg::kRequestTask);
    task.command(msg::kCommandStart);
    task.goal_id(order.goal);
    task.task(order.task);
    auto& parameters = task.parameters();
    parameters.line_colour(order.line_colour);
    parameters.object_colour(order.object_colour);
    parameters.drop_zone_colour(order.zone_colour);
    parameters.direction(order.direction);
    if (order.timeout_s > 0) parameters.timeout_s(order.timeout_s);
    task.path().point_count(static_cast<std::uint16_t>(order.path.size()));
    for (std::size_t i = 0; i < order.path.size(); ++i)
      std::tie(task.path().x_m()[i], task.path().y_m()[i]) = order.path[i];
    send(task);
  }

  Options options_;
  std::string token_;
  example::Participant participant_;
  retrieval::Retrieval logic_;
  eprosima::fastdds::dds::DataWriter* requests_ = nullptr;
  eprosima::fastdds::dds::DataReader* pose_ = nullptr;
  struct Unanswered {
    msg::Request request;
    Clock::time_point written;  ///< time of the last write
  };
  std::map<std::uint64_t, Unanswered> unanswered_;  // by number
  std::uint64_t sequence_ = 0;
  double now_s_ = -1;
  bool asked_ = false, mine_ = false, commanding_ = false, over_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGTERM, [](int) { g_stop = 1; });
  std::signal(SIGINT, [](int) { g_stop = 1; });
  try {
    return Planner(parse(argc, argv)).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fastdds_planner: %s\n", error.what());
    return 70;
  }
}
