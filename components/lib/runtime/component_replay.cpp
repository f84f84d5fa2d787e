#include "runtime/component_replay.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "barrier/topic_ops.hpp"
#include "configuration/closest_name.hpp"
#include "configuration/configuration.hpp"
#include "configuration/counted.hpp"
#include "configuration/whole_file.hpp"
#include "faults/faulty_component.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/message_cdr.hpp"
#include "runtime/host.hpp"
#include "runtime/recorded_run.hpp"
#include "runtime/replayed_member.hpp"
#include "runtime/restored_copy.hpp"
#include "runtime/wire.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;
namespace wire = barrier_topics;

class ComponentReplay {
 public:
  ComponentReplay(const fs::path& recording, const std::vector<std::string>& components, const FindFactory& find,
                  const fs::path& output, const ReplayHooks& hooks = {})
      : run_(recording, output), find_(find), wanted_(components), concludes_(!output.empty()), hooks_(hooks) {
    plan_ = std::make_shared<const FaultPlan>(load_fault_plan(run_.faults(), {run_.roster}));
    for (const auto& name : components) add(name);
  }

  /// Writes a copy with all images, too.
  std::vector<ReplayResult> restore(const fs::path& recording, const fs::path& restored) {
    if (run_.entry("images") != "recompute") {
      throw run_.wrong(fmt::format("found a recording made with --images {}, accepted one with --images recompute",
                                   run_.entry("images")));
    }
    for (const auto& topic : topics::kInfos) {
      const std::string writer(topic.writer);
      const auto& roster = run_.roster;
      if (!is_image(topic) || std::find(roster.begin(), roster.end(), writer) == roster.end()) continue;
      add(writer);
      if (std::find(wanted_.begin(), wanted_.end(), writer) == wanted_.end()) wanted_.push_back(writer);
    }
    mcap::Reader reader(recording);
    copy_ = std::make_unique<RestoredCopy>(restored, reader);
    auto results = run(reader);
    if (const std::size_t missing = copy_->finish(); missing > 0 && !results.empty() && results[0].stopped.empty())
      results[0].stopped = fmt::format("{} could not be computed", counted(missing, "image"));
    return results;
  }

  std::vector<ReplayResult> run(const fs::path& recording) {
    mcap::Reader reader(recording);
    return run(reader);
  }

 private:
  std::vector<ReplayResult> run(mcap::Reader& reader) {
    mcap::Visitor visitor;
    visitor.message = [this](const auto& channel, const auto& message) { take(channel, message); };
    if (copy_) {
      visitor.attachment = [this](const mcap::Attachment& one) { copy_->copy(one); };
      visitor.metadata = [this](const mcap::Metadata& one) { copy_->copy(one); };
    }
    reader.read(visitor);
    std::vector<ReplayResult> results;
    for (const auto& name : wanted_) {
      if (concludes_) members_.at(name)->conclude();
      results.push_back(members_.at(name)->result());
    }
    return results;
  }

  void add(const std::string& name) {
    if (members_.contains(name)) return;
    if (std::find(run_.roster.begin(), run_.roster.end(), name) == run_.roster.end()) {
      throw run_.wrong(fmt::format("found no component '{}', accepted {}{}", name, fmt::join(run_.roster, ", "),
                                   did_you_mean(name, run_.roster)));
    }
    auto factory = find_(name);
    if (!factory) throw run_.wrong(fmt::format("this program does not contain the component '{}'", name));
    members_[name] = std::make_unique<ReplayedMember>(
        with_faults(std::move(*factory), plan_), run_.setup_of(name), run_.pixels, run_.requests,
        [this](const TopicInfo& topic, const Sample& sample) { pass_on(topic, sample); });
    if (run_.pixels) return;
    // Components that read images need the pixels: the components that write the images are replayed, too.
    for (const auto& topic : topics::kInfos) {
      const std::string writer(topic.writer);
      if (is_image(topic) && members_[name]->member().reads().contains(topic.id) &&
          std::find(run_.roster.begin(), run_.roster.end(), writer) != run_.roster.end())
        add(writer);
    }
  }
  static bool is_image(const TopicInfo& topic) { return topic.type == Description<msg::CameraImage>::kName; }

  /// Images that were made again go to their readers.
  void pass_on(const TopicInfo& topic, const Sample& sample) {
    if (run_.pixels || !is_image(topic)) return;
    const auto image = std::static_pointer_cast<const msg::CameraImage>(sample.message);
    if (copy_) copy_->complete(topic, *image);
    if (hooks_.image) hooks_.image(topic, image);
    for (auto& [name, member] : members_) {
      if (member->member().reads().contains(topic.id)) member->take_input(topic.id, sample);
    }
  }

