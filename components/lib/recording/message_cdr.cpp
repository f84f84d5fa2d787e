#include "recording/message_cdr.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <type_traits>
#include <vector>

#include "constrictor/topics.hpp"

namespace constrictor {
namespace {

using mcap::Bytes;

constexpr std::string_view kLittleEndian{"\0\x01\0\0", 4};  // encapsulation header: CDR_LE, no options
constexpr std::size_t kHeader = kLittleEndian.size();
constexpr std::size_t kMostPadding = 3;  // [byte] after a message, so that its length is a multiple of 4

// Both visitors see a message's fields in order. They look at the types of the fields only, and move the values from
// one form of bytes to the other one.

/// A number, a structure, or an array of them.
template <class Visitor, class T>
void move_value(Visitor& visitor, const T& value) {
  if constexpr (Described<T>) {
    Description<T>::visit(value, visitor);
  } else if constexpr (std::is_array_v<T> && Described<std::remove_extent_t<T>>) {
    for (const auto& item : value) Description<std::remove_extent_t<T>>::visit(item, visitor);
  } else {
    visitor.align(sizeof(std::remove_extent_t<T>));
    visitor.move(sizeof(T));
  }
}

struct ToCdr {
  Bytes in;
  std::string& out;
  std::size_t start;  ///< in `out`: alignment counts from here
  bool octets;        ///< false: sequences of octets become empty
  bool ok = true;

  void move(std::size_t size) {
    if (size > in.size()) ok = false;
    if (!ok) return;
    out.append(mcap::text_of(in.first(size)));
    in = in.subspan(size);
  }
  void align(std::size_t size) {
    const std::size_t padding = (size - (out.size() - start) % size) % size;
    if (padding > 0) out.append(padding, '\0');
  }
  template <class Length>
  std::size_t length() {
    Length value = 0;
    if (sizeof value > in.size()) ok = false;
    if (!ok) return 0;
    std::memcpy(&value, in.data(), sizeof value);
    in = in.subspan(sizeof value);
    return value;
  }
  void put_length(std::size_t value) {
    align(4);
    mcap::Encoder(out).number(static_cast<std::uint32_t>(value));
  }
  template <class T>
  void operator()(const FieldInfo&, const T& value) {
    move_value(*this, value);
  }
  template <std::size_t N>
  void operator()(const FieldInfo&, const char (&)[N]) {
    const std::size_t size = length<std::uint16_t>();
    ok = ok && size < N;
    put_length(size + 1);
    move(size);
    out.push_back('\0');
  }
  void operator()(const FieldInfo&, const dds_sequence_octet&) {
    const std::size_t size = length<std::uint32_t>();
    put_length(octets ? size : 0);
    if (octets) return move(size);
    if (size > in.size()) ok = false;
    if (ok) in = in.subspan(size);
  }
};

struct FromCdr {
  Bytes all;  ///< after the encapsulation header
  std::string& out;
  std::size_t at = 0;
  bool ok = true;

  Bytes take(std::size_t size) {
    if (!ok || at > all.size() || size > all.size() - at) {
      ok = false;
      return {};
    }
    at += size;
    return all.subspan(at - size, size);
  }
  void move(std::size_t size) { out.append(mcap::text_of(take(size))); }
  void align(std::size_t size) { at += (size - at % size) % size; }
  std::size_t length() {
    align(4);
    const Bytes bytes = take(4);
    std::uint32_t value = 0;
    if (ok) std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  template <class T>
  void operator()(const FieldInfo&, const T& value) {
    move_value(*this, value);
  }
  template <std::size_t N>
  void operator()(const FieldInfo&, const char (&)[N]) {
    const Bytes text = take(length());
    if (text.size() > N) ok = false;
    if (!ok) return;
    const auto size = static_cast<std::uint16_t>(std::find(text.begin(), text.end(), 0) - text.begin());
    if (!text.empty() && size == text.size()) ok = false;  // no terminating zero
    mcap::Encoder(out).number(size);
    out.append(mcap::text_of(text.first(size)));
  }
  void operator()(const FieldInfo&, const dds_sequence_octet&) {
    const Bytes octets = take(length());
    mcap::Encoder(out).number(static_cast<std::uint32_t>(octets.size()));
    out.append(mcap::text_of(octets));
  }
};

/// Goes through the fields until it finds the header. Only numbers and texts come before it.
struct HeaderReader {
  Bytes all;
  std::optional<msg::Header> found{};
  std::size_t at = 0;

