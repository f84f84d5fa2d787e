// The parameters of a component: one row each, from which everything else follows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "configuration/configuration.hpp"

namespace constrictor {

/// When a parameter may take another value: only at the start of a run, or also during the run.
enum class Changes { kAtStart, kWhileRunning };

/// The description of one parameter for people and tools. Values are in YAML notation.
struct ParameterRow {
  std::string key;            ///< keys of the configuration file, joined by dots
  std::string unit;           ///< as people write it ("rad/s"); empty for texts, lists of texts, and plain numbers
  std::string accepted;       ///< for example "0.01 to 10" or "one of green, red"
  std::string meaning;        ///< one line
  std::string default_value;  ///< of a parameter that the configuration file does not name
  std::string value;          ///< in force
  Changes changes = Changes::kAtStart;
  bool is_number = false;            ///< one number, within `bounds`
  bool is_integer = false;           ///< one whole number
  Range bounds{0.0, 0.0};            ///< of a number
  std::vector<std::string> names{};  ///< of a named number that may change during a run: its values 0, 1, 2, ...
};

/// How many elements a list may have.
struct ListSize {
  std::size_t min = 0;
  std::size_t max = 0;
};

/// The base of a component's configuration: a struct whose fields are its parameters. Each field is one row:
///
///     struct ControlConfig : ParameterSet {
///       double shape_rate_rad_s = add(shape_rate_rad_s, "posture.shape_rate_rad_s", 0.5, "rad/s", {0.01, 4.0},
///                                     kWhileRunning, "Speed of each joint towards a new posture");
///     };
///
/// The row is the only place of the default, the bounds, the unit and the meaning. From it follow: `load_parameters`
/// (a file need only name what differs from the defaults) with its error messages, the run-time parameters
/// (component/parameters.hpp), the component's shipped YAML file and the table in its README (both are written by the
/// build target `parameter_tables`; a test compares them).
///
/// `add` returns the default, which initialises the field. It never reads the field. Copies keep the rows. A row that
/// contradicts itself (a default outside of its bounds, a key that exists already) is a bug: std::logic_error.
class ParameterSet {
 public:
  using enum Changes;  // so that the rows of derived structs can write kAtStart instead of Changes::kAtStart

  /// A row as the set keeps it.
  struct Row {
    ParameterRow text;
    std::ptrdiff_t offset = 0;  ///< [byte] of the field from the set
    std::function<void(Configuration& section, const std::string& key, void* field)> read;
    std::function<std::string(const void* field)> print;
    // Null unless the parameter is a number, or a named number.
    double (*get)(const void* field) = nullptr;
    void (*set)(void* field, double value) = nullptr;
  };

  double add(double& field, const std::string& key, double fallback, const std::string& unit, Range accepted,
             Changes changes, const std::string& meaning);
  /// A whole number of any integer type.
  template <class Integer>
  requires(std::is_integral_v<Integer> && !std::is_same_v<Integer, bool>) Integer
      add(Integer& field, const std::string& key, std::type_identity_t<Integer> fallback, const std::string& unit,
          Range accepted, Changes changes, const std::string& meaning) {
    Row row;
    row.text = {key, unit, {}, meaning, {}, {}, changes, true, true, accepted};
    row.get = [](const void* at) { return static_cast<double>(*static_cast<const Integer*>(at)); };
    row.set = [](void* at, double value) { *static_cast<Integer*>(at) = static_cast<Integer>(value); };
    add_number(row, &field, static_cast<double>(fallback));
    return fallback;
  }
  bool add(bool& field, const std::string& key, bool fallback, const std::string& meaning);
  /// A text; one of `choices` if there are any.
  std::string add(std::string& field, const std::string& key, const std::string& fallback,
                  const std::vector<std::string>& choices, const std::string& meaning);
  /// A list of numbers.
  std::vector<double> add(std::vector<double>& field, const std::string& key, const std::vector<double>& fallback,
                          const std::string& unit, Range accepted, ListSize size, const std::string& meaning);
  /// A named number: the file holds one of `names`, the field its index. Unnamed (empty) indices are not accepted.
  std::uint8_t add(std::uint8_t& field, const std::string& key, std::uint8_t fallback,
                   const std::vector<std::string>& names, const std::string& meaning);
  /// The same for one that may change during a run. All indices have names without blanks.
  std::uint8_t add(std::uint8_t& field, const std::string& key, std::uint8_t fallback,
                   const std::vector<std::string>& names, Changes changes, const std::string& meaning);
  /// A list of named numbers.
  std::vector<std::uint8_t> add(std::vector<std::uint8_t>& field, const std::string& key,
                                const std::vector<std::uint8_t>& fallback, const std::vector<std::string>& names,
                                ListSize size, const std::string& meaning);
  /// A field that is itself a set of parameters. In the file, its keys are in the section `key`.
  template <class Section>
  requires std::is_base_of_v<ParameterSet, Section> Section add_section(Section& field, const std::string& key) {
    Section section;
    const auto* base = static_cast<const ParameterSet*>(&section);
    const auto base_offset = reinterpret_cast<const char*>(base) - reinterpret_cast<const char*>(&section);
    adopt(*base, key, offset_of(&field) + base_offset);
    return section;
  }

  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// The rows with the values that the fields hold now.
  [[nodiscard]] std::vector<ParameterRow> describe() const;
  /// The field of a row of this set.
  [[nodiscard]] const void* field(const Row& row) const { return reinterpret_cast<const char*>(this) + row.offset; }
  [[nodiscard]] void* field(const Row& row) { return reinterpret_cast<char*>(this) + row.offset; }

  /// Sets every field to what the file says, or to its default. Refuses unknown keys of sections; the root's own keys
  /// are left to `root.finish()`. Throws ConfigurationError.
  void read(Configuration& root);

 private:
  [[nodiscard]] std::ptrdiff_t offset_of(const void* field) const {
    return static_cast<const char*>(field) - reinterpret_cast<const char*>(this);
  }
  void add_number(Row row, void* field, double fallback);
  void add_row(Row row, const void* field);
  void adopt(const ParameterSet& section, const std::string& key, std::ptrdiff_t offset);

  std::vector<Row> rows_;
};

/// A component's configuration from its YAML file; an empty path means the defaults. If `Config` has a member
/// `complete(Configuration& root)`, it is called with the root of the file: it checks what spans several rows and reads
/// keys that cannot be rows, such as lists of maps. Throws ConfigurationError.
template <class Config>
[[nodiscard]] Config load_parameters(const std::filesystem::path& file) {
  Config config;
  Configuration root = file.empty() ? Configuration::parse("{}", "(defaults)") : Configuration::load(file);
  config.read(root);
  if constexpr (requires { config.complete(root); }) config.complete(root);
  root.finish();
  return config;
}

/// The rows of a configuration file of type `Config` with its values: for tools that show or check configurations
/// without building the component. Throws ConfigurationError.
template <class Config>
[[nodiscard]] std::vector<ParameterRow> describe_parameters(const std::filesystem::path& file) {
  return load_parameters<Config>(file).describe();
}

/// describe_parameters<Config> as a component's factory hands it out.
using DescribeParameters = std::vector<ParameterRow> (*)(const std::filesystem::path& file);

}  // namespace constrictor
