// Our CDR of messages is that of Cyclone DDS, for each type and in both directions; damaged bytes are refused.
#include <dds/ddsi/ddsi_serdata.h>
#include <gtest/gtest.h>

#include <set>

#include "constrictor/compare.hpp"
#include "constrictor/descriptors.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/type_tree.hpp"
#include "recording/message_cdr.hpp"
#include "unit/idl/random_message.hpp"

namespace constrictor::mcap {
namespace {

class MessageCdr : public ::testing::Test {
 protected:
  /// Sends messages of one type to itself, and returns the bytes that Cyclone DDS makes of them.
  template <class T>
  class Cyclone {
   public:
    explicit Cyclone(dds_entity_t participant)
        : topic_(dds_create_topic(participant, &dds::descriptor<T>(), Description<T>::kName, nullptr, nullptr),
                 "dds_create_topic"),
          reader_(dds_create_reader(participant, topic_.get(), nullptr, nullptr), "dds_create_reader"),
          writer_(dds_create_writer(participant, topic_.get(), nullptr, nullptr), "dds_create_writer") {}
    std::string bytes_of(const T& message) const {
      dds::check(dds_write(writer_.get(), &message), "dds_write");
      ddsi_serdata* data = nullptr;
      dds_sample_info_t info{};
      if (dds_takecdr(reader_.get(), &data, 1, &info, DDS_ANY_STATE) != 1) return "nothing received";
      std::string bytes(ddsi_serdata_size(data), '\0');
      ddsi_serdata_to_ser(data, 0, bytes.size(), bytes.data());
      ddsi_serdata_unref(data);
      return bytes;
    }

   private:
    dds::Entity topic_, reader_, writer_;
  };
  /// Calls use.operator()<T>() once for each type of the table of topics.
  template <class Use>
  static void for_each_topic_type(Use&& use) {
    std::set<std::string_view> seen;
    const auto once = [&]<class T>() {
      if (seen.insert(Description<T>::kName).second) use.template operator()<T>();
    };
#define CONSTRICTOR_MEMBER_TOPIC(constant, Type, ...) once.template operator()<msg::Type>();
#define CONSTRICTOR_UNCOUNTED_TOPIC(constant, Type, ...) once.template operator()<msg::Type>();
#include "constrictor/topic_table.def"
#undef CONSTRICTOR_MEMBER_TOPIC
#undef CONSTRICTOR_UNCOUNTED_TOPIC
    EXPECT_GT(seen.size(), 30u);
  }

  const DomainClaim claim_;
  const dds::Domain domain_{claim_.domain()};
};

TEST_F(MessageCdr, IsThatOfCyclone) {
  for_each_topic_type([&]<class T>() {
    const Cyclone<T> cyclone(domain_.participant());
    testing::RandomFiller filler(17);
    for (int i = 0; i < 50; ++i) {
      T message{};
      Description<T>::visit(message, filler);
      const std::string expected = cyclone.bytes_of(message);
      ASSERT_EQ(cdr_of(message), expected) << Description<T>::kName;

      const auto header = find_codec(Description<T>::kName)->header(mcap::bytes_of(expected));
      if constexpr (requires { message.header; }) {
        ASSERT_TRUE(header) << Description<T>::kName;
        EXPECT_FALSE(first_difference(*header, message.header)) << Description<T>::kName;
      } else {
        EXPECT_FALSE(header) << Description<T>::kName;
      }

      std::string canonical;
      canonical_bytes(message, canonical);
      const auto back = message_of<T>(mcap::bytes_of(expected));
      ASSERT_TRUE(back) << Description<T>::kName;
      std::string returned;
      canonical_bytes(*back, returned);
      ASSERT_EQ(returned, canonical) << Description<T>::kName;
    }
  });
}

TEST_F(MessageCdr, HasTheSchemaThatTheDescriptionOfTheTypeGives) {
  for_each_topic_type([&]<class T>() {
    const auto tree = dds::TypeTree::known(domain_.participant(), dds::descriptor<T>().m_typename);
    ASSERT_TRUE(tree);
    const dds::Ros2Schema expected = tree->ros2_schema();
    EXPECT_EQ(schema_name(Description<T>::kName), expected.name);
    EXPECT_EQ(find_codec(Description<T>::kName)->schema(), expected.text);
  });
}

TEST_F(MessageCdr, RefusesBytesThatAreNotOneMessage) {
  for_each_topic_type([&]<class T>() {
    testing::RandomFiller filler(23);
    T message{};
    Description<T>::visit(message, filler);
    const std::string cdr = cdr_of(message);
    const MessageCodec& codec = *find_codec(Description<T>::kName);
    std::string unused;
    const std::size_t padding = static_cast<unsigned char>(cdr[3]);
    for (std::size_t length = 0; length < cdr.size() - padding; length += 1 + cdr.size() / 64)
      EXPECT_FALSE(codec.from_cdr(mcap::bytes_of(std::string_view(cdr).substr(0, length)), unused));
    EXPECT_FALSE(codec.from_cdr(mcap::bytes_of(cdr + "1234"), unused)) << Description<T>::kName;
    std::string big_endian = cdr;
    big_endian[1] = 0;
    EXPECT_FALSE(codec.from_cdr(mcap::bytes_of(big_endian), unused));
    // Whatever the bytes are: refused, or a message that has them.
    std::mt19937_64 random(1);
    for (int i = 0; i < 200; ++i) {
      std::string changed = cdr;
      for (int n = 0; n < 3; ++n) changed[4 + random() % (changed.size() - 4)] = static_cast<char>(random());
      std::string canonical;
      if (!codec.from_cdr(mcap::bytes_of(changed), canonical)) continue;
      std::string again;
      EXPECT_TRUE(codec.to_cdr(mcap::bytes_of(canonical), again)) << Description<T>::kName;
    }
    EXPECT_FALSE(codec.to_cdr({}, unused));
  });
  EXPECT_EQ(find_codec("Nothing"), nullptr);
}

}  // namespace
}  // namespace constrictor::mcap