  void take(const mcap::Channel& channel, const mcap::Message& message) {
    if (hooks_.message) hooks_.message(channel, message);
    const auto info = std::find_if(topics::kInfos.begin(), topics::kInfos.end(),
                                   [&](const TopicInfo& one) { return one.name == channel.topic; });
    if (copy_) {
      if (info != topics::kInfos.end() && is_image(*info)) copy_->expect(*info, channel, message);
      else copy_->copy(channel, message);
    }
    if (info != topics::kInfos.end()) return take_member(*info, message.data);
    if (channel.topic == wire::kTick.name) {
      const auto tick = message_of<msg::Tick>(message.data);
      for (auto& [name, member] : members_) {
        if (tick) member->take(*tick);
      }
    } else if (channel.topic == wire::kTickDone.name) {
      const auto done = message_of<msg::TickDone>(message.data);
      const auto member = done ? members_.find(done->component) : members_.end();
      if (member == members_.end()) return;
      if (const auto step = from_wire(*done)) member->second->take(*step);
    } else if (channel.topic == wire::kEpochStart.name) {
      const auto start = message_of<msg::EpochStart>(message.data);
      for (auto& [name, member] : members_) {
        if (start) member->take(*start);
      }
    }
  }

  void take_member(const TopicInfo& topic, mcap::Bytes cdr) {
    const auto writer = members_.find(std::string(topic.writer));
    const bool made_again = !run_.pixels && is_image(topic);
    bool used = writer != members_.end();
    for (const auto& [name, member] : members_) used |= member->member().reads().contains(topic.id);
    std::string canonical;
    if (!used || !find_codec(topic.type)->from_cdr(cdr, canonical)) return;
    if (writer != members_.end()) writer->second->take_output(topic.id, canonical);
    if (made_again) return;
    const Sample sample = topic_ops(topic.id).parse(std::as_bytes(std::span(canonical)));
    if (!sample.message) return;
    for (auto& [name, member] : members_) {
      if (member->member().reads().contains(topic.id)) member->take_input(topic.id, sample);
    }
  }

  RecordedRun run_;
  const FindFactory& find_;
  std::vector<std::string> wanted_;
  bool concludes_;
  ReplayHooks hooks_;
  std::shared_ptr<const FaultPlan> plan_;
  std::map<std::string, std::unique_ptr<ReplayedMember>> members_;
  std::unique_ptr<RestoredCopy> copy_;  ///< null: none is written
};

}  // namespace

std::vector<ReplayResult> replay_components(const fs::path& recording, const std::vector<std::string>& components,
                                            const FindFactory& find, const fs::path& output, const ReplayHooks& hooks) {
  return ComponentReplay(recording, components, find, output, hooks).run(recording);
}

std::vector<ReplayResult> restore_images(const fs::path& recording, const fs::path& restored, const FindFactory& find) {
  NewFile file = NewFile::of_this_process(restored);
  auto results = ComponentReplay(recording, {}, find, {}).restore(recording, file.part());
  file.complete();
  return results;
}

int replay_main(const std::vector<std::string>& arguments, const FindFactory& find) {
  const bool keeps = arguments.size() > 3 && arguments[1] == "--output";
  const bool restores = arguments.size() == 3 && arguments[1] == "--restore";
  const std::vector<std::string> components(arguments.begin() + (keeps ? 3 : 1), arguments.end());
  try {
    fs::path output;
    if (keeps) fs::create_directories(output = fs::absolute(arguments[2]));
    bool equal = true;
    for (const auto& result : restores ? restore_images(arguments[0], arguments[2], find)
                                       : replay_components(arguments[0], components, find, output)) {
      fmt::print("{}: {}, {}", result.component, counted(result.steps, "step"), counted(result.messages, "message"));
      equal = equal && !result.difference && result.stopped.empty() && result.steps > 0;
      if (const auto& difference = result.difference) {
        fmt::print("; first difference: tick {}, topic {}", difference->tick, difference->topic);
        if (!difference->field.empty()) fmt::print(", field {}", difference->field);
        fmt::print("\n  recorded: {}\n  replayed: {}\n", difference->recorded, difference->replayed);
      } else if (!result.stopped.empty()) {
        fmt::print("; stopped: {}\n", result.stopped);
      } else {
        fmt::print("; {}\n", result.steps > 0 ? "equal" : "the recording has no step of it");
      }
    }
    return equal ? exit_status::kOk : exit_status::kFailed;
  } catch (const ConfigurationError& error) {
    fmt::print(stderr, "replay: {}\n", error.what());
    return exit_status::kConfiguration;
  } catch (const std::exception& error) {
    fmt::print(stderr, "replay: {}\n", error.what());
    return exit_status::kSoftware;
  }
}

}  // namespace constrictor
