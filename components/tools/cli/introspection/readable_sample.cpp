#include "cli/introspection/readable_sample.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "cli/task_request.hpp"
#include "client/goal_tracker.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/field_table.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;

void change_fields(Json& sample, std::string_view type, Arrays arrays);

void change_value(Json& value, const FieldEntry& field, Arrays arrays) {
  if (!field.type.empty()) change_fields(value, field.type, arrays);
  else if (field.info.constants && value.is_number_unsigned() &&
           value.get<std::uint64_t>() < field.info.constants->names.size())
    value = name_of(*field.info.constants, value.get<std::uint8_t>());
}

void change_fields(Json& sample, std::string_view type, Arrays arrays) {
  const auto* fields = fields_of(type);
  if (!fields || !sample.is_object()) return;
  for (const FieldEntry& field : *fields) {
    const auto found = sample.find(field.info.name);
    if (found == sample.end()) continue;
    Json& value = *found;
    // The token of a run lets its reader command the run, so it must not remain on terminals and in logs.
    if (std::string_view(field.info.name) == "token" && value.is_string() && !value.get<std::string>().empty())
      value = "(hidden)";
    if (field.length == 0) {
      change_value(value, field, arrays);
    } else if (value.is_array()) {
      if (arrays == Arrays::kUsed && field.count_at >= 0) {
        const auto count = sample.find((*fields)[static_cast<std::size_t>(field.count_at)].info.name);
        if (count != sample.end() && count->is_number_unsigned() && count->get<std::uint64_t>() < value.size())
          value.erase(value.begin() + count->get<std::ptrdiff_t>(), value.end());
      }
      for (Json& element : value) change_value(element, field, arrays);
    }
  }
}

}  // namespace

void make_readable(Json& sample, const std::string& type, Arrays arrays) { change_fields(sample, type, arrays); }

void name_goals(Json& sample) {
  if (!sample.is_structured()) return;
  for (const auto& [name, value] : sample.items()) {
    // In a request, the field is already the number that the source has given to the goal.
    const bool whole_id = name == "goal_id" && value.is_number_unsigned() && goal_level(value.get<std::uint64_t>()) > 0;
    if (whole_id) value = fmt::format("{}, goal {}", value.get<std::uint64_t>(), goal_text(value.get<std::uint64_t>()));
    else name_goals(value);
  }
}

}  // namespace constrictor::cli
