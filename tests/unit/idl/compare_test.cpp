// The first difference between two messages, for every message type.
#include "constrictor/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "random_message.hpp"

namespace constrictor {
namespace {

using testing::for_each_type;
using testing::RandomFiller;

/// Flips one bit of each field of `b` in turn and checks that the difference from `a` is found there.
template <class Message>
struct Flipper {
  const Message& a;
  Message& b;
  int* flips;
  template <class T>
  void operator()(const FieldInfo& info, T& value) {
    if constexpr (Described<T>) {
      Description<T>::visit(value, *this);
    } else {
      unsigned char* last = reinterpret_cast<unsigned char*>(&value);
      *last ^= 1;
      expect_found(info);
      *last ^= 1;
    }
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, T (&values)[N]) {
    (*this)(info, values[N - 1]);
  }
  template <std::size_t N>
  void operator()(const FieldInfo& info, char (&text)[N]) {
    text[0] = static_cast<char>(text[0] ^ 0x40);
    expect_found(info);
    text[0] = static_cast<char>(text[0] ^ 0x40);
  }
  void operator()(const FieldInfo& info, dds_sequence_octet& octets) {
    octets._length -= 1;
    expect_found(info);
    octets._length += 1;
    octets._buffer[0] ^= 1;
    expect_found(info);
    octets._buffer[0] ^= 1;
  }
  void expect_found(const FieldInfo& info) {
    ++*flips;
    const auto difference = first_difference(a, b);
    ASSERT_TRUE(difference) << Description<Message>::kName << "." << info.name;
    EXPECT_NE(difference->path.find(info.name), std::string::npos) << difference->path;
    EXPECT_NE(difference->a, difference->b) << difference->path;
  }
};

TEST(FirstDifference, IsFoundInEachFieldOfEachType) {
  int flips = 0;
  for_each_type(AllMessages{}, [&]<class T>() {
    std::uint64_t seed = 11;
    RandomFiller fill(seed);
    T message{};
    Description<T>::visit(message, fill);
    reflect::OctetsFinder finder;
    Description<T>::visit(message, finder);
    static std::uint8_t some[4] = {1, 2, 3, 4};
    if (finder.found) *finder.found = {4, 4, some, false};
    auto twin = share_copy(message);
    T changed = *twin;  // its sequence points into `twin`
    Description<T>::visit(changed, Flipper<T>{message, changed, &flips});
  });
  EXPECT_GT(flips, 300);
}

TEST(FirstDifference, ComparesNumbersBitByBit) {
  msg::Pose3 a{};
  msg::Pose3 b{};
  a.position_m.y = b.position_m.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(first_difference(a, b));
  b.orientation.z = -0.0;
  const auto difference = first_difference(a, b);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->path, "orientation.z");
  EXPECT_EQ(difference->b, "-0");
  msg::ContactState c{};
  msg::ContactState d{};
  d.contacts[5].force_n.x = std::nextafter(0.1, 1.0);
  c.contacts[5].force_n.x = 0.1;
  const auto ulp = first_difference(c, d);
  ASSERT_TRUE(ulp);
  EXPECT_EQ(ulp->path, "contacts[5].force_n.x");
  EXPECT_EQ(ulp->a, "0.10000000000000001");
  EXPECT_EQ(ulp->b, "0.10000000000000002");
}

}  // namespace
}  // namespace constrictor
