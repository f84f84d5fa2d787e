#include "cli/introspection/readable_sample.hpp"

#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <type_traits>
#include <utility>

#include "constrictor/constants.hpp"
#include "constrictor/reflect.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Walks over the fields of a message type and the members of a decoded sample at the same time.
class Reader {
 public:
  Reader(Json& sample, Arrays arrays) : sample_(sample), arrays_(arrays) {}

  template <class T>
  void operator()(const FieldInfo& info, const T& field) {
    if (!sample_.contains(info.name)) return;
    Json& value = sample_[info.name];
    if (std::string_view(info.name).ends_with("_count") && info.has_range && value.is_number_unsigned()) {
      count_ = value.get<std::size_t>();
      capacity_ = static_cast<std::size_t>(info.max);
    }
    // The token of a run lets its reader command the run, so it must not remain on terminals and in logs.
    if (std::string_view(info.name) == "token" && value.is_string() && !value.get<std::string>().empty())
      value = "(hidden)";
    make_readable(info, field, value);
  }

 private:
  template <class T>
  void make_readable(const FieldInfo& info, const T& field, Json& value) const {
    if constexpr (Described<T>) {
      if (value.is_object()) Description<T>::visit(field, Reader(value, arrays_));
    } else if constexpr (std::is_integral_v<T> && sizeof(T) == 1) {
      if (info.constants && value.is_number_unsigned() && value.get<std::uint64_t>() < info.constants->names.size())
        value = name_of(*info.constants, value.get<std::uint8_t>());
    }
  }
  template <class T, std::size_t N>
  void make_readable(const FieldInfo& info, const T (&field)[N], Json& value) const {
    if (!value.is_array()) return;  // a text: an array of characters in C++, but not in the sample
    if (arrays_ == Arrays::kUsed && N == capacity_ && count_ < value.size())
      value.erase(value.begin() + static_cast<std::ptrdiff_t>(count_), value.end());
    for (Json& element : value) make_readable(info, field[0], element);
  }

  Json& sample_;
  Arrays arrays_;
  std::size_t count_ = 0;     ///< value of the last ..._count field
  std::size_t capacity_ = 0;  ///< largest value of that field
};

template <class Message>
bool try_type(Json& sample, std::string_view name, Arrays arrays) {
  if (name != Description<Message>::kName) return false;
  const auto message = std::make_unique<Message>();  // only its fields' types matter; some types are large
  Description<Message>::visit(std::as_const(*message), Reader(sample, arrays));
  return true;
}

template <class... Messages>
void try_types(TypeList<Messages...>, Json& sample, std::string_view name, Arrays arrays) {
  static_cast<void>((try_type<Messages>(sample, name, arrays) || ...));
}

}  // namespace

void make_readable(Json& sample, const std::string& type, Arrays arrays) {
  constexpr std::string_view kModule = "constrictor::msg::";
  if (!sample.is_object() || !type.starts_with(kModule)) return;
  try_types(AllMessages{}, sample, std::string_view(type).substr(kModule.size()), arrays);
}

}  // namespace constrictor::cli
