#include "client/run_registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "constrictor/json.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/run_token.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;

fs::path note_file(std::uint32_t domain) { return run_directory() / fmt::format("run-{}.json", domain); }

std::optional<RunNote> read_note(std::uint32_t domain) {
  std::ifstream file(note_file(domain));
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  RunNote note;
  note.domain = domain;
  note.pid = json.value("pid", 0);
  note.scenario = json.value("scenario", "");
  note.seed = json.value("seed", std::uint64_t{0});
  note.roster = json.value("roster", std::vector<std::string>{});
  note.plant = json.value("plant", "physics");
  note.report_dir = json.value("report_dir", "");
  note.run_id = json.value("run_id", std::uint64_t{0});
  note.token = json.value("token", "");
  return note;
}

}  // namespace

PublishedNote::PublishedNote(const RunNote& note) : note_(note), file_(note_file(note.domain)) {
  if (!note.token.empty()) {
    token_file_ = run_directory() / fmt::format("run-{}.token", note.domain);
    write_token_file(token_file_, note.token);
  }
  write();
}

void PublishedNote::set_seed(std::uint64_t seed, const std::function<void(const std::string&)>& warn) {
  if (seed == note_.seed) return;
  note_.seed = seed;
  try {
    write();
  } catch (const std::exception& error) {
    warn(fmt::format("the note of this run keeps the seed from before the reset, because it cannot be rewritten: {}",
                     error.what()));
  }
}

void PublishedNote::write() const {
  const nlohmann::json json = {
      {"pid", note_.pid},       {"domain", note_.domain}, {"scenario", note_.scenario},
      {"seed", note_.seed},     {"roster", note_.roster}, {"plant", note_.plant},
      {"run_id", note_.run_id}, {"token", note_.token},   {"report_dir", note_.report_dir.string()}};
  const fs::path unfinished = file_.string() + ".new";
  {
    std::ofstream stream(unfinished);
    // Before the token is in it: only this user may read the note.
    fs::permissions(unfinished, fs::perms::owner_read | fs::perms::owner_write);
    if (!(stream << json_text(json, 1) << "\n").flush())
      throw std::runtime_error(fmt::format("{}: cannot be written: is the disk full?", unfinished.string()));
  }
  fs::rename(unfinished, file_);
}

PublishedNote::~PublishedNote() {
  std::error_code ignored;
  fs::remove(file_, ignored);
  if (!token_file_.empty()) fs::remove(token_file_, ignored);
}

std::vector<RunNote> live_runs() {
  std::vector<RunNote> runs;
  for (const auto& entry : fs::directory_iterator(run_directory())) {
    std::uint32_t domain = 0;
    if (std::sscanf(entry.path().filename().c_str(), "run-%u.json", &domain) != 1 || entry.path() != note_file(domain))
      continue;
    // If no process holds the claim, the launcher was killed and could not remove its note.
    if (!domain_claimed(domain)) continue;
    if (auto note = read_note(domain)) runs.push_back(std::move(*note));
  }
  std::sort(runs.begin(), runs.end(), [](const RunNote& a, const RunNote& b) { return a.domain < b.domain; });
  return runs;
}

std::optional<RunNote> live_run(std::uint32_t domain) {
  return domain_claimed(domain) ? read_note(domain) : std::nullopt;
}

RunNote find_run(std::optional<std::uint32_t> domain) {
  const auto runs = live_runs();
  std::string list;
  for (const auto& run : runs) {
    if (run.domain == domain) return run;
    list += fmt::format("\n  --run {}   {} seed {}, pid {}, {}", run.domain, run.scenario, run.seed, run.pid,
                        run.report_dir.string());
  }
  const auto fail = [](const std::string& message) { throw CommandError(message, CommandError::Cause::kNoRun); };
  if (domain) fail(fmt::format("no run in DDS domain {}{}{}", *domain, runs.empty() ? "" : "; choose one of:", list));
  if (runs.empty()) fail("no run on this host; start one with `constrictor run`");
  if (runs.size() > 1) fail("several runs on this host; choose one:" + list);
  return runs.front();
}

RunKey run_key(std::uint32_t domain) {
  if (const auto note = live_run(domain)) return {note->run_id, note->token};
  const char* file = std::getenv("CONSTRICTOR_TOKEN_FILE");
  return {0, file && *file ? read_token_file(file) : std::string()};
}

std::uint32_t find_domain(std::optional<std::uint32_t> domain) { return domain ? *domain : find_run({}).domain; }

}  // namespace constrictor
