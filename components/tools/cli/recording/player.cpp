#include "cli/recording/player.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <memory>
#include <sstream>
#include <thread>

#include "cli/interrupt.hpp"
#include "cli/recording/topic_pattern.hpp"
#include "cli/usage.hpp"
#include "client/command_error.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/discovery.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/raw_writer.hpp"
#include "recording/mcap_reader.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kMeet = 500ms;    // until readers that exist have met the writers
constexpr int kLeastDepth = 64;  // of topics with several instances, which count as one here
constexpr auto kLongestWait = 50ms;

/// Single keys from a terminal; nothing if the input is no terminal.
class Keys {
 public:
  Keys() : terminal_(::isatty(STDIN_FILENO) == 1 && ::tcgetattr(STDIN_FILENO, &before_) == 0) {
    if (!terminal_) return;
    termios raw = before_;
    raw.c_lflag &= static_cast<tcflag_t>(~(ICANON | ECHO));
    ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  ~Keys() {
    if (terminal_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;
  /// The key that was typed within `bound`; 0: none.
  [[nodiscard]] char read(std::chrono::milliseconds bound) const {
    if (!terminal_) {
      std::this_thread::sleep_for(bound);
      return 0;
    }
    pollfd input{STDIN_FILENO, POLLIN, 0};
    char key = 0;
    if (::poll(&input, 1, static_cast<int>(bound.count())) <= 0 || ::read(STDIN_FILENO, &key, 1) != 1) return 0;
    return key;
  }

 private:
  termios before_{};
  bool terminal_;
};

/// Commands to a run and what proves membership: nobody should obey them again.
bool is_command(const std::string& topic) {
  namespace wire = barrier_topics;
  return topic == wire::kRequest.name || topic == wire::kRunControl.name || topic == wire::kEmergencyStop.name ||
         topic == wire::kHello.name || topic == wire::kResume.name;
}

int depth_of(const std::string& topic) {
  int depth = kLeastDepth;
  for (const auto& info : topics::kInfos) {
    if (info.name == topic) depth = info.depth;
  }
  for (const auto& info : barrier_topics::kInfos) {
    if (info.name == topic) depth = std::max(depth, info.depth);
  }
  return depth;
}

class Player {
 public:
  explicit Player(const PlayOptions& options)
      : options_(options), patterns_(options.topics), claim_(options.domain), domain_(claim_.domain()) {
    refuse_a_run();
    paused_ = options.paused;
  }

  int play() {
    {
      mcap::Reader reader(options_.file);
      reader.read();
      begin_ns_ = reader.contents().statistics.start_time;
    }
    const auto from_ns = begin_ns_ + static_cast<std::uint64_t>(options_.from_s * 1e9);
    mcap::Reader reader(options_.file);
    try {
      reader.read({[&](const mcap::Channel& channel, const mcap::Message& message) {
                     if (!wanted(channel)) return;
                     if (message.log_time >= from_ns) play(channel, message);
                     else before_[channel.id] = {channel, std::string(mcap::text_of(message.data))};
                   },
                   nullptr, nullptr});
      begin_playing(from_ns);
    } catch (const Ended&) {}
    fmt::print("{} messages of {} topics in DDS domain {}\n", count_, writers_.size(), claim_.domain());
    std::fflush(stdout);
    while (options_.stay && !ended()) static_cast<void>(keys_.read(kLongestWait));
    return exit_status::kOk;
  }

 private:
  struct Ended {};
  struct Early {
    mcap::Channel channel;
    std::string cdr;
  };

  void refuse_a_run() const {
    const dds::Discovery discovery(domain_.participant());
    const auto end = Clock::now() + kMeet;
    while (Clock::now() < end && !ended()) {
      for (const auto& endpoint : discovery.endpoints()) {
        if (endpoint.writer && endpoint.topic == barrier_topics::kTick.name)
          throw CommandError(
              fmt::format("found a run in DDS domain {}, accepted a domain without a run, because the "
                          "replay writes the topics of a run",
                          claim_.domain()));
      }
      std::this_thread::sleep_for(20ms);
    }
  }
  [[nodiscard]] static bool ended() { return interrupt_signal() != 0; }

  [[nodiscard]] bool wanted(const mcap::Channel& channel) const {
    return channel.metadata.contains("dds_type") &&
           (patterns_.empty() ? !is_command(channel.topic) : patterns_.match(channel.topic));
  }

  dds::RawWriter& writer_of(const mcap::Channel& channel, mcap::Bytes cdr) {
    auto& writer = writers_[channel.id];
    if (!writer) {
      const auto keyed = channel.metadata.find("keyed");
      constexpr std::uint8_t kFirstOfXcdr2 = 6;  // identifiers of the encapsulation header
      const dds::RawWriter::Type type{channel.metadata.at("dds_type"),
                                      keyed == channel.metadata.end() || keyed->second == "yes",
                                      cdr.size() > 1 && cdr[1] >= kFirstOfXcdr2};
      writer = std::make_unique<dds::RawWriter>(domain_.participant(), channel.topic, type, depth_of(channel.topic));
    }
    return *writer;
  }

  void write(const mcap::Channel& channel, mcap::Bytes cdr) {
    if (cdr.size() < 4) return;  // no encapsulation header: no sample of DDS
    writer_of(channel, cdr).write(cdr);
    ++count_;
  }

  /// Publishes the last messages before the beginning, so that readers know the scene.
  void begin_playing(std::uint64_t from_ns) {
    if (start_) return;
    fmt::print("replaying {} in DDS domain {}\n", options_.file.string(), claim_.domain());
    std::fflush(stdout);
    for (const auto& [id, early] : before_) write(early.channel, mcap::bytes_of(early.cdr));
    before_.clear();
    start_ = Clock::now() + kMeet;
    start_ns_ = from_ns;
  }

  void play(const mcap::Channel& channel, const mcap::Message& message) {
    if (!start_) {
      begin_playing(message.log_time);
      writer_of(channel, message.data);  // exists before the first message is due
    }
    const bool tick = channel.topic == barrier_topics::kTick.name;
    wait_for(message.log_time);
    if (paused_) wait_paused(message.log_time, tick);
    write(channel, message.data);
    if (tick && step_) {
      step_ = false;
      paused_ = true;
    }
  }

  void react(char key) {
    if (key == 'q' || ended()) throw Ended{};
    if (key == ' ') paused_ = !paused_;
    if (key == 's') paused_ = step_ = true;
  }

  void wait_for(std::uint64_t time_ns) {
    for (;;) {
      if (ended()) throw Ended{};
      if (paused_ || (!options_.speed && Clock::now() >= *start_)) return;
      const double ahead_s = options_.speed && time_ns > start_ns_
                                 ? static_cast<double>(time_ns - start_ns_) * 1e-9 / *options_.speed
                                 : 0.0;
      const auto due = *start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(ahead_s));
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(due - Clock::now());
      if (left <= 0ms) return;
      react(keys_.read(std::min<std::chrono::milliseconds>(left, kLongestWait)));
    }
  }

  /// Waits for the end of the pause, or for the permission of one tick. Time goes on from `time_ns` then.
  void wait_paused(std::uint64_t time_ns, bool) {
    if (!told_) fmt::print("paused: the space bar continues, s makes one tick, q ends\n");
    std::fflush(stdout);
    told_ = true;
    while (paused_ && !step_) react(keys_.read(kLongestWait));
    if (step_) paused_ = false;
    start_ = Clock::now();
    start_ns_ = time_ns;
  }

  const PlayOptions& options_;
  TopicPatterns patterns_;
  DomainClaim claim_;
  dds::Domain domain_;
  Keys keys_;
  std::map<std::uint16_t, std::unique_ptr<dds::RawWriter>> writers_;  ///< by channel
  std::map<std::uint16_t, Early> before_;                             ///< last messages before the beginning
  std::uint64_t begin_ns_ = 0;
  std::uint64_t start_ns_ = 0;  ///< log time that is due at `start_`
  std::optional<Clock::time_point> start_;
  bool paused_ = false;
  bool step_ = false;
  bool told_ = false;
  std::uint64_t count_ = 0;
};

}  // namespace

int play_recording(const PlayOptions& options) {
  catch_interrupts({SIGINT, SIGTERM});
  return Player(options).play();
}

std::vector<std::string> recorded_roster(const std::filesystem::path& file) {
  std::vector<std::string> names;
  mcap::Reader(file).read({nullptr, nullptr, [&](const mcap::Metadata& metadata) {
                             const auto roster = metadata.entries.find("roster");
                             if (metadata.name != "recording" || roster == metadata.entries.end()) return;
                             std::istringstream list(roster->second);
                             for (std::string name; std::getline(list, name, ',');) names.push_back(name);
                           }});
  if (names.empty())
    throw UsageError(fmt::format("FILE: found {}, accepted a recording of `constrictor run --record`", file.string()));
  return names;
}

}  // namespace constrictor::cli
