#include "cli/param_file.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "component/data_path.hpp"
#include "component/parameters.hpp"
#include "configuration/configuration.hpp"
#include "configuration/yaml_document.hpp"

namespace constrictor::cli {
namespace {

/// A value of the file with its place.
struct Found {
  int line = 0;
  std::string text;
  bool scalar = false;
};

int line_of(const YAML::Node& node) { return std::max(node.Mark().line, 0) + 1; }

/// Reads one file and collects its mistakes.
class Reader {
 public:
  Reader(std::string file, const ParameterView& view, const std::function<bool(const std::string&)>& is_fixed)
      : file_(std::move(file)), view_(view), is_fixed_(is_fixed) {}

  void collect(const YAML::Node& map, const std::string& path) {
    for (const auto& entry : map) {
      const std::string key = path.empty() ? entry.first.Scalar() : path + "." + entry.first.Scalar();
      const int line = line_of(entry.first);
      if (entry.second.IsMap()) {
        collect(entry.second, key);
      } else if (const auto before = lines_.find(key); before != lines_.end()) {
        mistake(line, key, fmt::format("found twice, first in line {}, accepted once", before->second));
      } else {
        lines_[key] = line;
        check(key,
              {line, entry.second.IsScalar() ? entry.second.Scalar() : "a list or nothing", entry.second.IsScalar()});
      }
    }
  }
  void mistake(int line, const std::string& key, const std::string& what) {
    mistakes_ +=
        fmt::format("{}{}:{}: {}{}", mistakes_.empty() ? "" : "\n", file_, line, key.empty() ? "" : key + ": ", what);
  }
  [[nodiscard]] const std::string& mistakes() const { return mistakes_; }
  [[nodiscard]] std::vector<ParameterValue> take_values() { return std::move(values_); }

 private:
  void check(const std::string& name, const Found& found) {
    const auto known = view_.parameters.find(name);
    if (known == view_.parameters.end()) return mistake(found.line, name, why_not(name));
    const msg::Parameter& p = known->second.parameter;
    const std::optional<double> value = found.scalar ? value_from(p, found.text) : std::nullopt;
    if (!value || !parameter_refusal(p, *value).empty())
      return mistake(found.line, name, fmt::format("found {}, accepted {}", found.text, accepted_text(p)));
    if (*value != coming_value(p)) values_.push_back({name, *value, found.text});
  }
  [[nodiscard]] std::string why_not(const std::string& name) const {
    if (is_fixed_(name)) return why_fixed(name);
    return "found no such parameter, accepted those of `constrictor param list`" + did_you_mean(name, view_.parameters);
  }

  std::string file_;
  const ParameterView& view_;
  const std::function<bool(const std::string&)>& is_fixed_;
  std::map<std::string, int> lines_;
  std::string mistakes_;
  std::vector<ParameterValue> values_;
};

/// The name of the value, or the number in as few digits as give the same number again.
std::string exact(const msg::Parameter& parameter, double value) {
  return *parameter.choices ? value_text(parameter, value) : fmt::format("{}", value);
}

}  // namespace

std::string parameter_file(const ParameterView& view, const std::string& title, bool changed) {
  std::string text =
      fmt::format("# {}\n# To set these values in a run that goes on: constrictor param load FILE\n", title);
  for (const auto& [name, owned] : view.parameters) {
    const msg::Parameter& p = owned.parameter;
    if (changed && p.changed_tick < 0 && p.pending_tick < 0) continue;
    text += fmt::format("{}: {}  # {}; {}\n", name, exact(p, coming_value(p)), accepted_text(p), p.doc);
  }
  return text;
}

std::vector<ParameterValue> read_parameter_file(const std::string& text, const std::string& file,
                                                const ParameterView& view,
                                                const std::function<bool(const std::string&)>& is_fixed) {
  YAML::Node root;
  try {
    root = parse_yaml(text);
  } catch (const YAML::ParserException& error) {
    throw ConfigurationError(fmt::format("{}:{}: {}", file, error.mark.line + 1, error.msg));
  }
  Reader reader(file, view, is_fixed);
  if (root.IsMap()) reader.collect(root, "");
  else if (!root.IsNull()) reader.mistake(1, "", "found no map, accepted lines as NAME: VALUE");
  if (!reader.mistakes().empty()) throw ConfigurationError(reader.mistakes());
  return reader.take_values();
}

std::string why_fixed(const std::string& name) {
  return fmt::format(
      "cannot change while the run goes on; accepted in a configuration file, for the next run: "
      "`constrictor run --config {}=FILE`",
      name.substr(0, name.find('.')));
}

bool is_in_configuration(const std::string& name) {
  const std::string component = name.substr(0, name.find('.'));
  if (component.empty() || component.find('/') != std::string::npos) return false;
  std::error_code error;
  std::filesystem::path file;
  for (const char* folder : {"components", "sim"}) {
    file = data_path(std::filesystem::path(folder) / component / (component + ".yaml"));
    if (std::filesystem::exists(file, error)) break;
  }
  if (!std::filesystem::exists(file, error)) return false;
  try {
    YAML::Node node = YAML::LoadFile(file.string());
    for (std::size_t at = component.size(); at < name.size();) {
      const std::size_t end = std::min(name.find('.', at + 1), name.size());
      const YAML::Node next = node.IsMap() ? node[name.substr(at + 1, end - at - 1)] : YAML::Node();
      if (!next.IsDefined() || next.IsNull()) return false;
      node.reset(next);
      at = end;
    }
    return name.size() > component.size();
  } catch (const YAML::Exception&) {
    return false;
  }
}

}  // namespace constrictor::cli
