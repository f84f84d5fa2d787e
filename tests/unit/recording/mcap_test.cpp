// MCAP files: what is written is read, a file is continued where it ended, a full disk leaves a complete file.
#include <fcntl.h>
#include <sys/stat.h>

#include "mcap_fixture.hpp"
#include "support/small_disk.hpp"

namespace constrictor::mcap {
namespace {

TEST_F(McapFile, ReturnsWhatWasWritten) {
  const auto written = write(file(), 100);
  Reader reader(file());
  std::vector<Attachment> attachments;
  std::vector<Metadata> metadata;
  std::vector<Line> read;
  Visitor visitor;
  visitor.message = [&](const Channel& channel, const Message& message) {
    read.push_back({channel.topic, message.sequence, message.log_time, std::string(text_of(message.data))});
  };
  visitor.attachment = [&](const Attachment& one) { attachments.push_back(one); };
  visitor.metadata = [&](const Metadata& one) { metadata.push_back(one); };
  reader.read(visitor);
  EXPECT_EQ(read, written);
  EXPECT_EQ(reader.incomplete(), "");
  ASSERT_EQ(attachments.size(), 1u);
  EXPECT_EQ(attachments[0].name, "scenario.yaml");
  EXPECT_EQ(attachments[0].data, "seed: 1\n");
  ASSERT_EQ(metadata.size(), 1u);
  EXPECT_EQ(metadata[0].entries.at("reason"), "test");
  EXPECT_EQ(reader.contents().chunks.size(), 15u);  // 14 of seven messages, one of two
  EXPECT_EQ(reader.contents().statistics.message_count, 100u);
  for (const auto& [id, channel] : reader.contents().channels) {
    const Schema* schema = reader.schema_of(channel);
    EXPECT_EQ(schema != nullptr, channel.topic == "one");
    EXPECT_EQ(schema ? schema->data : "none", channel.topic == "one" ? "uint32 value\n" : "none");
  }
}

TEST_F(McapFile, IsReadableByItsOwnerOnly) {
  write(file(), 1);
  struct stat status {};
  ASSERT_EQ(::stat(file().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u);  // commands carry the run's token
}

TEST_F(McapFile, HasOneWriterAtATime) {
  const Writer writer(file(), "", "test");
  Reader reader(file());
  reader.read();
  const auto refusal = [](const std::function<void()>& open) {
    try {
      open();
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal([&] { Writer second(reader); }).find("another process is writing it"), std::string::npos);
  EXPECT_NE(refusal([&] { Writer second(file(), "", ""); }).find("another process is writing it"), std::string::npos);
  EXPECT_GT(content_of(file()).size(), kMagic.size()) << "it was not emptied";
}

TEST_F(McapFile, ClosesAChunkThatIsLargeEnough) {
  Writer writer(file(), "", "test");
  const std::uint16_t channel = writer.add_channel(0, "bytes", "cdr");
  const std::string data(Writer::kChunkSize / 4, 'x');
  for (std::uint32_t i = 0; i < 4; ++i) writer.write({channel, i, i, i, bytes_of(data)});
  EXPECT_EQ(writer.chunks(), 1u);
  EXPECT_TRUE(writer.open_chunk().empty());
  EXPECT_EQ(lines_of(file()).size(), 4u);  // without any end
}

TEST_F(McapFile, ContinuesAfterItsLastChunk) {
  const auto first = write(file(), 30, false);
  Reader reader(file());
  reader.read();
  EXPECT_NE(reader.incomplete(), "");
  Writer writer(reader);
  const std::uint16_t schema = writer.add_schema("test/msg/Number", "ros2msg", "uint32 value\n");
  EXPECT_EQ(writer.add_channel(schema, "one", "cdr", {{"writer", "physics"}}), 1u);  // the one that it had
  writer.write({1, 77, 9'999, 9'999, bytes_of("more")});
  writer.finish();
  auto expected = first;
  expected.push_back({"one", 77, 9'999, "more"});
  Reader again(file());
  EXPECT_EQ(lines_of(again), expected);
  EXPECT_EQ(again.incomplete(), "");
}

TEST_F(McapFile, ContinuesWithTheOpenChunkOfItsPredecessor) {
  std::string open;
  {
    Writer writer(file(), "", "test");
    const std::uint16_t channel = writer.add_channel(writer.add_schema("S", "ros2msg", ""), "one", "cdr");
    writer.write({channel, 1, 10, 10, bytes_of("a")});
    writer.close_chunk();
    writer.write({channel, 2, 20, 20, bytes_of("b")});
    const std::uint16_t other = writer.add_channel(0, "two", "cdr");
    writer.write({other, 1, 20, 20, bytes_of("c")});
    open = writer.open_chunk();
  }
  Reader reader(file());
  reader.read();
  Writer writer(reader);
  writer.restore(open);
  writer.write({writer.add_channel(0, "two", "cdr"), 2, 30, 30, bytes_of("d")});
  writer.finish();
  EXPECT_EQ(lines_of(file()),
            (std::vector<Line>{{"one", 1, 10, "a"}, {"one", 2, 20, "b"}, {"two", 1, 20, "c"}, {"two", 2, 30, "d"}}));
  EXPECT_THROW(writer.write({1, 1, 1, 1, {}}), Error);
}

TEST_F(McapFile, RepairsTheIndexesOfTheLastChunk) {
  const auto written = write(file(), 14, false);
  Reader whole(file());
  whole.read();
  const ChunkIndex last = whole.contents().chunks.back();
  ASSERT_EQ(last.message_index_offsets.size(), 2u);
  // The writer was killed after the first of the two indexes.
  std::filesystem::resize_file(file(), std::max(last.message_index_offsets.at(1), last.message_index_offsets.at(2)));
  Reader reader(file());
  EXPECT_EQ(lines_of(reader), written);
  EXPECT_FALSE(reader.missing_indexes().empty());
  Writer(reader).finish();
  Reader again(file());
  EXPECT_EQ(lines_of(again), written);
  EXPECT_EQ(again.incomplete(), "");
  EXPECT_EQ(again.contents().chunks.back().message_index_offsets, last.message_index_offsets);
}

TEST_F(McapFile, IsCompleteUpToTheFullDisk) {
  std::mt19937 random(3);
  std::vector<Line> written;
  {
    Writer writer(file(), "", "test");
    const std::uint16_t channel = writer.add_channel(0, "noise", "cdr");
    const auto add = [&] {
      std::string data(1'000, '\0');
      for (char& byte : data) byte = static_cast<char>(random());
      writer.write({channel, static_cast<std::uint32_t>(written.size()), written.size(), 0, bytes_of(data)});
      written.push_back({"noise", static_cast<std::uint32_t>(written.size()), written.size(), data});
    };
    for (int i = 0; i < 50; ++i) add();
    writer.close_chunk();
    const testing::SmallDisk disk(writer.size() + Writer::kReserve + 30'000);
    for (int i = 0; i < 50; ++i) add();
    EXPECT_THROW(writer.close_chunk(), DiskFull);
    written.resize(50);
    writer.finish({{"dropped", {{"tick", "50"}}}});
  }
  Reader reader(file());
  EXPECT_EQ(lines_of(reader), written);
  EXPECT_EQ(reader.incomplete(), "");
  ASSERT_EQ(reader.contents().metadata.size(), 1u);
  EXPECT_EQ(reader.contents().metadata[0].name, "dropped");
}

}  // namespace
}  // namespace constrictor::mcap
