// Which runs there are on this host: each leaves a note beside its claim of a DDS domain, so that other commands find it.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace constrictor::cli {

/// No run, or several. The message tells the user what to do.
class RegistryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a run tells other commands about itself.
struct RunNote {
  std::uint32_t domain = 0;
  pid_t pid = 0;                     ///< of the launcher
  std::string scenario;
  std::uint64_t seed = 0;            ///< in force
  std::vector<std::string> roster;
  std::string plant;                 ///< which of them is the plant
  std::filesystem::path report_dir;
};

/// A note that others see until destruction. Whoever publishes one holds the claim of its domain.
class PublishedNote {
 public:
  explicit PublishedNote(const RunNote& note);
  ~PublishedNote();
  PublishedNote(const PublishedNote&) = delete;
  PublishedNote& operator=(const PublishedNote&) = delete;
  /// Tells the seed in force, which a reset changes.
  void set_seed(std::uint64_t seed);

 private:
  void write() const;
  RunNote note_;
  std::filesystem::path file_;
};

/// Runs whose launcher lives, by domain.
std::vector<RunNote> live_runs();

/// The run in `domain`, or the only one there is. Throws RegistryError, naming the runs if there are several.
RunNote find_run(std::optional<std::uint32_t> domain);

}  // namespace constrictor::cli
