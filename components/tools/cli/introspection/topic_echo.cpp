// `constrictor topic echo`: prints the samples of a topic.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/introspection/readable_sample.hpp"
#include "cli/introspection/sample_filter.hpp"
#include "cli/introspection/topic_watch.hpp"
#include "cli/usage.hpp"
#include "constrictor/field_table.hpp"
#include "constrictor/hex.hpp"
#include "constrictor/json.hpp"
#include "cyclone/type_tree.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kMostShown = 256;  // bytes of a sample in text

void print_raw(const dds::RawSample& sample, const char* why) {
  fmt::print("{} bytes of CDR ({}):\n", sample.bytes.size(), why);
  for (std::size_t i = 0; i < std::min(kMostShown, sample.bytes.size()); i += 16) {
    fmt::print("  {:04x} ", i);
    for (std::size_t j = i; j < std::min(i + 16, sample.bytes.size()); ++j) fmt::print(" {:02x}", sample.bytes[j]);
    fmt::print("\n");
  }
  if (sample.bytes.size() > kMostShown) fmt::print("  ... and {} more\n", sample.bytes.size() - kMostShown);
}

class Echo {
 public:
  Echo(const ViewOptions& view, const WatchOptions& options) : json_(view.json), options_(options) {
    if (options.filter.empty()) return;
    try {
      filter_.emplace(options.filter);
    } catch (const FilterError& error) {
      throw UsageError(fmt::format("--filter: {}", error.what()));
    }
  }
  void begin(const DomainView& view, const dds::Endpoint& writer) {
    type_ = writer.type;
    if (options_.raw) return;
    tree_ = dds::TypeTree::find(view.participant(), writer, std::chrono::seconds(2));
    if (!tree_) tree_ = dds::TypeTree::known(view.participant(), writer.type);
    if (filter_ && !tree_)
      wrong_ = fmt::format("--filter of '{}': its writer does not describe the type", options_.topics.front());
  }
  /// Returns whether to go on.
  bool print(const dds::RawSample& sample) {
    if (!wrong_.empty()) return false;
    const char* why = options_.raw ? "--raw" : "its writer does not describe the type";
    Json json;
    if (tree_) {
      try {
        json = tree_->decode(sample.bytes);
      } catch (const std::exception&) {
        why = "it does not fit the type that its writer describes";
      }
    }
    if (json.is_null()) {
      if (filter_) return true;  // without fields, the expression cannot be evaluated
      if (json_) fmt::print("{}\n", json_text(Json{{"size", sample.bytes.size()}, {"cdr", hex(sample.bytes)}}));
      else print_raw(sample, why);
    } else if (!print(std::move(json))) {
      return wrong_.empty();
    }
    std::fflush(stdout);
    return options_.count == 0 || ++printed_ < options_.count;
  }
  [[nodiscard]] const std::string& wrong() const { return wrong_; }

 private:
  /// Returns whether the sample was printed.
  bool print(Json json) {
    if (!options_.shown.full) summarise_bytes(json, tree_->root());
    if (filter_) {
      Json used = json;
      make_readable(used, type_, Arrays::kUsed);
      try {
        if (!filter_->accepts(used)) return false;
      } catch (const FilterError& error) {
        wrong_ = fmt::format("--filter of '{}': {}", options_.topics.front(), error.what());
        return false;
      }
    }
    make_readable(json, type_, json_ ? Arrays::kWhole : Arrays::kUsed);
    if (!options_.field.empty()) {
      std::string problem;
      auto found = part_of(json, options_.field, problem);
      if (!found) {
        wrong_ = fmt::format("--field of '{}': {}", options_.topics.front(), problem);
        return false;
      }
      json = std::move(*found);
    }
    apply(json, options_.shown);
    if (!json_ && fields_of(type_)) name_goals(json);
    if (json_) fmt::print("{}\n", json_text(json));
    else if (json.is_object()) fmt::print("{}---\n", as_text(json));
    else fmt::print("{}\n", json.is_string() ? json.get<std::string>() : json_text(json));
    return true;
  }

  bool json_;
  const WatchOptions& options_;
  std::optional<SampleFilter> filter_;
  std::unique_ptr<dds::TypeTree> tree_;
  std::string type_;
  std::string wrong_;  ///< why the command ends
  std::uint64_t printed_ = 0;
};

}  // namespace

int echo_command(const ViewOptions& view, const WatchOptions& options) {
  Echo echo(view, options);
  Watcher watcher;
  watcher.history = true;
  watcher.begin = [&](const DomainView& domain, std::size_t, const dds::Endpoint& writer) {
    echo.begin(domain, writer);
  };
  watcher.use = [&](std::size_t, const dds::RawSample& sample, double) { return echo.print(sample); };
  const int status = watch_topics(view, options, watcher);
  if (echo.wrong().empty()) return status;
  std::fprintf(stderr, "topic: %s\n", echo.wrong().c_str());
  return exit_status::kUsage;
}

}  // namespace constrictor::cli
