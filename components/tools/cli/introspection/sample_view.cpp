#include "cli/introspection/sample_view.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "configuration/closest_name.hpp"
#include "configuration/counted.hpp"
#include "constrictor/hex.hpp"
#include "constrictor/json.hpp"
#include "constrictor/sha256.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;
using Kind = dds::TypeNode::Kind;
constexpr std::uint8_t kByte = 2;  // DDS_XTypes_TK_BYTE

bool is_bytes(const dds::TypeNode& type) {
  return type.kind == Kind::kSequence && type.element->kind == Kind::kPrimitive && type.element->primitive == kByte;
}

Json summary(const Json& list) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(list.size());
  for (const Json& byte : list) bytes.push_back(byte.get<std::uint8_t>());
  return {{"bytes", bytes.size()}, {"sha256", hex(sha256(std::as_bytes(std::span(bytes))))}};
}

double rounded(double value, int places) {
  const double scale = std::pow(10.0, places);
  const double scaled = value * scale;
  return std::isfinite(scaled) ? std::round(scaled) / scale + 0.0 : value;  // + 0.0: no "-0.0"
}

}  // namespace

void summarise_bytes(Json& sample, const dds::TypeNode& type) {
  if (is_bytes(type) && sample.is_array()) {
    sample = summary(sample);
  } else if (type.kind == Kind::kStruct && sample.is_object()) {
    for (const auto& member : type.members) {
      const auto found = sample.find(member.name);
      if (found != sample.end()) summarise_bytes(*found, *member.type);
    }
    if (type.name != "constrictor::msg::CameraImage") return;
    Json& data = sample["data"];
    if (data.value("bytes", 0) == sample.value("width", 0) * sample.value("height", 0) * 3)
      data["encoding"] = "RGB, 8 bit, rows from the top";
  } else if ((type.kind == Kind::kSequence || type.kind == Kind::kArray) && sample.is_array() &&
             type.element->kind == Kind::kStruct) {
    for (Json& element : sample) summarise_bytes(element, *type.element);
  }
}

void apply(Json& sample, const SampleView& view) {
  if (sample.is_array() && view.no_arrays) {
    sample = fmt::format("<{}>", counted(sample.size(), "value"));
  } else if (sample.is_structured()) {
    for (Json& part : sample) apply(part, view);
  } else if (sample.is_number_float() && view.precision) {
    sample = rounded(sample.get<double>(), *view.precision);
  }
}

std::optional<Json> part_of(const Json& sample, const std::string& path, std::string& problem) {
  const Json* at = &sample;
  for (const auto& name : CLI::detail::split(path, '.')) {
    const bool index = !name.empty() && name.size() < 10 && name.find_first_not_of("0123456789") == std::string::npos;
    if (at->is_array() && index && std::stoul(name) < at->size()) {
      at = &(*at)[std::stoul(name)];
    } else if (at->is_object() && at->contains(name)) {
      at = &(*at)[name];
    } else {
      std::string accepted;
      if (at->is_array()) {
        accepted = at->empty() ? "nothing, because the list is empty" : fmt::format("0 to {}", at->size() - 1);
      } else if (!at->is_object()) {
        accepted = "nothing, because a plain value has no parts";
      } else {
        std::vector<std::string> names;
        for (const auto& [key, value] : at->items()) names.push_back(key);
        accepted = fmt::format("{}{}", fmt::join(names, ", "), did_you_mean(name, names));
      }
      problem = fmt::format("found '{}', accepted {}", name, accepted);
      return std::nullopt;
    }
  }
  return *at;
}

std::string as_text(const Json& sample, int depth) {
  std::string text;
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  for (const auto& [name, field] : sample.items()) {
    const bool nested = field.is_object() || (field.is_array() && !field.empty() && field.front().is_object());
    if (nested) text += fmt::format("{}{}:\n", indent, name) + as_text(field, depth + 1);
    else
      text += fmt::format("{}{}: {}\n", indent, name, field.is_string() ? field.get<std::string>() : json_text(field));
  }
  return text;
}

}  // namespace constrictor::cli
