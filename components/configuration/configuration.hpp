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

/// A bad configuration. what() reads "robots/x.yaml:12: module.mass_kg: found -1, accepted 0.01 to 10". Exit status 78.
class ConfigurationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Range {
  double min;
  double max;
};

/// One map of a YAML file. Each accessor marks its key as known; `finish()` refuses the keys that nobody asked for.
class Configuration {
 public:
  /// Parses a file whose root is a map. Throws ConfigurationError (also for a missing file and for YAML syntax).
  static Configuration load(const std::filesystem::path& file);
  /// The same from text; `name` stands for the file in messages.
  static Configuration parse(const std::string& text, const std::string& name);

  [[nodiscard]] bool has(std::string_view key);
  /// Finite number within `accepted`. Without a fallback the key is required.
  double number(std::string_view key, Range accepted, std::optional<double> fallback = std::nullopt);
  std::int64_t integer(std::string_view key, std::int64_t min, std::int64_t max,
                       std::optional<std::int64_t> fallback = std::nullopt);
  bool flag(std::string_view key, std::optional<bool> fallback = std::nullopt);
  /// Text; if `choices` is not empty it must be one of them.
  std::string text(std::string_view key, const std::vector<std::string>& choices = {},
                   std::optional<std::string> fallback = std::nullopt);
  /// List of numbers whose length lies in [min_count, max_count].
  std::vector<double> numbers(std::string_view key, Range accepted, std::size_t min_count, std::size_t max_count);
  std::vector<std::string> texts(std::string_view key, const std::vector<std::string>& choices = {});
  /// A nested map; if it is missing and not required, an empty one whose accessors use their fallbacks.
  Configuration section(std::string_view key, bool required = true);
  /// A list of maps (an absent key is an empty list unless required).
  std::vector<Configuration> list(std::string_view key, bool required = true);
  /// Refuses unknown keys of this map. Call it when everything was read.
  void finish() const;
  /// An error about a key of this map, for checks that span keys.
  [[nodiscard]] ConfigurationError error(std::string_view key, const std::string& found_and_accepted) const;

  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  Configuration(std::shared_ptr<YAML::Node> node, std::string file, std::string path);
  std::shared_ptr<YAML::Node> node_;
  std::string file_;
  std::string path_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace constrictor
