// The data on a recorded run that a replay needs before it begins: its files, its roster, the requests of its clients.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "component/component.hpp"
#include "configuration/configuration.hpp"
#include "configuration/temporary_folder.hpp"
#include "recording/mcap_format.hpp"
#include "runtime/replayed_member.hpp"

namespace constrictor {

class RecordedRun {
 public:
  /// Reads the whole file once. `output`: where components write; empty: into a folder that is removed. Throws
  /// mcap::Error, or ConfigurationError if it is not the recording of a run of this release.
  RecordedRun(const std::filesystem::path& recording, const std::filesystem::path& output);

  /// A text that the recorder has noted; empty if there is none.
  [[nodiscard]] std::string entry(const std::string& name) const;
  [[nodiscard]] ConfigurationError wrong(const std::string& why) const;
  /// The set-up that a component had in the run.
  [[nodiscard]] Setup setup_of(const std::string& component) const;
  /// The faults that the run suffered; empty: none.
  [[nodiscard]] std::filesystem::path faults() const;

  std::vector<std::string> roster;
  bool pixels = false;  ///< whether images were recorded whole
  RecordedRequests requests;

 private:
  void take(const mcap::Channel& channel, const mcap::Message& message);
  void store(const std::map<std::string, std::string>& attachments);

  std::filesystem::path file_;
  std::filesystem::path output_;
  TemporaryFolder folder_{"replay"};  ///< for the attached files and for what components write
  mcap::Texts entries_;
  std::filesystem::path scenario_;
  std::uint64_t seed_ = 0;
};

}  // namespace constrictor
