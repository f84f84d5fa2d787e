// Values to bytes and back with cereal, for checkpoints. cereal's own archives write to a std::ostream, which costs
// more than the values: each member saves its state after each step.
#pragma once

#include <bit>
#include <cereal/cereal.hpp>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace constrictor {

static_assert(std::endian::native == std::endian::little, "checkpoints have the bytes of little-endian computers");

/// An output archive of cereal that appends to a string.
class BytesWriter : public cereal::OutputArchive<BytesWriter, cereal::AllowEmptyClassElision> {
 public:
  /// Uses the memory of this string; its content is lost.
  explicit BytesWriter(std::string memory = {}) : OutputArchive(this), bytes_(std::move(memory)) {
    bytes_.clear();
    bytes_.reserve(kRoom);
  }
  void write(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  /// What was written; afterwards the archive is empty.
  [[nodiscard]] std::string take() { return std::exchange(bytes_, {}); }

 private:
  static constexpr std::size_t kRoom = 16384;  // [byte] so that the memory of most states is allocated once
  std::string bytes_;
};

/// The inverse. The bytes must outlive it. Throws cereal::Exception if they end too early.
class BytesReader : public cereal::InputArchive<BytesReader, cereal::AllowEmptyClassElision> {
 public:
  explicit BytesReader(std::string_view bytes) : InputArchive(this), left_(bytes) {}
  void read(void* data, std::size_t size) {
    if (size > left_.size()) throw cereal::Exception("the bytes end too early");
    if (size > 0) std::memcpy(data, left_.data(), size);  // an empty block has no address
    left_.remove_prefix(size);
  }

 private:
  std::string_view left_;
};

// What cereal needs to know of an archive: numbers, blocks of numbers, names (left out) and sizes.

template <class T>
requires std::is_arithmetic_v<T>
void CEREAL_SAVE_FUNCTION_NAME(BytesWriter& archive, const T& value) { archive.write(&value, sizeof value); }

template <class T>
requires std::is_arithmetic_v<T>
void CEREAL_LOAD_FUNCTION_NAME(BytesReader& archive, T& value) { archive.read(&value, sizeof value); }

template <class T>
void CEREAL_SAVE_FUNCTION_NAME(BytesWriter& archive, const cereal::BinaryData<T>& block) {
  archive.write(block.data, static_cast<std::size_t>(block.size));
}

template <class T>
void CEREAL_LOAD_FUNCTION_NAME(BytesReader& archive, cereal::BinaryData<T>& block) {
  archive.read(block.data, static_cast<std::size_t>(block.size));
}

template <class Archive, class T>
requires std::is_same_v<Archive, BytesWriter> || std::is_same_v<Archive, BytesReader>
void CEREAL_SERIALIZE_FUNCTION_NAME(Archive& archive, cereal::NameValuePair<T>& pair) { archive(pair.value); }

template <class Archive, class T>
requires std::is_same_v<Archive, BytesWriter> || std::is_same_v<Archive, BytesReader>
void CEREAL_SERIALIZE_FUNCTION_NAME(Archive& archive, cereal::SizeTag<T>& tag) { archive(tag.size); }

/// The bytes of these values, one after the other.
template <class... T>
[[nodiscard]] std::string save_bytes(const T&... values) {
  BytesWriter writer;
  writer(values...);
  return writer.take();
}

/// The inverse. Throws cereal::Exception if the bytes end too early.
template <class... T>
void load_bytes(std::string_view bytes, T&... values) {
  BytesReader reader(bytes);
  reader(values...);
}

}  // namespace constrictor

CEREAL_SETUP_ARCHIVE_TRAITS(constrictor::BytesReader, constrictor::BytesWriter)
