#include "barrier/topic_ops.hpp"

#include <cstdlib>
#include <cstring>

#include "constrictor/reflect.hpp"

namespace constrictor {
namespace {

/// Visits a message's fields and finds the header in the canonical bytes. Only numbers and texts come before it.
struct HeaderFinder {
  std::span<const std::byte> bytes;
  std::size_t at = 0;
  bool found = false;
  template <class T>
  void operator()(const FieldInfo&, const T&) {
    if (found) return;
    if constexpr (std::is_same_v<T, msg::Header>) found = true;
    else at += sizeof(T);
  }
  template <std::size_t N>
  void operator()(const FieldInfo&, const char (&)[N]) {
    if (found) return;
    std::uint16_t length = 0;
    if (at + sizeof length <= bytes.size()) std::memcpy(&length, bytes.data() + at, sizeof length);
    at += sizeof length + length;
  }
};

/// Visits the fields of a header and writes them as reflect::ByteWriter does, but into memory of fixed size.
struct HeaderWriter {
  std::span<std::byte> left;
  template <class T>
  void operator()(const FieldInfo&, const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    if (left.size() < sizeof value) std::abort();  // a bug: HeaderBytes is shorter than a header
    std::memcpy(left.data(), &value, sizeof value);
    left = left.subspan(sizeof value);
  }
};

template <class T>
TopicOps make_ops(const Topic<T>& topic) {
  TopicOps ops{topic, sizeof(T), nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr};
  ops.stamp = [](const void* message, const msg::Header& header, std::uint16_t robot_id) {
    const std::shared_ptr<T> shared = share_copy(*static_cast<const T*>(message));
    shared->header = header;
    shared->robot_id = robot_id;
    return Sample{shared, &shared->header};
  };
  ops.copy = [](const void* message) {
    const std::shared_ptr<const T> shared = share_copy(*static_cast<const T*>(message));
    return Sample{shared, &shared->header};
  };
  ops.validate = [](const void* message) { return validate(*static_cast<const T*>(message)); };
  ops.append_bytes = [](const void* message, std::string& bytes) {
    canonical_bytes(*static_cast<const T*>(message), bytes);
  };
  ops.header_at = [](std::span<const std::byte> bytes) -> std::optional<std::size_t> {
    static const T kBlank{};  // the finder only looks at the types of its fields
    HeaderFinder finder{bytes};
    Description<T>::visit(kBlank, finder);
    if (!finder.found || finder.at + kHeaderSize > bytes.size()) return {};
    return finder.at;
  };
  ops.parse = [](std::span<const std::byte> bytes) {
    std::shared_ptr<const T> shared = parse_shared<T>(bytes);
    return shared ? Sample{shared, &shared->header} : Sample{};
  };
  ops.difference = [](const void* a, const void* b) {
    return first_difference(*static_cast<const T*>(a), *static_cast<const T*>(b));
  };
  return ops;
}

const auto kOps = std::apply(
    [](const auto&... topic) { return std::array<TopicOps, topics::kCount>{make_ops(topic)...}; }, topics::kAll);

}  // namespace

const TopicOps& topic_ops(std::size_t topic_id) { return kOps.at(topic_id); }

msg::Header neutral_header(msg::Header header) {
  header.run_id = 0;
  header.epoch = header.incarnation = 0;
  return header;
}

std::string neutral_message(std::size_t topic_id, std::string bytes) {
  const auto all = std::as_bytes(std::span(bytes));
  const auto at = topic_ops(topic_id).header_at(all);
  if (!at) return bytes;
  const HeaderBytes header = header_bytes(neutral_header(parse_header(all.subspan(*at).first<kHeaderSize>())));
  std::memcpy(bytes.data() + *at, header.data(), header.size());
  std::memset(bytes.data(), 0, sizeof(std::uint16_t));  // the robot id
  return bytes;
}

HeaderBytes header_bytes(const msg::Header& header) {
  HeaderBytes bytes{};
  HeaderWriter writer{bytes};
  Description<msg::Header>::visit(header, writer);
  if (!writer.left.empty()) std::abort();  // a bug: HeaderBytes is longer than a header
  return bytes;
}

msg::Header parse_header(std::span<const std::byte, kHeaderSize> bytes) {
  msg::Header header{};
  std::vector<std::uint8_t> unused;
  Description<msg::Header>::visit(header, reflect::ByteReader{bytes, unused});
  return header;
}

}  // namespace constrictor