  template <class T>
  void operator()(const FieldInfo&, const T&) {
    if (found) return;
    if constexpr (std::is_same_v<T, msg::Header>) read_header();
    else if constexpr (Described<T>) at = all.size();
    else at += (sizeof(T) - at % sizeof(T)) % sizeof(T) + sizeof(T);
  }
  template <std::size_t N>
  void operator()(const FieldInfo&, const char (&)[N]) {
    at += (4 - at % 4) % 4;
    std::uint32_t size = 0;
    if (found || at > all.size() || all.size() - at < sizeof size) return;
    std::memcpy(&size, all.data() + at, sizeof size);
    at += sizeof size + size;
  }
  void operator()(const FieldInfo&, const dds_sequence_octet&) {}
  void read_header() {
    std::string canonical;
    FromCdr visitor{all, canonical, at + (8 - at % 8) % 8};
    static const msg::Header kBlank{};
    Description<msg::Header>::visit(kBlank, visitor);
    if (!visitor.ok) return;
    std::vector<std::uint8_t> unused;
    Description<msg::Header>::visit(found.emplace(), reflect::ByteReader{std::as_bytes(std::span(canonical)), unused});
  }
};

/// Writes the fields of a structure, and collects the structures that it contains.
struct SchemaWriter {
  struct Part {
    std::string name;
    void (*write)(SchemaWriter&);
  };
  std::string text;
  std::vector<Part> parts;

  template <class T>
  static void write_structure(SchemaWriter& writer) {
    static const T kBlank{};
    Description<T>::visit(kBlank, writer);
  }
  template <class T>
  std::string type_name() {
    if constexpr (Described<T>) {
      const std::string name = Description<T>::kName;
      if (std::none_of(parts.begin(), parts.end(), [&](const Part& part) { return part.name == name; }))
        parts.push_back({name, write_structure<T>});
      return "constrictor/" + name;
    } else if constexpr (std::is_same_v<T, bool>) {
      return "bool";
    } else {
      const char* kind = std::is_floating_point_v<T> ? "float" : std::is_signed_v<T> ? "int" : "uint";
      return kind + std::to_string(8 * sizeof(T));
    }
  }
  void line(const FieldInfo& info, const std::string& type) {
    text += type + " ";
    // ROS 2 requires lower case.
    for (const char* at = info.name; *at != '\0'; ++at) text += static_cast<char>(std::tolower(*at));
    text += '\n';
  }
  template <class T>
  void operator()(const FieldInfo& info, const T&) {
    line(info, type_name<T>());
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, const T (&)[N]) {
    line(info, type_name<T>() + "[" + std::to_string(N) + "]");
  }
  template <std::size_t N>
  void operator()(const FieldInfo& info, const char (&)[N]) {
    line(info, "string");
  }
  void operator()(const FieldInfo& info, const dds_sequence_octet&) { line(info, "uint8[]"); }
};

template <class T>
std::string make_schema() {
  SchemaWriter writer;
  SchemaWriter::write_structure<T>(writer);
  for (std::size_t i = 0; i < writer.parts.size(); ++i) {
    const SchemaWriter::Part part = writer.parts[i];
    writer.text += std::string(80, '=') + "\nMSG: constrictor/" + part.name + "\n";
    part.write(writer);
  }
  return writer.text;
}

template <class T>
bool convert_to_cdr(Bytes canonical, std::string& cdr, bool octets) {
  static const T kBlank{};
  cdr.append(kLittleEndian);
  ToCdr visitor{canonical, cdr, cdr.size(), octets};
  Description<T>::visit(kBlank, visitor);
  // The same form as DDS sends: padded to a multiple of 4 bytes, with the number of these bytes in the options.
  const std::size_t padding = (4 - (cdr.size() - visitor.start) % 4) % 4;
  cdr.append(padding, '\0');
  cdr[visitor.start - 1] = static_cast<char>(padding);
  return visitor.ok && visitor.in.empty();
}

template <class T>
constexpr MessageCodec make_codec() {
  return {Description<T>::kName,
          [](Bytes canonical, std::string& cdr) { return convert_to_cdr<T>(canonical, cdr, true); },
          [](Bytes canonical, std::string& cdr) { return convert_to_cdr<T>(canonical, cdr, false); },
          [](Bytes cdr, std::string& canonical) {
            static const T kBlank{};
            // The last two bytes of the header are options, which say how many bytes of padding follow the message.
            if (cdr.size() < kHeader || cdr[0] != 0 || cdr[1] != 1) return false;
            FromCdr visitor{cdr.subspan(kHeader), canonical};
            Description<T>::visit(kBlank, visitor);
            return visitor.ok && visitor.all.size() - visitor.at <= kMostPadding;
          },
          [](Bytes cdr) -> std::optional<msg::Header> {
            static const T kBlank{};
            if (cdr.size() < kHeader || cdr[0] != 0 || cdr[1] != 1) return {};
            HeaderReader reader{cdr.subspan(kHeader)};
            Description<T>::visit(kBlank, reader);
            return reader.found;
          },
          make_schema<T>};
}

constexpr std::array kCodecs{
#define CONSTRICTOR_MEMBER_TOPIC(constant, Type, ...) make_codec<msg::Type>(),
#define CONSTRICTOR_UNCOUNTED_TOPIC(constant, Type, ...) make_codec<msg::Type>(),
#include "constrictor/topic_table.def"
#undef CONSTRICTOR_MEMBER_TOPIC
#undef CONSTRICTOR_UNCOUNTED_TOPIC
};

}  // namespace

const MessageCodec* find_codec(std::string_view type) {
  const auto* found =
      std::find_if(kCodecs.begin(), kCodecs.end(), [&](const MessageCodec& codec) { return codec.type == type; });
  return found == kCodecs.end() ? nullptr : found;
}

}  // namespace constrictor
