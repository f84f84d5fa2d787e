// The choice of what `run --record` records.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace constrictor {

enum class RecordedImages {
  kOn,         ///< whole
  kOff,        ///< not at all
  kRecompute,  ///< without their pixels, which `constrictor replay --restore` computes again
};

struct RecordingOptions {
  bool record = false;
  RecordedImages images = RecordedImages::kOn;
  std::map<std::string, std::filesystem::path> attachments;  ///< files that belong to the run, by their name in it
};

inline constexpr const char* kRecordingFile = "run.mcap";            ///< in the folder of the run
inline constexpr const char* kOpenChunkFile = "run.mcap.unwritten";  ///< beside it, while the run goes on

}  // namespace constrictor
