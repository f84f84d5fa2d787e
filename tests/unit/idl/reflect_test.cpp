// Validation, canonical bytes, copies, hashes and JSON, for every message type.
#include "constrictor/reflect.hpp"

#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <cmath>
#include <limits>

#include "constrictor/compare.hpp"
#include "constrictor/hex.hpp"
#include "constrictor/json.hpp"
#include "constrictor/sha256.hpp"
#include "random_message.hpp"

namespace constrictor {
namespace {

using testing::for_each_type;
using testing::RandomFiller;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class T>
std::string bytes_of(const T& message) {
  std::string bytes;
  canonical_bytes(message, bytes);
  return bytes;
}

std::span<const std::byte> span_of(const std::string& bytes) { return std::as_bytes(std::span(bytes)); }

/// Sets each field of a message in turn to values at and outside its limits, calls `check` and restores the field.
template <class Check>
struct Spoiler {
  Check& check;
  template <class T>
  void operator()(const FieldInfo& info, T& value) {
    if constexpr (Described<T>) {
      Description<T>::visit(value, *this);
    } else if constexpr (!std::is_same_v<T, bool> && !std::is_same_v<T, dds_sequence_octet>) {
      const T before = value;
      const auto with = [&](double spoilt, bool accepted) {
        value = static_cast<T>(spoilt);
        if (static_cast<double>(value) == spoilt || std::isnan(spoilt)) check(info, accepted);
      };
      if (info.has_range) {
        with(info.min, true);
        with(info.max, true);
        if (info.min > 0 || std::is_floating_point_v<T>) with(info.min - 1, false);
        if (info.max < 200) with(info.max + 1, false);
      }
      if constexpr (std::is_floating_point_v<T>) {
        with(kNan, info.nan_allowed);
        with(kInfinity, false);
        with(-kInfinity, false);
      }
      value = before;
    }
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, T (&values)[N]) {
    (*this)(info, values[0]);
    (*this)(info, values[N - 1]);
  }
  template <std::size_t N>
  void operator()(const FieldInfo& info, char (&text)[N]) {
    char before[N];
    std::memcpy(before, text, N);
    std::memset(text, 'x', N);
    check(info, false);
    text[N - 1] = '\0';
    check(info, true);
    std::memcpy(text, before, N);
  }
};

TEST(Validate, AcceptsRandomMessagesWithinTheirAnnotations) {
  for_each_type(AllMessages{}, [&]<class T>() {
    RandomFiller fill(7);
    T message{};
    Description<T>::visit(message, fill);
    const auto found = validate(message);
    EXPECT_FALSE(found) << Description<T>::kName << ": " << *found;
  });
}

TEST(Validate, RejectsEveryFieldOutsideItsAnnotations) {
  int checks = 0;
  for_each_type(AllMessages{}, [&]<class T>() {
    RandomFiller fill(8);
    T message{};
    Description<T>::visit(message, fill);
    auto check = [&](const FieldInfo& info, bool accepted) {
      const auto found = validate(message);
      ++checks;
      EXPECT_EQ(!found, accepted) << Description<T>::kName << "." << info.name << " " << found.value_or("");
      if (found && !accepted) {
        EXPECT_NE(found->find(info.name), std::string::npos) << *found;
      }
    };
    Description<T>::visit(message, Spoiler<decltype(check)>{check});
  });
  EXPECT_GT(checks, 1000);
}

TEST(Validate, NamesTheFieldTheFoundAndTheAcceptedValues) {
  msg::JointState joints{};
  joints.position_rad[3] = kNan;
  EXPECT_EQ(validate(joints), "position_rad[3]: found nan, accepted finite");
  msg::JointCommand command{};
  command.joint_count = 65;
  EXPECT_EQ(validate(command), "joint_count: found 65, accepted 0 to 64");
  msg::TaskCommand task{};
  task.parameters.timeout_s = -1;
  EXPECT_EQ(validate(task), "parameters.timeout_s: found -1, accepted 0 to 3600 or nan");
  msg::ContactState skin{};
  skin.contacts[2].module_index = 64;
  EXPECT_EQ(validate(skin), "contacts[2].module_index: found 64, accepted 0 to 63");
  msg::CameraImage image{};
  image.width = image.height = 1;
  image.data._length = 3;
  EXPECT_EQ(validate(image), "data: found a length without bytes, accepted bytes");
}

TEST(Validate, RejectsAByteThatIsNotABoolean) {
  msg::Authority authority{};
  std::memset(&authority.emergency_stop, 7, 1);
  EXPECT_EQ(validate(authority), "emergency_stop: found neither 0 nor 1, accepted a boolean");
}

TEST(CanonicalBytes, AreTheFieldsInOrderWithoutPadding) {
  msg::TaskParameters parameters{};
  parameters.line_colour = 1;
  parameters.object_colour = 2;
  parameters.object_handle = 0x1234;
  parameters.drop_zone_colour = 3;
  parameters.direction = 4;
  parameters.timeout_s = 1.0;
  parameters.clearance_m = 2.0;
  EXPECT_EQ(bytes_of(parameters),
            std::string("\x01\x02\x34\x12\x03\x04\0\0\0\0\0\0\xf0\x3f\0\0\0\0\0\0\0\x40", 22) + std::string(8, '\0'));
  msg::Ready ready{};
  std::strcpy(ready.component, "ab");
  ready.epoch = 1;
  EXPECT_EQ(bytes_of(ready),
            std::string("\x02\0ab", 4) + std::string(8, '\0') + std::string("\x01\0\0\0", 4) + std::string(4, '\0'));
}

TEST(CanonicalBytes, RoundTripEveryType) {
  for_each_type(AllMessages{}, [&]<class T>() {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      RandomFiller fill(seed);
      T message{};
      Description<T>::visit(message, fill);
      const std::string bytes = bytes_of(message);
      const auto parsed = parse_shared<T>(span_of(bytes));
      ASSERT_TRUE(parsed) << Description<T>::kName;
      EXPECT_EQ(bytes_of(*parsed), bytes);
      const auto difference = first_difference(message, *parsed);
      EXPECT_FALSE(difference) << Description<T>::kName << "." << difference->path;
    }
  });
}

TEST(CanonicalBytes, RejectTruncatedAndAdditionalBytes) {
  for_each_type(AllMessages{}, [&]<class T>() {
    RandomFiller fill(3);
    T message{};
    Description<T>::visit(message, fill);
    const std::string bytes = bytes_of(message);
    const std::size_t stride = std::max<std::size_t>(1, bytes.size() / 50);
    for (std::size_t size = 0; size < bytes.size(); size += stride) {
      EXPECT_FALSE(parse_shared<T>(span_of(bytes).first(size))) << Description<T>::kName << " cut to " << size;
    }
    EXPECT_FALSE(parse_shared<T>(span_of(bytes).first(bytes.size() - 1))) << Description<T>::kName;
    EXPECT_FALSE(parse_shared<T>(span_of(bytes + "x"))) << Description<T>::kName;
  });
}

TEST(ShareCopy, OwnsTheBytesOfItsSequence) {
  std::vector<std::uint8_t> pixels = {1, 2, 3};
  msg::CameraImage image{};
  image.data = {3, 3, pixels.data(), false};
  const auto copy = share_copy(image);
  pixels.assign(3, 9);
  ASSERT_EQ(copy->data._length, 3u);
  EXPECT_EQ(copy->data._buffer[0], 1);
  EXPECT_EQ(copy->data._buffer[2], 3);
}

TEST(Hash, EqualsAStandardVectorAndOpenSslsOwnFunction) {
  Sha256 hash;
  const std::string abc = "abc";
  hash.update(span_of(abc).first(1));
  hash.update(span_of(abc).subspan(1));
  // Source: FIPS 180-2, appendix B.1.
  EXPECT_EQ(hex(hash.finish()), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");

  RandomFiller fill(5);
  msg::WorldState world{};
  Description<msg::WorldState>::visit(world, fill);
  const std::string bytes = bytes_of(world);
  Sha256::Digest expected{};
  unsigned int size = 0;
  ASSERT_EQ(EVP_Digest(bytes.data(), bytes.size(), expected.data(), &size, EVP_sha256(), nullptr), 1);
  hash.update(span_of(bytes));
  EXPECT_EQ(hash.finish(), expected);
}

TEST(Json, HoldsEveryFieldInOrder) {
  msg::RobotPose pose{};
  pose.x_m = 1.5;
  pose.covariance[8] = kNan;
  pose.header.tick = -3;
  const auto json = to_json(pose);
  EXPECT_EQ(json["x_m"], 1.5);
  EXPECT_EQ(json["header"]["tick"], -3);
  EXPECT_TRUE(json["covariance"][8].is_null());
  EXPECT_EQ(json["covariance"].size(), 9u);
  EXPECT_EQ(json.begin().key(), "robot_id");
  msg::CameraImage image{};
  EXPECT_EQ(to_json(image)["data"], "<0 bytes>");
}

}  // namespace
}  // namespace constrictor
