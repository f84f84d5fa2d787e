// Files of our writer in the official reader, and messages of every type in the decoder of Foxglove's viewers.
#include "constrictor/json.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/type_tree.hpp"
#include "mcap_fixture.hpp"
#include "node/reader.hpp"
#include "recording/message_cdr.hpp"
#include "unit/idl/random_message.hpp"

namespace constrictor::mcap {
namespace {

using Json = nlohmann::json;

std::string lower(std::string name) {
  for (char& character : name) character = static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
  return name;
}

/// What a schema cannot express: arrays have one dimension, and names are in lower case.
Json flat(const Json& value) {
  if (value.is_object()) {
    Json object = Json::object();
    for (const auto& [name, field] : value.items()) object[lower(name)] = flat(field);
    return object;
  }
  if (!value.is_array()) return value;
  Json list = Json::array();
  for (const auto& one : value) {
    const Json part = flat(one);
    if (part.is_array()) list.insert(list.end(), part.begin(), part.end());
    else list.push_back(part);
  }
  return list;
}

TEST_F(McapFile, IsReadByTheOfficialReader) {
  const testing::OfficialReader official(testing::source_path("tests/unit/recording/node"), testing::build_path());
  const DomainClaim claim;
  const dds::Domain domain(claim.domain());
  std::map<std::string, std::vector<Json>> expected;
  {
    Writer writer(file(), "", "test");
    writer.attach({1, "scenario.yaml", "application/yaml", "text: ä\n"});
    const auto add = [&]<class T>(const std::string& topic) {
      const auto tree =
          dds::TypeTree::known(domain.participant(), "constrictor::msg::" + std::string(Description<T>::kName));
      ASSERT_TRUE(tree);
      const auto schema = tree->ros2_schema();
      ASSERT_EQ(schema.why_not, "");
      const auto channel = writer.add_channel(writer.add_schema(schema.name, "ros2msg", schema.text), topic, "cdr");
      testing::RandomFiller filler(topic.size());
      for (std::uint32_t i = 1; i <= 20; ++i) {
        T message{};
        Description<T>::visit(message, filler);
        const std::string cdr = cdr_of(message);
        writer.write({channel, i, i, i, bytes_of(cdr)});
        expected[topic].push_back(flat(Json::parse(tree->decode(bytes_of(cdr)).dump())));
        if (i % 9 == 0) writer.close_chunk();
      }
    };
#define CONSTRICTOR_MEMBER_TOPIC(constant, Type, name, ...) add.template operator()<msg::Type>(name);
#define CONSTRICTOR_UNCOUNTED_TOPIC(constant, Type, name, ...) add.template operator()<msg::Type>(name);
#include "constrictor/topic_table.def"
#include "support/project.hpp"
#undef CONSTRICTOR_MEMBER_TOPIC
#undef CONSTRICTOR_UNCOUNTED_TOPIC
    writer.add_metadata({"end", {{"reason", "over"}}});
    writer.finish();
  }
  auto lines = official.read(file());
  ASSERT_FALSE(lines.empty());
  const Json summary = lines.back();
  lines.pop_back();
  EXPECT_EQ(summary["attachments"]["scenario.yaml"], "text: ä\n");
  EXPECT_EQ(summary["metadata"]["end"]["reason"], "over");
  EXPECT_EQ(summary["statistics"]["messages"], 20 * expected.size());
  std::size_t compared = 0;
  for (const auto& line : lines) {
    const Json& mine = expected[line["topic"]].at(line["sequence"].get<std::size_t>() - 1);
    // JavaScript has no 64-bit integers: both are compared as floating-point numbers.
    const auto rounded = [](const Json& value) {
      Json numbers = value.flatten();
      for (Json& one : numbers) {
        if (one.is_number()) one = one.get<double>();
      }
      return numbers;
    };
    ASSERT_EQ(rounded(line["message"]), rounded(mine)) << line["topic"];
    ++compared;
  }
  EXPECT_EQ(compared, 20 * expected.size());
}

TEST_F(McapFile, AnUnfinishedFileIsReadByTheOfficialReader) {
  const testing::OfficialReader official(testing::source_path("tests/unit/recording/node"), testing::build_path());
  {
    Writer writer(file(), "", "test");
    const std::uint16_t channel = writer.add_channel(0, "bytes", "cdr");
    for (std::uint32_t i = 1; i <= 40; ++i) {
      writer.write({channel, i, i, i, bytes_of("some bytes")});
      if (i % 7 == 0) writer.close_chunk();
    }
  }
  Reader reader(file());
  reader.read();
  const auto& last = reader.contents().chunks.back();
  std::filesystem::resize_file(file(), last.offset + last.length / 2);  // its writer was killed in the last chunk
  const auto streamed = official.read(file(), true);
  EXPECT_EQ(streamed.back()["counts"]["bytes"], 28);
  Reader cut(file());
  cut.read();
  Writer(cut).finish();
  EXPECT_EQ(official.read(file()).back()["counts"]["bytes"], 28);
}

}  // namespace
}  // namespace constrictor::mcap
