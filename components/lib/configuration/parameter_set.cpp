#include "configuration/parameter_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace constrictor {
namespace {

template <class Value>
const Value& as(const void* field) {
  return *static_cast<const Value*>(field);
}

std::string range_text(Range accepted) { return fmt::format("{:g} to {:g}", accepted.min, accepted.max); }

std::string list_text(const std::vector<std::string>& elements) {
  return fmt::format("[{}]", fmt::join(elements, ", "));
}

std::string size_text(ListSize size) {
  return size.min == size.max ? fmt::format("{}", size.min) : fmt::format("{} to {}", size.min, size.max);
}

/// The names that a file may use: all names of an enumeration. Unused numbers of the enumeration have empty names.
std::vector<std::string> usable(std::vector<std::string> names) {
  std::erase(names, "");
  return names;
}

std::uint8_t index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::uint8_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::string choice_text(const std::vector<std::string>& choices) {
  return choices.empty() ? "a text" : fmt::format("one of {}", fmt::join(choices, ", "));
}

void check(bool consistent, const std::string& key, const char* what) {
  if (!consistent) throw std::logic_error("parameter " + key + ": " + what);
}

}  // namespace

double ParameterSet::add(double& field, const std::string& key, double fallback, const std::string& unit,
                         Range accepted, Changes changes, const std::string& meaning) {
  Row row;
  row.text = {key, unit, {}, meaning, {}, {}, changes, true, false, accepted};
  row.get = [](const void* at) { return as<double>(at); };
  row.set = [](void* at, double value) { *static_cast<double*>(at) = value; };
  add_number(row, &field, fallback);
  return fallback;
}

void ParameterSet::add_number(Row row, void* field, double fallback) {
  check(fallback >= row.text.bounds.min && fallback <= row.text.bounds.max, row.text.key,
        "the default is out of bounds");
  row.text.accepted = range_text(row.text.bounds);
  if (row.text.is_integer) {
    const auto whole = static_cast<std::int64_t>(fallback);
    row.text.default_value = fmt::format("{}", whole);
    row.print = [get = row.get](const void* at) { return fmt::format("{}", static_cast<std::int64_t>(get(at))); };
    row.read = [whole, set = row.set, bounds = row.text.bounds](Configuration& section, const std::string& key,
                                                                void* at) {
      const std::int64_t value =
          section.integer(key, static_cast<std::int64_t>(bounds.min), static_cast<std::int64_t>(bounds.max), whole);
      set(at, static_cast<double>(value));
    };
  } else {
    row.text.default_value = fmt::format("{}", fallback);
    row.print = [get = row.get](const void* at) { return fmt::format("{}", get(at)); };
    row.read = [fallback, set = row.set, bounds = row.text.bounds](Configuration& section, const std::string& key,
                                                                   void* at) {
      set(at, section.number(key, bounds, fallback));
    };
  }
  add_row(std::move(row), field);
}

bool ParameterSet::add(bool& field, const std::string& key, bool fallback, const std::string& meaning) {
  Row row;
  row.text = {key, "", "true or false", meaning, fallback ? "true" : "false", {}, Changes::kAtStart};
  row.print = [](const void* at) { return as<bool>(at) ? "true" : "false"; };
  row.read = [fallback](Configuration& section, const std::string& name, void* at) {
    *static_cast<bool*>(at) = section.flag(name, fallback);
  };
  add_row(std::move(row), &field);
  return fallback;
}

std::string ParameterSet::add(std::string& field, const std::string& key, const std::string& fallback,
                              const std::vector<std::string>& choices, const std::string& meaning) {
  check(choices.empty() || std::find(choices.begin(), choices.end(), fallback) != choices.end(), key,
        "the default is no choice");
  Row row;
  row.text = {key, "", choice_text(choices), meaning, fallback, {}, Changes::kAtStart};
  row.print = [](const void* at) { return as<std::string>(at); };
  row.read = [fallback, choices](Configuration& section, const std::string& name, void* at) {
    *static_cast<std::string*>(at) = section.text(name, choices, fallback);
  };
  add_row(std::move(row), &field);
  return fallback;
}

std::vector<double> ParameterSet::add(std::vector<double>& field, const std::string& key,
                                      const std::vector<double>& fallback, const std::string& unit, Range accepted,
                                      ListSize size, const std::string& meaning) {
  check(fallback.size() >= size.min && fallback.size() <= size.max, key, "the default has the wrong length");
  for (const double value : fallback)
    check(value >= accepted.min && value <= accepted.max, key, "the default is out of bounds");
  Row row;
  const std::string text = fmt::format("{} numbers, each {}", size_text(size), range_text(accepted));
  row.print = [](const void* at) { return fmt::format("[{}]", fmt::join(as<std::vector<double>>(at), ", ")); };
  row.text = {key, unit, text, meaning, row.print(&fallback), {}, Changes::kAtStart};
  row.read = [fallback, accepted, size](Configuration& section, const std::string& name, void* at) {
    *static_cast<std::vector<double>*>(at) = section.numbers(name, accepted, size.min, size.max, fallback);
  };
  add_row(std::move(row), &field);
  return fallback;
}

