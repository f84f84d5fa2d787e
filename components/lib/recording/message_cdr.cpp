#include "recording/message_cdr.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "constrictor/topics.hpp"

namespace constrictor {
namespace {

using mcap::Bytes;

constexpr std::string_view kLittleEndian{"\0\x01\0\0", 4};  // encapsulation header: CDR_LE, no options
constexpr std::size_t kHeader = kLittleEndian.size();
constexpr std::size_t kMostPadding = 3;  // [byte] after a message, so that its length is a multiple of 4

// Both visitors see a message's fields in order. They look at the types of the fields only, and move the values from
// one form of bytes to the other one.

struct ToCdr {
  Bytes in;
  std::string& out;
  std::size_t start;  ///< in `out`: alignment counts from here
  bool ok = true;

  void move(std::size_t size) {
    if (size > in.size()) ok = false;
    if (!ok) return;
    out.append(mcap::text_of(in.first(size)));
    in = in.subspan(size);
  }
  void align(std::size_t size) { out.append((size - (out.size() - start) % size) % size, '\0'); }
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
    if constexpr (Described<T>) {
      Description<T>::visit(value, *this);
    } else {
      align(sizeof(T));
      move(sizeof(T));
    }
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, const T (&values)[N]) {
    if constexpr (Described<T>) {
      for (const T& value : values) (*this)(info, value);
    } else {
      align(sizeof(T));
      move(sizeof(values));
    }
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
    put_length(size);
    move(size);
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
    if constexpr (Described<T>) {
      Description<T>::visit(value, *this);
    } else {
      align(sizeof(T));
      move(sizeof(T));
    }
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, const T (&values)[N]) {
    if constexpr (Described<T>) {
      for (const T& value : values) (*this)(info, value);
    } else {
      align(sizeof(T));
      move(sizeof(values));
    }
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

template <class T>
constexpr MessageCodec make_codec() {
  return {Description<T>::kName,
          [](Bytes canonical, std::string& cdr) {
            static const T kBlank{};
            cdr.append(kLittleEndian);
            ToCdr visitor{canonical, cdr, cdr.size()};
            Description<T>::visit(kBlank, visitor);
            return visitor.ok && visitor.in.empty();
          },
          [](Bytes cdr, std::string& canonical) {
            static const T kBlank{};
            // The last two bytes of the header are options, which say how many bytes of padding follow the message.
            if (cdr.size() < kHeader || cdr[0] != 0 || cdr[1] != 1) return false;
            FromCdr visitor{cdr.subspan(kHeader), canonical};
            Description<T>::visit(kBlank, visitor);
            return visitor.ok && visitor.all.size() - visitor.at <= kMostPadding;
          }};
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
