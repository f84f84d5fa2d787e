#include "cli/recording/player.hpp"

#include <fmt/format.h>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <thread>
#include <utility>

#include "cli/recording/key_input.hpp"
#include "cli/recording/recording_text.hpp"
#include "cli/recording/replayed_topics.hpp"
#include "cli/recording/topic_pattern.hpp"
#include "cli/usage.hpp"
#include "client/command_error.hpp"
#include "common/interrupt.hpp"
#include "common/replay_control.hpp"
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

constexpr auto kMeet = 500ms;  // until readers that exist have met the writers
constexpr auto kLongestWait = 50ms;
constexpr auto kControlEvery = 10ms;

class Player {
 public:
  explicit Player(const PlayOptions& options)
      : options_(options),
        patterns_(options.topics),
        claim_(options.domain),
        domain_(claim_.domain()),
        speed_(options.speed),
        paused_(options.paused) {
    refuse_a_run();
    control_.emplace(claim_.domain());
  }

  int play() {
    {
      mcap::Reader reader(options_.file);
      reader.read();
      begin_ns_ = reader.contents().statistics.start_time;
      end_ns_ = std::max(begin_ns_, reader.contents().statistics.end_time);
      refuse_empty_choice(options_, reader.contents());
    }
    try {
      for (std::optional<double> from_s = options_.from_s; from_s;) {
        try {
          read_from(*from_s);
          from_s.reset();
          wait_at_the_end();
        } catch (const Seek& seek) {
          from_s = seek.to_s;
        }
      }
    } catch (const Ended&) {}
    report_end();
    return exit_status::kOk;
  }

 private:
  struct Ended {};
  struct Seek {
    double to_s;  ///< after the first message
  };
  struct Early {
    mcap::Channel channel;
    std::deque<std::string> cdrs;
  };

  void read_from(double from_s) {
    const auto from_ns = begin_ns_ + static_cast<std::uint64_t>(from_s * 1e9);
    before_.clear();
    start_.reset();
    position_ns_ = std::min(from_ns, end_ns_);
    over_ = false;
    mcap::Reader reader(options_.file);
    reader.read({[&](const mcap::Channel& channel, const mcap::Message& message) {
                   if (!wanted(channel)) return;
                   if (message.log_time >= from_ns) return play(channel, message);
                   Early& early = before_[channel.id];
                   early.channel = channel;
                   early.cdrs.emplace_back(mcap::text_of(message.data));
                   if (early.cdrs.size() > kept_before(channel.topic)) early.cdrs.pop_front();
                 },
                 nullptr, nullptr});
    begin_playing(from_ns);
  }

  void report_end() {
    if (std::exchange(told_end_, true)) return;
    fmt::print("{} in DDS domain {}\n", amount_text(count_, writers_.size()), claim_.domain());
    std::fflush(stdout);
  }

  /// A program that controls the replay may seek back.
  void wait_at_the_end() {
    over_ = true;
    position_ns_ = end_ns_;
    if (options_.stay) report_end();
    while (options_.stay || control_->watched()) {
      obey_control();
      react(keys_.read(kLongestWait));
    }
  }

  [[nodiscard]] ReplayState state() const {
    const auto seconds = [&](std::uint64_t time_ns) {
      return time_ns > begin_ns_ ? static_cast<double>(time_ns - begin_ns_) * 1e-9 : 0.0;
    };
    return {seconds(position_ns_), seconds(end_ns_), speed_.value_or(0.0), paused_, over_, options_.file.string()};
  }

