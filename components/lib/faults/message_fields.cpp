#include "faults/message_fields.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <functional>
#include <memory>
#include <tuple>
#include <vector>

#include "configuration/closest_name.hpp"
#include "constrictor/reflect.hpp"

namespace constrictor {
namespace {

/// Visits the fields of a message along a path, and changes the number at its end.
struct FieldVisitor {
  std::string_view rest;                        ///< rest of the path
  const std::function<double(double)>* change;  ///< null: only look whether there is such a number
  bool found = false;
  std::string problem{};
  std::vector<std::string> names{};  ///< of the fields that the path could have named

  template <class T>
  void enter(T& value) {
    if constexpr (Described<T>) {
      if (!rest.starts_with('.')) return fail("it names a group of fields, not a number");
      rest.remove_prefix(1);
      FieldVisitor inner{rest, change};
      Description<std::remove_const_t<T>>::visit(value, inner);
      *this = std::move(inner);
      if (!found && problem.empty()) fail(did_you_mean(rest.substr(0, rest.find_first_of(".[")), names));
    } else if constexpr (std::is_floating_point_v<T>) {
      if (!rest.empty()) return fail("it goes on after a number");
      found = true;
      if (change) value = static_cast<T>((*change)(static_cast<double>(value)));
    } else {
      fail("it names no floating-point number");
    }
  }
  void fail(const std::string& why) {
    problem = why.empty() ? "there is no such field" : why.starts_with(',') ? "there is no such field" + why : why;
  }
  /// Takes the field's name from the path if it begins with it.
  bool takes(const char* name) {
    if (found || !problem.empty()) return false;
    names.emplace_back(name);
    const std::string_view text(name);
    if (!rest.starts_with(text)) return false;
    const std::string_view after = rest.substr(text.size());
    if (!after.empty() && after.front() != '.' && after.front() != '[') return false;
    rest = after;
    return true;
  }
  template <class T>
  void operator()(const FieldInfo& info, T& value) {
    if (takes(info.name)) enter(value);
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, T (&values)[N]) {
    if (!takes(info.name)) return;
    const auto close = rest.find(']');
    std::size_t index = N;
    if (rest.starts_with('[') && close != std::string_view::npos)
      std::from_chars(rest.data() + 1, rest.data() + close, index);
    if (index >= N) return fail(fmt::format("{} needs an index from [0] to [{}]", info.name, N - 1));
    rest.remove_prefix(close + 1);
    enter(values[index]);
  }
  template <std::size_t N>
  void operator()(const FieldInfo& info, char (&)[N]) {
    if (takes(info.name)) fail("it names a text");
  }
  void operator()(const FieldInfo& info, dds_sequence_octet&) {
    if (takes(info.name)) fail("it names bytes");
  }
};

struct FieldOps {
  std::optional<std::string> (*problem)(const std::string& path);
  Sample (*changed)(const Sample& sample, const std::string& path, const std::function<double(double)>& change);
};

template <class T>
FieldOps make_ops(const Topic<T>&) {
  return {[](const std::string& path) -> std::optional<std::string> {
            T blank{};
            FieldVisitor visitor{path, nullptr};
            Description<T>::visit(blank, visitor);
            if (visitor.found) return {};
            if (visitor.problem.empty())
              visitor.fail(did_you_mean(path.substr(0, path.find_first_of(".[")), visitor.names));
            return fmt::format("found {}, accepted the path of a floating-point number, such as x.y[2]; {}", path,
                               visitor.problem);
          },
          [](const Sample& sample, const std::string& path, const std::function<double(double)>& change) {
            const std::shared_ptr<T> copy = share_copy(*static_cast<const T*>(sample.message.get()));
            FieldVisitor visitor{path, &change};
            Description<T>::visit(*copy, visitor);
            return Sample{copy, &copy->header};
          }};
}

const auto kOps = std::apply(
    [](const auto&... topic) { return std::array<FieldOps, topics::kCount>{make_ops(topic)...}; }, topics::kAll);

}  // namespace

std::optional<std::string> not_a_real_number(std::size_t topic_id, const std::string& path) {
  return kOps.at(topic_id).problem(path);
}

Sample with_bias(std::size_t topic_id, const Sample& sample, const std::string& path, double amount) {
  return kOps.at(topic_id).changed(sample, path, [amount](double value) { return value + amount; });
}

}  // namespace constrictor