std::uint8_t ParameterSet::add(std::uint8_t& field, const std::string& key, std::uint8_t fallback,
                               const std::vector<std::string>& names, const std::string& meaning) {
  return add(field, key, fallback, names, Changes::kAtStart, meaning);
}

std::uint8_t ParameterSet::add(std::uint8_t& field, const std::string& key, std::uint8_t fallback,
                               const std::vector<std::string>& names, Changes changes, const std::string& meaning) {
  check(fallback < names.size() && !names[fallback].empty(), key, "the default has no name");
  Row row;
  row.text = {key, "", choice_text(usable(names)), meaning, names[fallback], {}, changes};
  if (changes == Changes::kWhileRunning) {
    for (const auto& name : names)
      check(!name.empty() && name.find(' ') == std::string::npos, key, "a name is empty or has a blank");
    row.text.names = names;
    row.text.bounds = {0.0, static_cast<double>(names.size()) - 1.0};
    row.get = [](const void* at) { return static_cast<double>(as<std::uint8_t>(at)); };
    row.set = [](void* at, double value) { *static_cast<std::uint8_t*>(at) = static_cast<std::uint8_t>(value); };
  }
  row.print = [names](const void* at) { return names.at(as<std::uint8_t>(at)); };
  row.read = [fallback, names](Configuration& section, const std::string& name, void* at) {
    *static_cast<std::uint8_t*>(at) = index_of(names, section.text(name, usable(names), names[fallback]));
  };
  add_row(std::move(row), &field);
  return fallback;
}

std::vector<std::uint8_t> ParameterSet::add(std::vector<std::uint8_t>& field, const std::string& key,
                                            const std::vector<std::uint8_t>& fallback,
                                            const std::vector<std::string>& names, ListSize size,
                                            const std::string& meaning) {
  check(fallback.size() >= size.min && fallback.size() <= size.max, key, "the default has the wrong length");
  for (const auto value : fallback) check(value < names.size() && !names[value].empty(), key, "a default has no name");
  Row row;
  row.print = [names](const void* at) {
    std::vector<std::string> elements;
    for (const auto value : as<std::vector<std::uint8_t>>(at)) elements.push_back(names.at(value));
    return list_text(elements);
  };
  const std::string text = fmt::format("{} names, each {}", size_text(size), choice_text(usable(names)));
  row.text = {key, "", text, meaning, row.print(&fallback), {}, Changes::kAtStart};
  row.read = [fallback, names, size](Configuration& section, const std::string& name, void* at) {
    std::vector<std::string> elements;
    for (const auto value : fallback) elements.push_back(names[value]);
    auto& values = *static_cast<std::vector<std::uint8_t>*>(at);
    values.clear();
    for (const auto& element : section.texts(name, usable(names), elements)) values.push_back(index_of(names, element));
    if (values.size() < size.min || values.size() > size.max)
      throw section.error(name, fmt::format("found {} names, accepted {}", values.size(), size_text(size)));
  };
  add_row(std::move(row), &field);
  return fallback;
}

void ParameterSet::add_row(Row row, const void* field) {
  const std::string& key = row.text.key;
  check(!key.empty() && key.front() != '.' && key.back() != '.', key, "the key is empty");
  check(!row.text.meaning.empty(), key, "the meaning is missing");
  check(std::none_of(rows_.begin(), rows_.end(), [&](const Row& other) { return other.text.key == key; }), key,
        "the key exists already");
  row.offset = offset_of(field);
  rows_.push_back(std::move(row));
}

void ParameterSet::adopt(const ParameterSet& section, const std::string& key, std::ptrdiff_t offset) {
  for (Row row : section.rows_) {
    row.text.key = key + "." + row.text.key;
    add_row(row, reinterpret_cast<const char*>(this) + offset + row.offset);
  }
}

std::vector<ParameterRow> ParameterSet::describe() const {
  std::vector<ParameterRow> texts;
  for (const Row& row : rows_) {
    texts.push_back(row.text);
    texts.back().value = row.print(field(row));
  }
  return texts;
}

namespace {

/// The section of the file that holds the keys below `path`; the root for an empty path.
Configuration& section_at(Configuration& root, std::map<std::string, Configuration>& sections,
                          const std::string& path) {
  if (path.empty()) return root;
  if (const auto known = sections.find(path); known != sections.end()) return known->second;
  const auto dot = path.rfind('.');
  const std::string parent = dot == std::string::npos ? "" : path.substr(0, dot);
  const std::string key = dot == std::string::npos ? path : path.substr(dot + 1);
  return sections.emplace(path, section_at(root, sections, parent).section(key, false)).first->second;
}

}  // namespace

void ParameterSet::read(Configuration& root) {
  std::map<std::string, Configuration> sections;
  for (const Row& row : rows_) {
    const auto dot = row.text.key.rfind('.');
    const std::string path = dot == std::string::npos ? "" : row.text.key.substr(0, dot);
    const std::string key = dot == std::string::npos ? row.text.key : row.text.key.substr(dot + 1);
    row.read(section_at(root, sections, path), key, field(row));
  }
  for (const auto& [path, section] : sections) section.finish();
}

}  // namespace constrictor