  /// Executes the commands of programs that control the replay.
  void obey_control() {
    controlled_ = Clock::now();
    std::optional<Seek> seek;
    const auto go_to = [&](double time_s) {
      seek = Seek{std::min(time_s, state().length_s)};
      position_ns_ = begin_ns_ + static_cast<std::uint64_t>(seek->to_s * 1e9);
      over_ = false;
    };
    control_->poll([&](const ReplayRequest& request) {
      switch (request.kind) {
        case ReplayRequest::Kind::kState:
          break;
        case ReplayRequest::Kind::kPause:
          paused_ = true;
          steps_ = 0;
          break;
        case ReplayRequest::Kind::kResume:
          paused_ = false;
          if (over_) go_to(0.0);  // to play it once more
          break;
        case ReplayRequest::Kind::kStep:
          paused_ = true;
          steps_ += static_cast<std::uint64_t>(request.value);
          break;
        case ReplayRequest::Kind::kSpeed:
          speed_ = request.value == 0 ? std::nullopt : std::optional(request.value);
          if (start_) start_ = std::max(*start_, Clock::now());
          start_ns_ = position_ns_;
          break;
        case ReplayRequest::Kind::kSeek:
          go_to(request.value);
          break;
      }
      return state();
    });
    if (seek) throw Seek(*seek);
  }

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
    if (!told_begin_) {
      fmt::print("replaying {} in DDS domain {}; `constrictor dashboard --run {}` shows it\n", options_.file.string(),
                 claim_.domain(), claim_.domain());
      std::fflush(stdout);
    }
    for (const auto& [id, early] : before_) {
      for (const auto& cdr : early.cdrs) write(early.channel, mcap::bytes_of(cdr));
    }
    before_.clear();
    start_ = Clock::now() + (told_begin_ ? 0ms : kMeet);
    start_ns_ = from_ns;
    told_begin_ = true;
  }

  void play(const mcap::Channel& channel, const mcap::Message& message) {
    if (!start_) {
      begin_playing(message.log_time);
      writer_of(channel, message.data);  // exists before the first message is due
    }
    const bool tick = channel.topic == barrier_topics::kTick.name;
    if (Clock::now() - controlled_ > kControlEvery) obey_control();
    wait_for(message.log_time);
    if (paused_ && steps_ == 0) wait_paused(message.log_time);
    write(channel, message.data);
    position_ns_ = message.log_time;
    if (tick && steps_ > 0) --steps_;
  }

  void react(char key) {
    if (key == 'q' || ended()) throw Ended{};
    if (key == ' ') paused_ = !paused_;
    if (key == 's') {
      paused_ = true;
      steps_ = 1;
    }
  }

  void wait_for(std::uint64_t time_ns) {
    for (;;) {
      if (ended()) throw Ended{};
      if (paused_ || (!speed_ && Clock::now() >= *start_)) return;
      const double ahead_s =
          speed_ && time_ns > start_ns_ ? static_cast<double>(time_ns - start_ns_) * 1e-9 / *speed_ : 0.0;
      const auto due = *start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(ahead_s));
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(due - Clock::now());
      if (left <= 0ms) return;
      react(keys_.read(std::min<std::chrono::milliseconds>(left, kLongestWait)));
      obey_control();
    }
  }

  /// Waits for the end of the pause, or for the permission of a tick. Time goes on from `time_ns` then.
  void wait_paused(std::uint64_t time_ns) {
    if (!told_pause_) fmt::print("paused: the space bar continues, s makes one tick, q ends\n");
    std::fflush(stdout);
    told_pause_ = true;
    while (paused_ && steps_ == 0) {
      react(keys_.read(kLongestWait));
      obey_control();
    }
    start_ = Clock::now();
    start_ns_ = time_ns;
  }

  const PlayOptions& options_;
  TopicPatterns patterns_;
  DomainClaim claim_;
  dds::Domain domain_;
  KeyInput keys_;
  std::optional<ReplayServer> control_;                               ///< after the check that the domain has no run
  std::map<std::uint16_t, std::unique_ptr<dds::RawWriter>> writers_;  ///< by channel
  std::map<std::uint16_t, Early> before_;                             ///< last messages before the beginning
  std::uint64_t begin_ns_ = 0, end_ns_ = 0;                           ///< of the first and the last message
  std::uint64_t position_ns_ = 0;                                     ///< of the newest message that was published
  std::uint64_t start_ns_ = 0;                                        ///< log time that is due at `start_`
  std::optional<Clock::time_point> start_;
  Clock::time_point controlled_{};  ///< when requests of other programs were looked for
  std::optional<double> speed_;     ///< times the recorded speed; empty: as fast as possible
  bool paused_;
  std::uint64_t steps_ = 0;  ///< ticks that the pause still lets through
  bool over_ = false;
  bool told_begin_ = false, told_pause_ = false, told_end_ = false;
  std::uint64_t count_ = 0;
};

}  // namespace

int play_recording(const PlayOptions& options) {
  catch_interrupts({SIGINT, SIGTERM});
  return Player(options).play();
}

}  // namespace constrictor::cli
