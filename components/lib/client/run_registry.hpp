// How programs find the runs on this host: each launcher writes a small file, the note, next to the file with which it
// claims a DDS domain.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "client/command_error.hpp"

namespace constrictor {

/// The content of a run's note.
struct RunNote {
  std::uint32_t domain = 0;  ///< DDS domain
  pid_t pid = 0;             ///< process id of the launcher
  std::string scenario;
  std::uint64_t seed = 0;  ///< seed of the present epoch
  std::vector<std::string> roster;
  std::string plant;  ///< the member of the roster that is the plant
  std::filesystem::path report_dir;
};

/// A note that other programs can read until this object is destroyed. The owner of this object must hold the claim of
/// the domain.
class PublishedNote {
 public:
  explicit PublishedNote(const RunNote& note);
  ~PublishedNote();
  PublishedNote(const PublishedNote&) = delete;
  PublishedNote& operator=(const PublishedNote&) = delete;
  /// Rewrites the note after a reset, which changes the seed.
  void set_seed(std::uint64_t seed);

 private:
  void write() const;
  RunNote note_;
  std::filesystem::path file_;
};

/// The runs on this host whose launcher is alive, in the order of their domains.
std::vector<RunNote> live_runs();

/// The run in `domain`, or the only run on this host if `domain` is empty. Throws CommandError (kNoRun) if there is no
/// such run, or if there are several and `domain` is empty; the message lists them.
RunNote find_run(std::optional<std::uint32_t> domain);

/// The DDS domain of the run to join: `domain` if it is given, also if no run on this host uses it (the run may be on
/// another host); otherwise that of the only run on this host. Throws CommandError as find_run() does.
std::uint32_t find_domain(std::optional<std::uint32_t> domain);

}  // namespace constrictor
