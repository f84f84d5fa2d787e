// YAML configuration whose errors name file, line, key, what was found and what is accepted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace YAML {
class Node;
}

namespace constrictor {

/// A mistake in a configuration. what() reads "robots/x.yaml:12: module.mass_kg: found -1, accepted 0.01 to 10".
/// Programs catch it once, in main, and exit with status 78.
class ConfigurationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Accepted numbers, both ends included.
struct Range {
  double min;
  double max;
};

/// One map of a YAML file. Each accessor states what it accepts and marks its key as known. An accessor without a
/// fallback requires its key. Every accessor throws ConfigurationError.
class Configuration {
 public:
  /// Parses a file whose root is a map. Throws ConfigurationError, also if the file is missing or is not valid YAML.
  static Configuration load(const std::filesystem::path& file);
  /// Parses a text; `name` stands for the file in error messages.
  static Configuration parse(const std::string& text, const std::string& name);

  /// Whether the key exists and has a value.
  [[nodiscard]] bool has(std::string_view key);
  /// A finite number within `accepted`.
  double number(std::string_view key, Range accepted, std::optional<double> fallback = std::nullopt);
  std::int64_t integer(std::string_view key, std::int64_t min, std::int64_t max,
                       std::optional<std::int64_t> fallback = std::nullopt);
  bool flag(std::string_view key, std::optional<bool> fallback = std::nullopt);
  /// A text. If `choices` is not empty, only these are accepted.
  std::string text(std::string_view key, const std::vector<std::string>& choices = {},
                   std::optional<std::string> fallback = std::nullopt);
  /// A list of `min_count` to `max_count` numbers.
  std::vector<double> numbers(std::string_view key, Range accepted, std::size_t min_count, std::size_t max_count,
                              const std::optional<std::vector<double>>& fallback = std::nullopt);
  /// A list of texts. If `choices` is not empty, only these are accepted.
  std::vector<std::string> texts(std::string_view key, const std::vector<std::string>& choices = {},
                                 const std::optional<std::vector<std::string>>& fallback = std::nullopt);
  /// A nested map. If it is missing and not required: an empty map, whose accessors use their fallbacks.
  Configuration section(std::string_view key, bool required = true);
  /// A list of maps. If it is missing and not required: an empty list.
  std::vector<Configuration> list(std::string_view key, bool required = true);
  /// A value of any kind as YAML on one line, to be given to another program; empty if the key is missing.
  [[nodiscard]] std::string one_line(std::string_view key);
  /// Rejects the keys of this map that no accessor has read, so that a misspelt optional key is an error. Call it when
  /// everything has been read.
  void finish() const;
  /// An error about a key of this map, for checks that span several keys. `key` may name a nested key
  /// ("module.mass_kg").
  [[nodiscard]] ConfigurationError error(std::string_view key, const std::string& found_and_accepted) const;

  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  Configuration(std::shared_ptr<YAML::Node> node, std::string file, std::string path);
  /// The error about the value of a key, or that it is missing.
  [[nodiscard]] ConfigurationError refusal(std::string_view key, const YAML::Node& node,
                                           const std::string& accepted) const;
  /// For the end of the error that `key` is missing: the key that stands there, perhaps in its place. Which keys are
  /// unknown is not yet known then, so that only similar ones are named.
  [[nodiscard]] std::string misspelt(std::string_view key) const;

  std::shared_ptr<YAML::Node> node_;
  std::string file_;
  std::string path_;  ///< keys from the root to this map, joined by dots
  std::set<std::string, std::less<>> known_;
};

}  // namespace constrictor
