#include "constrictor/field_table.hpp"

#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "constrictor/reflect.hpp"

namespace constrictor {
namespace {

using Table = std::map<std::string, std::vector<FieldEntry>, std::less<>>;

template <class T>
std::string_view struct_name() {
  if constexpr (Described<T>) {
    static const std::string name = std::string("constrictor::msg::") + Description<std::remove_const_t<T>>::kName;
    return name;
  }
  return {};
}

/// Notes each field that it visits.
struct Noter {
  std::vector<FieldEntry>& fields;

  template <class T>
  void operator()(const FieldInfo& info, const T&) const {
    fields.push_back({info, struct_name<T>()});
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, const T (&)[N]) const {
    FieldEntry entry{info, struct_name<T>(), N};
    // The array belongs to the last field ..._count before it, if that field can count all of its elements.
    for (auto at = static_cast<std::ptrdiff_t>(fields.size()); at-- > 0 && entry.count_at < 0;) {
      const FieldInfo& other = fields[static_cast<std::size_t>(at)].info;
      if (!std::string_view(other.name).ends_with("_count") || !other.has_range) continue;
      if (other.max == static_cast<double>(N)) entry.count_at = at;
      break;
    }
    fields.push_back(entry);
  }
  template <std::size_t N>
  void operator()(const FieldInfo& info, const char (&)[N]) const {
    fields.push_back({info, {}});
  }
};

template <class Message>
void add(Table& table) {
  const auto message = std::make_unique<Message>();  // only its fields' types matter; some types are large
  std::vector<FieldEntry> fields;
  Description<Message>::visit(std::as_const(*message), Noter{fields});
  table.emplace(struct_name<Message>(), std::move(fields));
}

template <class... Messages>
Table make_table(TypeList<Messages...>) {
  Table table;
  (add<Messages>(table), ...);
  return table;
}

}  // namespace

const std::vector<FieldEntry>* fields_of(std::string_view type) {
  static const Table table = make_table(AllMessages{});
  const auto found = table.find(type);
  return found == table.end() ? nullptr : &found->second;
}

}  // namespace constrictor
