// `constrictor record`: records topics of any domain, of any type, until the user ends it.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <deque>
#include <optional>

#include "cli/introspection/domain_view.hpp"
#include "cli/recording/recording_text.hpp"
#include "cli/recording/run_files.hpp"
#include "cli/recording/topic_pattern.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/command_error.hpp"
#include "client/run_monitor.hpp"
#include "client/run_registry.hpp"
#include "common/interrupt.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/topic_tap.hpp"
#include "recording/message_cdr.hpp"
#include "runtime/domain_tap.hpp"
#include "runtime/host.hpp"
#include "runtime/version.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kLastMessages = 300ms;  // those of the end may arrive after the news of the end

struct RecordOptions {
  ViewOptions view;
  std::string file;
  std::vector<std::string> topics;
  std::string images = "on";
  double for_s = 0.0;
  bool force = false;
};

/// Which topics are recorded.
class Choice {
 public:
  explicit Choice(const RecordOptions& options) : images_(options.images == "on"), patterns_(options.topics) {}
  bool operator()(const std::string& topic) const {
    if (!patterns_.empty()) return patterns_.match(topic);
    // Samples of these two contain the checkpoints of members, which only the run itself can use.
    if (topic == barrier_topics::kTickDone.name || topic == barrier_topics::kResume.name) return false;
    return images_ || std::none_of(topics::kInfos.begin(), topics::kInfos.end(), [&](const TopicInfo& info) {
             return info.name == topic && info.type == Description<msg::CameraImage>::kName;
           });
  }

 private:
  bool images_;
  TopicPatterns patterns_;
};

/// Whether the option is accepted. Of recomputed images, `replay --restore` must find all messages from which they are
/// computed, and in the order of the ticks.
std::string problem_of_images(std::string& images) {
  if (images != "recompute") return one_of({"on", "off"})(images);
  return "found 'recompute', accepted on, off: images can only be computed again from a recording that proves to be "
         "whole, and this command cannot prove it, because the run does not wait for it; use `constrictor run --record "
         "--images recompute`";
}

/// A new file that begins with these attachments.
std::unique_ptr<mcap::Writer> begin_file(const std::string& file, const std::vector<mcap::Attachment>& attachments) {
  auto writer = std::make_unique<mcap::Writer>(file, "", fmt::format("constrictor {}", kVersion));
  for (const auto& attachment : attachments) writer->attach(attachment);
  return writer;
}

/// The recording of one domain.
class DomainRecorder {
 public:
  DomainRecorder(const RecordOptions& options, const DomainView& view, const std::vector<mcap::Attachment>& attachments)
      : tap_(view.participant(), Choice(options)), sink_(begin_file(options.file, attachments), false) {}
  void poll(std::chrono::milliseconds bound) {
    tap_.discover();
    tap_.wait(bound);
    tap_.take([this](const dds::TopicTap::Topic& topic, const dds::RawSample& sample) { take(topic, sample); });
    sink_.poll();
  }
  [[nodiscard]] std::string failure() const { return sink_.failure(); }
  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  [[nodiscard]] std::uint64_t bytes() const { return sink_.writer().size(); }
  [[nodiscard]] std::size_t topics() const { return tap_.topics().size(); }
  [[nodiscard]] const std::map<std::string, std::string>& refused() const { return tap_.refused(); }
  /// Writes the end of the file. Returns the error; empty if there was none.
  std::string finish(std::vector<mcap::Metadata> last) {
    mcap::Texts gaps;
    for (const auto& [topic, count] : tap_.lost()) gaps[topic] = std::to_string(count);
    if (!gaps.empty()) last.push_back({"gaps", gaps});
    return sink_.finish(std::move(last));
  }

 private:
  void take(const dds::TopicTap::Topic& topic, const dds::RawSample& sample) {
    auto& channel = channels_[&topic];
    if (!channel) channel = std::make_unique<Channel>(topic);
    const auto now_ns = static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
            .count());
    newest_ns_ = std::max(newest_ns_, now_ns);  // a clock that is set back must not reorder the messages
    std::uint32_t sequence = ++channel->count;
    if (channel->codec) {
      if (const auto header = channel->codec->header(sample.bytes))
        sequence = static_cast<std::uint32_t>(header->sequence_number);
    }
    sink_.write({&channel->recorded, sequence, newest_ns_, static_cast<std::uint64_t>(sample.source_time_ns),
                 mcap::text_of(sample.bytes)});
    ++messages_;
  }
  struct Channel {
    explicit Channel(const dds::TopicTap::Topic& topic)
        : recorded(channel_of_topic(topic)),
          codec(topic.type.starts_with("constrictor::msg::") ? find_codec(topic.type.substr(18)) : nullptr) {}
    RecordedChannel recorded;
    const MessageCodec* codec;  ///< null: of another project
    std::uint32_t count = 0;
  };

  dds::TopicTap tap_;
  std::map<const dds::TopicTap::Topic*, std::unique_ptr<Channel>> channels_;
  std::uint64_t newest_ns_ = 0;
  std::uint64_t messages_ = 0;
  RecordingSink sink_;
};

