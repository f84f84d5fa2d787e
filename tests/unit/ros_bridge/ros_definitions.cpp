#include "unit/ros_bridge/ros_definitions.hpp"

#include <fmt/format.h>

#include <regex>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>

#include "constrictor/hex.hpp"
#include "constrictor/sha256.hpp"

namespace constrictor::ros_bridge {
namespace {

using Count = RosField::Count;

/// A type of ros_types.idl in the words of .msg files.
std::string msg_type(const std::string& idl, const std::string& package) {
  static const std::map<std::string, std::string> kBasic = {
      {"long", "int32"},   {"unsigned long", "uint32"}, {"double", "float64"}, {"float", "float32"},
      {"boolean", "bool"}, {"octet", "byte"},           {"uint8", "uint8"},    {"string", "string"}};
  if (const auto basic = kBasic.find(idl); basic != kBasic.end()) return basic->second;
  static const std::regex kNamed(R"((?:(\w+)::msg::dds_::)?(\w+)_)");
  std::smatch match;
  if (!std::regex_match(idl, match, kNamed)) throw std::invalid_argument("type '" + idl + "'");
  return (match[1].matched ? match[1].str() : package) + "/" + match[2].str();
}

/// Source: type_description_interfaces/msg/FieldType.msg.
int type_id(const RosField& field) {
  static const std::map<std::string, int> kIds = {{"uint8", 3},    {"int32", 6}, {"uint32", 7}, {"float32", 10},
                                                  {"float64", 11}, {"bool", 15}, {"byte", 16},  {"string", 17}};
  const auto basic = kIds.find(field.type);
  const int one = basic == kIds.end() ? 1 : field.bound > 0 ? 21 : basic->second;
  return one + (field.count == Count::kArray ? 48 : field.count == Count::kSequence ? 144 : 0);
}

bool is_message(const RosField& field) { return field.type.find('/') != std::string::npos; }

std::string full_name(std::string message) { return message.replace(message.find('/'), 1, "/msg/"); }

// Python's json.dumps writes a blank after each comma and colon; nlohmann's dump() cannot.
std::string description(const std::string& message, const std::vector<RosField>& fields) {
  std::string list;
  for (const RosField& field : fields) {
    list += fmt::format(R"({}{{"name": "{}", "type": {{"type_id": {}, "capacity": {}, "string_capacity": {}, )"
                        R"("nested_type_name": "{}"}}}})",
                        list.empty() ? "" : ", ", field.name, type_id(field), field.size, field.bound,
                        is_message(field) ? full_name(field.type) : "");
  }
  return fmt::format(R"({{"type_name": "{}", "fields": [{}]}})", full_name(message), list);
}

void collect(const std::string& message, const RosDefinitions& definitions, std::set<std::string>& found) {
  for (const RosField& field : definitions.at(message)) {
    if (is_message(field) && found.insert(field.type).second) collect(field.type, definitions, found);
  }
}

}  // namespace

std::ostream& operator<<(std::ostream& stream, const RosField& field) {
  stream << field.type;
  if (field.bound > 0) stream << "<=" << field.bound;
  if (field.count == Count::kArray) stream << "[" << field.size << "]";
  if (field.count == Count::kSequence) stream << "[]";
  return stream << " " << field.name;
}

RosDefinitions read_ros_idl(const std::string& text) {
  const std::string code = std::regex_replace(text, std::regex("//[^\n]*"), "");
  static const std::regex kModule(R"(module (\w+) \{ module msg \{ module dds_ \{([^]*?)\}; \}; \};)");
  static const std::regex kStruct(R"(@final struct (\w+)_ \{([^}]*)\};)");
  static const std::regex kField(R"(\s*(sequence<(.+)>|string<(\d+)>|(?:unsigned )?[\w:]+)\s+(\w+)(?:\[(\d+)\])?\s*)");
  RosDefinitions definitions;
  for (std::sregex_iterator module(code.begin(), code.end(), kModule), end; module != end; ++module) {
    const std::string package = (*module)[1];
    const std::string body = (*module)[2];
    for (std::sregex_iterator item(body.begin(), body.end(), kStruct); item != end; ++item) {
      auto& fields = definitions[package + "/" + (*item)[1].str()];
      std::istringstream list((*item)[2].str());
      for (std::string line; std::getline(list, line, ';');) {
        if (line.find_first_not_of(" \n") == std::string::npos) continue;
        std::smatch match;
        if (!std::regex_match(line, match, kField)) throw std::invalid_argument("field '" + line + "'");
        RosField field;
        field.name = match[4];
        field.type = match[3].matched ? "string" : msg_type(match[2].matched ? match[2] : match[1], package);
        if (match[2].matched) field.count = Count::kSequence;
        if (match[3].matched) field.bound = std::stoul(match[3]);
        if (match[5].matched) {
          field.count = Count::kArray;
          field.size = std::stoul(match[5]);
        }
        fields.push_back(std::move(field));
      }
    }
  }
  return definitions;
}

std::vector<RosField> read_ros_msg(const std::string& text, const std::string& package) {
  static const std::regex kField(R"(\s*([\w/]+)(\[(\d*)\])?\s+(\w+)\s*)");
  std::vector<RosField> fields;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    std::smatch match;
    if (!std::regex_match(line, match, kField)) continue;  // blank, or a constant
    RosField field;
    field.type = match[1];
    field.name = match[4];
    if (match[2].matched) field.count = match[3].length() > 0 ? Count::kArray : Count::kSequence;
    if (match[3].length() > 0) field.size = std::stoul(match[3]);
    if (std::isupper(static_cast<unsigned char>(field.type.front())) != 0)
      field.type = (field.type == "Header" ? "std_msgs" : package) + "/" + field.type;
    fields.push_back(std::move(field));
  }
  return fields;
}

std::string ros_type_hash(const std::string& message, const RosDefinitions& definitions) {
  std::set<std::string> parts;
  collect(message, definitions, parts);
  std::set<std::string> sorted;  // by their full names, as ROS 2 does
  for (const auto& part : parts) sorted.insert(full_name(part));
  std::string references;
  for (const auto& name : sorted) {
    std::string part = name;
    part.replace(part.find("/msg/"), 5, "/");
    references += (references.empty() ? "" : ", ") + description(part, definitions.at(part));
  }
  const std::string json = fmt::format(R"({{"type_description": {}, "referenced_type_descriptions": [{}]}})",
                                       description(message, definitions.at(message)), references);
  return hex(sha256(std::as_bytes(std::span(json))));
}

}  // namespace constrictor::ros_bridge
