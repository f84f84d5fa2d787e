#include "log/log.hpp"

#include <fmt/chrono.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>
#include <mutex>
#include <regex>
#include <string_view>

#include "constrictor/constants.hpp"
#include "constrictor/text.hpp"

namespace constrictor {
namespace {

std::shared_ptr<spdlog::logger> plain(spdlog::sink_ptr sink) {
  auto logger = std::make_shared<spdlog::logger>("", std::move(sink));
  logger->set_pattern("%v");  // log_text() has written time and level already
  return logger;
}

}  // namespace

std::string log_text(const LogRecord& record) {
  using std::chrono::milliseconds;
  const auto since = std::chrono::duration_cast<milliseconds>(record.time.time_since_epoch());
  std::string place;
  if (record.epoch > 1) place += fmt::format(" epoch {}", record.epoch);
  if (record.tick >= 0) place += fmt::format(" tick {}", record.tick);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z {} {}{}: {}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(record.time)), since.count() % 1000,
                     name_of(constants::kLog, record.level), record.subject, place, record.text);
}

std::optional<LogRecord> read_log_text(const std::string& text) {
  static const std::regex begin(R"((\d{4})-(\d\d)-(\d\d)T(\d\d):(\d\d):(\d\d)\.(\d{3})Z (\w+) (\S+))"
                                R"((?: epoch (\d{1,9}))?(?: tick (\d{1,18}))?: )");
  constexpr std::size_t kLongestBegin = 1500;  // the names of all members; what follows may have any length
  const std::string head = text.substr(0, kLongestBegin);
  std::smatch part;
  if (!std::regex_search(head, part, begin, std::regex_constants::match_continuous)) return std::nullopt;
  const auto number = [&](std::size_t i) { return std::stoi(part[i].str()); };
  std::tm utc{};
  utc.tm_year = number(1) - 1900;
  utc.tm_mon = number(2) - 1;
  utc.tm_mday = number(3);
  utc.tm_hour = number(4);
  utc.tm_min = number(5);
  utc.tm_sec = number(6);
  const auto level = value_of(constants::kLog, part[8].str());
  if (!level) return std::nullopt;
  LogRecord record;
  record.time = std::chrono::system_clock::from_time_t(::timegm(&utc)) + std::chrono::milliseconds(number(7));
  record.level = *level;
  record.subject = part[9].str();
  if (part[11].matched) {
    record.tick = std::stoll(part[11].str());
    record.epoch = 1;
  }
  if (part[10].matched) record.epoch = static_cast<std::uint32_t>(std::stoul(part[10].str()));
  record.text = text.substr(static_cast<std::size_t>(part.length()));
  return record;
}

struct Log::Shared {
  std::shared_ptr<spdlog::logger> logger;
  std::mutex mutex;  ///< guards everything below, so that numbers rise in the order of the file
  std::uint64_t lines = 0;
  std::uint64_t run_id = 0;
  std::uint32_t epoch = 0;
  std::int64_t tick = -1;
  Sink sink;
};

Log::Log(const std::string& name) : shared_(std::make_shared<Shared>()), subject_(name) {
  shared_->logger = plain(std::make_shared<spdlog::sinks::stderr_sink_mt>());
}

Log::Log(const std::string& name, const std::filesystem::path& file)
    : shared_(std::make_shared<Shared>()), subject_(name) {
  shared_->logger = plain(std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string()));
  shared_->logger->flush_on(spdlog::level::info);
}

Log Log::about(const std::string& component) const {
  Log log = *this;
  log.subject_ = component;
  return log;
}

void Log::at(std::uint64_t run_id, std::uint32_t epoch, std::int64_t tick) const {
  if (!shared_) return;
  const std::lock_guard lock(shared_->mutex);
  shared_->run_id = run_id;
  shared_->epoch = epoch;
  shared_->tick = tick;
}

void Log::forward(Sink sink) const {
  if (!shared_) return;
  const std::lock_guard lock(shared_->mutex);
  shared_->sink = std::move(sink);
}

void Log::write(Level level, const std::string& text) const {
  if (!shared_) return;
  // Lines contain texts of messages from the network.
  std::string_view rest = text;
  const std::lock_guard lock(shared_->mutex);
  // The time is spdlog's: this library contains no clock that the logic of a component could call.
  const spdlog::details::log_msg now(subject_, spdlog::level::info, text);
  LogRecord record{
      now.time, static_cast<std::uint8_t>(level), subject_, shared_->run_id, shared_->epoch, shared_->tick, 0, {}};
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string line(rest.substr(0, end));
    std::replace(line.begin(), line.end(), '\t', ' ');
    record.text = printable(std::move(line));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    record.number = ++shared_->lines;
    // A full disk must not end a process: spdlog reports it on stderr, at most once a second, and goes on.
    shared_->logger->info("{}", log_text(record));
    if (shared_->sink) shared_->sink(record);
  }
}

}  // namespace constrictor