int record(const RecordOptions& options) {
  survive_closed_pipes();
  interrupted();  // from now on, Ctrl-C ends the recording in order
  if (!options.force && std::filesystem::exists(options.file))
    throw UsageError(fmt::format("FILE: found {}, which exists, accepted a new file (or --force)", options.file));
  const DomainView view(options.view);
  view.settle_or_throw();
  const RunFiles files = files_of_run(view.domain());
  if (!files.missing.empty()) fmt::print(stderr, "record: {}\n", files.missing);
  DomainRecorder recorder(options, view, files.attachments);
  fmt::print("recording DDS domain {} in {}; Ctrl-C ends it\n", view.domain(), options.file);
  std::fflush(stdout);
  std::optional<RunMonitor> monitor;
  if (const auto run = live_run(view.domain())) monitor.emplace(*run, view.participant());
  const auto start = Clock::now();
  auto told = start;
  std::set<std::string> named;
  while (!interrupted() && recorder.failure().empty()) {
    recorder.poll(50ms);
    const auto now = Clock::now();
    if (monitor) monitor->poll();
    if (monitor && !monitor->attachment().over().empty()) {
      fmt::print("{}\n", monitor->attachment().over());
      for (const auto end = now + kLastMessages; Clock::now() < end;) recorder.poll(50ms);
      break;
    }
    if (options.for_s > 0 && std::chrono::duration<double>(now - start).count() >= options.for_s) break;
    for (const auto& [topic, why] : recorder.refused()) {
      if (named.insert(topic).second) fmt::print(stderr, "record: {} cannot be read: {}\n", topic, why);
    }
    if (now - told < 5s) continue;
    told = now;
    fmt::print("{}, {:.1f} MB\n", amount_text(recorder.messages(), recorder.topics()),
               static_cast<double>(recorder.bytes()) * 1e-6);
    std::fflush(stdout);
  }
  std::vector<mcap::Metadata> last;
  last.push_back({"recording",
                  {{"kind", "domain"},
                   {"log_time", "wall"},
                   {"images", options.images},
                   {"domain", std::to_string(view.domain())}}});
  const std::string failure = recorder.failure();
  if (!failure.empty()) last.push_back({"dropped", {{"reason", failure}}});
  const std::string error = recorder.finish(std::move(last));
  const RecordingSummary summary = summarise_recording(options.file);
  fmt::print("{}: {}\n", options.file, describe_recording(summary));
  if (!error.empty()) throw CommandError("record: " + error);
  if (summary.messages == 0 && !options.topics.empty()) {
    fmt::print(stderr, "record: no message of a topic like {} arrived (`constrictor topic list`)\n",
               fmt::join(options.topics, ", "));
    return kMissing;
  }
  return summary.missing() == 0 ? exit_status::kOk : kMissing;
}

}  // namespace

void add_record(CLI::App& app, Action& action) {
  auto options = std::make_shared<RecordOptions>();
  auto* sub = add_subcommand(app, "record", "record topics of a run, or of any DDS domain, in an MCAP file", action,
                             options, record);
  sub->add_option("FILE", options->file, "the recording")->required();
  add_view_options(*sub, options->view);
  sub->remove_option(sub->get_option("--json"));
  sub->add_option("--topic", options->topics,
                  "record only these topics; * and ? stand for any characters; may be repeated (default: all but\n"
                  "barrier/tick_done and barrier/resume, which contain the checkpoints of members)")
      ->allow_extra_args(false);
  sub->add_option("--images", options->images,
                  "on, or off: leave the images of cameras out. To record them without their pixels, which can be\n"
                  "computed again: constrictor run --record --images recompute")
      ->capture_default_str()
      ->check(CLI::Validator(problem_of_images, "{on,off}"));
  sub->add_option("--for", options->for_s, "[s] end after this time (default: until Ctrl-C, or the end of the run)")
      ->check(number(1e-3, 1e9, "s"));
  sub->add_flag("--force", options->force, "replace FILE if it exists");
  sub->footer(help_footer(
      "Records from now on, and what writers keep for late readers. Also topics of other programs; those whose "
      "writers\n"
      "do not describe their type become bytes without schema. The run does not wait for this recorder: if it is too\n"
      "slow, messages are missing, and they are counted by topic. `constrictor run --record` misses nothing.\n"
      "SIGKILL loses at most the last 0.25 s; `constrictor recover` then finishes the file. The file contains the\n"
      "run's token if a client sent a command; it is readable by its owner only. If the run was started on this host,\n"
      "scenario, robot, manifest, configuration and versions are attached, as these files are now.\n"
      "--images recompute exists only for `constrictor run --record`: images are computed again from all other\n"
      "messages, so that none may be missing.",
      {"constrictor record session.mcap",
       "constrictor record arm.mcap --topic 'joint_*' --topic guidance/pose --for 10"},
      "0 nothing is missing; 1 messages are missing, or no topic matched; 64 wrong usage; 70 no run, or the file "
      "cannot be written",
      kDomainEnvironment));
}

}  // namespace constrictor::cli
