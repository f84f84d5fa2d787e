// How programs find the runs on this host: each launcher writes a small file, the note, next to the file with which it
// claims a DDS domain.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
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
  std::uint64_t run_id = 0;  ///< random number of the run; 0: not known
  std::string token;         ///< of the run; empty: it has none, or it is not known here
  bool on_this_host = true;  ///< false: no launcher on this host has noted the run
};

/// The data that a client needs to command a run.
struct RunKey {
  std::uint64_t run_id = 0;  ///< 0: the run is found by the token
  std::string token;
};

/// A note that other programs of this user can read until this object is destroyed, and beside it a file with the run's
/// token for the processes of the run. The owner of this object must hold the claim of the domain.
class PublishedNote {
 public:
  explicit PublishedNote(const RunNote& note);
  ~PublishedNote();
  PublishedNote(const PublishedNote&) = delete;
  PublishedNote& operator=(const PublishedNote&) = delete;
  [[nodiscard]] const std::string& token() const { return note_.token; }
  /// The data for commands to the run. They stay valid when the files are gone, as those below /run/user are after a
  /// logout.
  [[nodiscard]] RunKey key() const { return {note_.run_id, note_.token}; }
  /// The file with the run's token; empty if the run has none.
  [[nodiscard]] const std::filesystem::path& token_file() const { return token_file_; }
  /// Rewrites the note after a reset, which changes the seed. If the note cannot be written, it keeps the old seed,
  /// `warn` is called with the reason, and the run goes on.
  void set_seed(std::uint64_t seed, const std::function<void(const std::string&)>& warn);

 private:
  void write() const;
  RunNote note_;
  std::filesystem::path file_;
  std::filesystem::path token_file_;
};

/// The runs on this host whose launcher is alive, in the order of their domains.
std::vector<RunNote> live_runs();

/// The one of them in this domain; empty if there is none.
std::optional<RunNote> live_run(std::uint32_t domain);

/// The run to join: find_run(), or, if `domain` is given and no launcher on this host has noted a run there, the run
/// that publishes its state in that domain: it was started by hand, or on another host. Waits up to `bound` for it.
/// Throws CommandError (kNoRun) if there is none.
RunNote join_run(std::optional<std::uint32_t> domain, std::chrono::milliseconds bound = std::chrono::seconds(3));

/// The run in `domain`, or the only run on this host if `domain` is empty. Throws CommandError (kNoRun) if there is no
/// such run, or if there are several and `domain` is empty; the message lists them.
RunNote find_run(std::optional<std::uint32_t> domain);

/// The key of the run in `domain`: from its note if the run was started on this host, else the token in the file that
/// $CONSTRICTOR_TOKEN_FILE names, else an empty key. Throws std::runtime_error if that file cannot be used.
RunKey run_key(std::uint32_t domain);

/// The DDS domain of the run to join: `domain` if it is given, also if no run on this host uses it (the run may be on
/// another host); otherwise that of the only run on this host. Throws CommandError as find_run() does.
std::uint32_t find_domain(std::optional<std::uint32_t> domain);

}  // namespace constrictor
