// Values in bytes and back, compared with cereal's own archive.
#include "constrictor/archive.hpp"

#include <gtest/gtest.h>

#include <cereal/archives/portable_binary.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/deque.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cmath>
#include <sstream>

namespace constrictor {
namespace {

struct Inner {
  std::int16_t number = 0;
  std::string text;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cereal::make_nvp("number", number), text);
  }
  bool operator==(const Inner&) const = default;
};

struct Everything {
  bool flag = false;
  std::uint8_t small = 0;
  std::int64_t large = 0;
  double real = 0.0;
  std::array<float, 3> reals{};
  std::vector<double> numbers;
  std::vector<bool> flags;
  std::deque<Inner> structs;
  std::map<std::string, int> table;
  std::optional<std::string> maybe;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(flag, small, large, real, reals, numbers, flags, structs, table, maybe);
  }
  bool operator==(const Everything&) const = default;
};

Everything example() {
  return {true,
          200,
          -1234567890123456789,
          std::nextafter(0.1, 1.0),
          {1.5F, -0.0F, 3e-40F},
          {0.0, 1e300, -7.25},
          {true, false, true},
          {{-3, "three"}, {4, std::string("\0zero", 5)}},
          {{"one", 1}, {"two", 2}},
          "there"};
}

TEST(Archive, HasTheBytesOfCerealsPortableArchive) {
  std::ostringstream stream;
  {
    cereal::PortableBinaryOutputArchive archive(stream);
    archive(example(), std::string("more"));
  }
  // The portable archive begins with one byte, which tells the order of bytes.
  EXPECT_EQ(save_bytes(example(), std::string("more")), stream.str().substr(1));
}

TEST(Archive, GivesTheValuesBack) {
  Everything found;
  int after = 0;
  load_bytes(save_bytes(example(), 42), found, after);
  EXPECT_EQ(found, example());
  EXPECT_EQ(after, 42);
}

TEST(Archive, RefusesBytesThatEndTooEarly) {
  const std::string bytes = save_bytes(example());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Everything found;
    EXPECT_THROW(load_bytes(std::string_view(bytes).substr(0, size), found), cereal::Exception) << size;
  }
}

}  // namespace
}  // namespace constrictor
