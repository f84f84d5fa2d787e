#include "runtime/recorded_run.hpp"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/message_cdr.hpp"
#include "runtime/version.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;
namespace wire = barrier_topics;

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

}  // namespace

RecordedRun::RecordedRun(const fs::path& recording, const fs::path& output) : file_(recording), output_(output) {
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
    throw wrong(fmt::format("found a recording of release '{}', accepted '{}': another release computes other results",
                            reader.contents().library, release));
  roster = split(entry("roster"));
  pixels = entry("images") == "on";
  store(attachments);
}

std::string RecordedRun::entry(const std::string& name) const {
  const auto found = entries_.find(name);
  return found == entries_.end() ? "" : found->second;
}

ConfigurationError RecordedRun::wrong(const std::string& why) const {
  return ConfigurationError(file_.string() + ": " + why);
}

Setup RecordedRun::setup_of(const std::string& component) const {
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

fs::path RecordedRun::faults() const {
  const fs::path file = folder_.path() / "faults.yaml";
  return fs::exists(file) ? file : fs::path();
}

void RecordedRun::take(const mcap::Channel& channel, const mcap::Message& message) {
  if (channel.topic == wire::kRequest.name) {
    if (const auto request = message_of<msg::Request>(message.data))
      requests[{text_of(request->source), request->header.sequence_number}] = *request;
  } else if (channel.topic == wire::kEpochStart.name && seed_ == 0) {
    if (const auto start = message_of<msg::EpochStart>(message.data)) seed_ = start->seed;
  }
}

// The attachments that components read go into the folder. Their names come from the file, so only known ones are used.
void RecordedRun::store(const std::map<std::string, std::string>& attachments) {
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
  if (!write("robot.yaml", folder_.path() / "robot.yaml")) throw wrong("found no attachment robot.yaml, accepted one");
  write("faults.yaml", folder_.path() / "faults.yaml");
  for (const auto& component : roster) {
    if (component.find('/') != std::string::npos) throw wrong(fmt::format("found component '{}'", component));
    const std::string file = "configuration/" + component + ".yaml";
    write(file, folder_.path() / file);
  }
}

}  // namespace constrictor
