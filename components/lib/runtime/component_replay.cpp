#include "runtime/component_replay.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <set>
#include <sstream>

#include "barrier/topic_ops.hpp"
#include "component/data_path.hpp"
#include "configuration/closest_name.hpp"
#include "configuration/configuration.hpp"
#include "faults/faulty_component.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/message_cdr.hpp"
#include "runtime/host.hpp"
#include "runtime/replayed_member.hpp"
#include "runtime/version.hpp"
#include "runtime/wire.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;
namespace wire = barrier_topics;

/// A folder for the attached files and for what components write; its destructor removes it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "constrictor-replay-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("cannot make a folder in " + name);
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream list(text);
  for (std::string part; std::getline(list, part, ',');) parts.push_back(part);
  return parts;
}

template <class T>
T number_of(const std::string& text) {
  T value{};
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// What a replay must know before it begins: the first pass over the file.
class Prepared {
 public:
  Prepared(const fs::path& recording, const fs::path& output) : file_(recording), output_(output) {
    mcap::Reader reader(recording);
    std::map<std::string, std::string> attachments;
    reader.read({[this](const auto& channel, const auto& message) { take(channel, message); },
                 [&](const mcap::Attachment& one) { attachments[one.name] = one.data; },
                 [this](const mcap::Metadata& one) {
                   if (one.name == "recording") entries_ = one.entries;
                 }});
    if (entry("kind") != "run")
      throw wrong("it was not made by `constrictor run --record`, so that inputs of components may be missing");
    const std::string release = fmt::format("constrictor {}", kVersion);
    if (reader.contents().library != release)
      throw wrong(
          fmt::format("found a recording of release '{}', accepted '{}': another release computes other results",
                      reader.contents().library, release));
    roster = split(entry("roster"));
    pixels = entry("images") == "on";
    store(attachments);
  }

  [[nodiscard]] std::string entry(const std::string& name) const {
    const auto found = entries_.find(name);
    return found == entries_.end() ? "" : found->second;
  }
  [[nodiscard]] ConfigurationError wrong(const std::string& why) const {
    return ConfigurationError(file_.string() + ": " + why);
  }
  /// The set-up that a component had in the run.
  [[nodiscard]] Setup setup_of(const std::string& component) const {
    Setup setup;
    setup.component = component;
    setup.robot_file = folder_.path() / "robot.yaml";
    setup.scenario_file = scenario_;
    setup.output_dir = output_.empty() ? folder_.path() / "output" : output_;
    setup.mission = entry("mission");
    setup.max_sim_time_s = number_of<double>(entry("max_sim_time_s"));
    setup.robot_id = number_of<std::uint16_t>(entry("robot_id"));
    setup.seed = seed_;
    const fs::path config = folder_.path() / "configuration" / (component + ".yaml");
    if (fs::exists(config)) setup.config_file = config;
    for (const auto& latency : split(entry("latency_ticks"))) {
      if (latency.starts_with(component + "="))
        setup.latency_ticks = number_of<std::uint16_t>(latency.substr(component.size() + 1));
    }
    return setup;
  }
  [[nodiscard]] fs::path faults() const {
    const fs::path file = folder_.path() / "faults.yaml";
    return fs::exists(file) ? file : fs::path();
  }

  std::vector<std::string> roster;
  bool pixels = false;  ///< whether images were recorded whole
  RecordedRequests requests;

 private:
  void take(const mcap::Channel& channel, const mcap::Message& message) {
    if (channel.topic == wire::kRequest.name) {
      if (const auto request = message_of<msg::Request>(message.data))
        requests[{text_of(request->source), request->header.sequence_number}] = *request;
    } else if (channel.topic == wire::kEpochStart.name && seed_ == 0) {
      if (const auto start = message_of<msg::EpochStart>(message.data)) seed_ = start->seed;
    }
  }
  /// Writes the attachments that components read into the folder. Their names come from the file, so only known ones
  /// are used.
  void store(const std::map<std::string, std::string>& attachments) {
    const fs::path name = entry("scenario");
    scenario_ = folder_.path() / (name.filename().empty() ? fs::path("scenario.yaml") : name.filename());
    fs::create_directories(folder_.path() / "output");
    fs::create_directories(folder_.path() / "configuration");
    const auto write = [&](const std::string& attachment, const fs::path& path) {
      const auto found = attachments.find(attachment);
      if (found != attachments.end()) std::ofstream(path, std::ios::binary) << found->second;
      return found != attachments.end();
    };
    if (!write("scenario.yaml", scenario_)) throw wrong("found no attachment scenario.yaml, accepted one");
    if (!write("robot.yaml", folder_.path() / "robot.yaml"))
      throw wrong("found no attachment robot.yaml, accepted one");
    write("faults.yaml", folder_.path() / "faults.yaml");
    for (const auto& component : roster) {
      if (component.find('/') != std::string::npos) throw wrong(fmt::format("found component '{}'", component));
      const std::string file = "configuration/" + component + ".yaml";
      write(file, folder_.path() / file);
    }
  }

  fs::path file_;
  fs::path output_;
  ScratchFolder folder_;
  mcap::Texts entries_;
  fs::path scenario_;
  std::uint64_t seed_ = 0;
};

class ComponentReplay {
 public:
  ComponentReplay(const fs::path& recording, const std::vector<std::string>& components, const FindFactory& find,
                  const fs::path& output)
      : prepared_(recording, output), find_(find), wanted_(components), concludes_(!output.empty()) {
    plan_ = std::make_shared<const FaultPlan>(load_fault_plan(prepared_.faults(), prepared_.roster));
    for (const auto& name : components) add(name);
  }

  std::vector<ReplayResult> run(const fs::path& recording) {
    mcap::Reader reader(recording);
    reader.read({[this](const auto& channel, const auto& message) { take(channel, message); }, nullptr, nullptr});
    std::vector<ReplayResult> results;
    for (const auto& name : wanted_) {
      if (concludes_) members_.at(name)->conclude();
      results.push_back(members_.at(name)->result());
    }
    return results;
  }

 private:
  void add(const std::string& name) {
    if (members_.contains(name)) return;
    if (std::find(prepared_.roster.begin(), prepared_.roster.end(), name) == prepared_.roster.end()) {
      throw prepared_.wrong(fmt::format("found no component '{}', accepted {}{}", name,
                                        fmt::join(prepared_.roster, ", "), did_you_mean(name, prepared_.roster)));
    }
    auto factory = find_(name);
    if (!factory) throw prepared_.wrong(fmt::format("this program does not contain the component '{}'", name));
    members_[name] = std::make_unique<ReplayedMember>(
        with_faults(std::move(*factory), plan_), prepared_.setup_of(name), prepared_.pixels, prepared_.requests,
        [this](const TopicInfo& topic, const Sample& sample) { pass_on(topic, sample); });
    if (prepared_.pixels) return;
    // Who reads images needs their pixels: their writers make them again.
    for (const auto& topic : topics::kInfos) {
      const std::string writer(topic.writer);
      if (is_image(topic) && members_[name]->member().reads().contains(topic.id) &&
          std::find(prepared_.roster.begin(), prepared_.roster.end(), writer) != prepared_.roster.end())
        add(writer);
    }
  }
  static bool is_image(const TopicInfo& topic) { return topic.type == Description<msg::CameraImage>::kName; }

  /// Images that were made again go to their readers.
  void pass_on(const TopicInfo& topic, const Sample& sample) {
    if (prepared_.pixels || !is_image(topic)) return;
    for (auto& [name, member] : members_) {
      if (member->member().reads().contains(topic.id)) member->take_input(topic.id, sample);
    }
  }

  void take(const mcap::Channel& channel, const mcap::Message& message) {
    const auto info = std::find_if(topics::kInfos.begin(), topics::kInfos.end(),
                                   [&](const TopicInfo& one) { return one.name == channel.topic; });
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
      if (const auto step = dds::from_wire(*done)) member->second->take(*step);
    } else if (channel.topic == wire::kEpochStart.name) {
      const auto start = message_of<msg::EpochStart>(message.data);
      for (auto& [name, member] : members_) {
        if (start) member->take(*start);
      }
    }
  }

  void take_member(const TopicInfo& topic, mcap::Bytes cdr) {
    const auto writer = members_.find(std::string(topic.writer));
    const bool made_again = !prepared_.pixels && is_image(topic);
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

  Prepared prepared_;
  const FindFactory& find_;
  std::vector<std::string> wanted_;
  bool concludes_;
  std::shared_ptr<const FaultPlan> plan_;
  std::map<std::string, std::unique_ptr<ReplayedMember>> members_;
};

}  // namespace

std::vector<ReplayResult> replay_components(const fs::path& recording, const std::vector<std::string>& components,
                                            const FindFactory& find, const fs::path& output) {
  return ComponentReplay(recording, components, find, output).run(recording);
}

int replay_main(const std::vector<std::string>& arguments, const FindFactory& find) {
  const bool keeps = arguments.size() > 3 && arguments[1] == "--output";
  const std::vector<std::string> components(arguments.begin() + (keeps ? 3 : 1), arguments.end());
  try {
    fs::path output;
    if (keeps) fs::create_directories(output = fs::absolute(arguments[2]));
    bool equal = true;
    for (const auto& result : replay_components(arguments[0], components, find, output)) {
      fmt::print("{}: {} steps, {} messages", result.component, result.steps, result.messages);
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
