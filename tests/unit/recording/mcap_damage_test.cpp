// Files that are cut, changed or of another kind: the reader refuses them with a reason, or returns a beginning of what
// was written; it never crashes and never invents a message.
#include <set>
#include <string>

#include "mcap_fixture.hpp"
#include "recording/recovery.hpp"

namespace constrictor::mcap {
namespace {

bool is_beginning(const std::vector<Line>& part, const std::vector<Line>& all) {
  return part.size() <= all.size() && std::equal(part.begin(), part.end(), all.begin());
}

/// The messages of a file that need not be complete, and the reason if it was refused.
std::pair<std::vector<Line>, std::string> read_any(const std::filesystem::path& path) {
  std::vector<Line> lines;
  Visitor visitor;
  visitor.message = [&](const Channel& channel, const Message& message) {
    lines.push_back({channel.topic, message.sequence, message.log_time, std::string(text_of(message.data))});
  };
  try {
    Reader reader(path);
    reader.read(visitor);
  } catch (const Error& error) {
    return {lines, error.what()};
  }
  return {lines, ""};
}

TEST_F(McapFile, ReadsAFileThatIsCutAnywhereUpToItsLastCompleteChunk) {
  const auto written = write(file(), 40);
  const std::string content = content_of(file());
  Reader whole(file());
  whole.read();
  for (std::size_t length = 0; length < content.size(); ++length) {
    store(file("cut"), std::string_view(content).substr(0, length));
    const auto [lines, refused] = read_any(file("cut"));
    ASSERT_TRUE(is_beginning(lines, written)) << length;
    std::size_t expected = 0;
    for (const auto& chunk : whole.contents().chunks) expected += chunk.offset + chunk.length <= length ? 7 : 0;
    ASSERT_EQ(lines.size(), std::min<std::size_t>(expected, 40)) << length;
    // Only the first bytes, without which this is no MCAP file, are refused.
    EXPECT_EQ(refused.empty(), length >= whole.contents().attachments[0].offset) << length << ": " << refused;
  }
}

TEST_F(McapFile, ACutFileIsRecovered) {
  const auto written = write(file(), 40);
  const std::string content = content_of(file());
  std::mt19937 random(11);
  for (int i = 0; i < 60; ++i) {
    const std::size_t length = 100 + random() % (content.size() - 100);
    store(file("cut"), std::string_view(content).substr(0, length));
    const auto before = read_any(file("cut")).first;
    Reader reader(file("cut"));
    reader.read();
    Writer(reader).finish();
    Reader recovered(file("cut"));
    ASSERT_EQ(lines_of(recovered), before) << length;
    ASSERT_EQ(recovered.incomplete(), "") << length;
  }
}

TEST_F(McapFile, ADamagedChunkCostsItsOwnMessagesOnly) {
  const auto written = write(file(), 42);
  const std::string content = content_of(file());
  Reader whole(file());
  whole.read();
  const auto& chunks = whole.contents().chunks;
  ASSERT_EQ(chunks.size(), 6u);
  for (std::size_t n = 0; n < chunks.size(); ++n) {
    std::string changed = content;
    changed[chunks[n].offset + chunks[n].length - 3] ^= 0x40;  // within the compressed messages
    store(file("changed"), changed);
    const Recovered recovered = copy_undamaged(file("changed"), file("recovered"));
    auto expected = written;
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(7 * n),
                   expected.begin() + static_cast<std::ptrdiff_t>(7 * n + 7));
    Reader reader(file("recovered"));
    // The first chunk defines the channels. They are also in the summary.
    EXPECT_EQ(lines_of(reader), expected) << n;
    EXPECT_EQ(recovered.messages, 35u);
    EXPECT_EQ(reader.incomplete(), "");
    EXPECT_EQ(reader.contents().attachments.size(), 1u);
    EXPECT_GE(recovered.places, 1u);
    EXPECT_NE(recovered.why.find("damaged at byte " + std::to_string(chunks[n].offset)), std::string::npos)
        << recovered.why;
    EXPECT_EQ(content_of(file("changed")), changed) << "the damaged file must not be touched";
  }
}

TEST_F(McapFile, ADamagedSummaryCostsNoMessage) {
  const auto written = write(file(), 40);
  const std::string content = content_of(file());
  Reader whole(file());
  whole.read();
  // Every definition stands in the data section, too. The last of each topic's names is that of the summary.
  std::set<std::string> topics;
  for (const Line& line : written) topics.insert(line.topic);
  for (const std::string& topic : topics) {
    std::string damaged = content;
    const std::size_t at = damaged.rfind(topic);
    ASSERT_GT(at, whole.contents().chunks.back().offset) << topic;
    damaged[at] ^= 1;
    store(file("damaged"), damaged);
    const Recovered recovered = copy_undamaged(file("damaged"), file("copy"));
    EXPECT_EQ(recovered.messages, written.size()) << topic;
    Reader copy(file("copy"));
    EXPECT_EQ(lines_of(copy), written) << topic;
  }
}

TEST_F(McapFile, WhatAVisitorCannotWriteIsNoDamageOfTheFileThatItReads) {
  write(file(), 42);
  Reader reader(file());
  Visitor visitor;
  visitor.message = [](const Channel&, const Message&) { throw DiskFull("no space"); };
  try {
    reader.read(visitor);
    FAIL();
  } catch (const DiskFull& error) {
    EXPECT_STREQ(error.what(), "no space");
  }
}

TEST_F(McapFile, ADiskThatIsNearlyFullCountsAsFull) {
  Writer writer(file(), "", "test");
  const std::uint16_t one = writer.add_channel(0, "one", "cdr");
  writer.write({one, 1, 1, 1, bytes_of("before")});
  writer.close_chunk();
  writer.leave_free(std::uint64_t{1} << 60);
  writer.write({one, 2, 2, 2, bytes_of("after")});
  try {
    writer.close_chunk();
    FAIL();
  } catch (const DiskFull& error) {
    double found = 0, accepted = 0;
    const std::string text = error.what();
    ASSERT_EQ(std::sscanf(text.substr(text.find("found")).c_str(), "found %lf MB free, accepted at least %lf", &found,
                          &accepted),
              2)
        << text;
    EXPECT_LT(found, accepted) << text;
  }
  writer.finish({{"dropped", {{"reason", "test"}}}});
  Reader reader(file());
  EXPECT_EQ(lines_of(reader).size(), 1u);
  EXPECT_EQ(reader.incomplete(), "");
}

TEST_F(McapFile, RefusesOrReadsCorrectlyWhateverByteIsChanged) {
  const auto written = write(file(), 40);
  const std::string content = content_of(file());
  std::mt19937 random(5);
  int refusals = 0;
  for (int i = 0; i < 4'000; ++i) {
    std::string changed = content;
    for (unsigned n = 0; n <= random() % 3; ++n) changed[random() % changed.size()] = static_cast<char>(random());
    if (random() % 8 == 0) changed.insert(random() % changed.size(), std::string(random() % 9, '\xff'));
    store(file("changed"), changed);
    const auto [lines, refused] = read_any(file("changed"));
    refusals += refused.empty() ? 0 : 1;
    // Every message is within a chunk with a checksum.
    ASSERT_TRUE(is_beginning(lines, written)) << "mutation " << i;
    ASSERT_TRUE(refused.empty() || refused.find("changed") != std::string::npos) << refused;
  }
  EXPECT_GT(refusals, 2'000);
}

TEST_F(McapFile, RefusesAbsurdLengthsWithoutAskingForTheirMemory) {
  std::string header(kMagic);
  append_record(header, Op::kHeader, std::string(8, '\0'));
  const auto refusal = [&](Op op, std::string_view content) {
    std::string bytes = header;
    append_record(bytes, op, content);
    store(file("absurd"), bytes);
    return read_any(file("absurd")).second;
  };
  std::string chunk;
  Encoder encoder(chunk);
  encoder.number(std::uint64_t{0});
  encoder.number(std::uint64_t{0});
  encoder.number(std::uint64_t{1} << 60);  // uncompressed size
  encoder.number(std::uint32_t{0});
  encoder.text("zstd");
  encoder.number(std::uint64_t{0});
  EXPECT_NE(refusal(Op::kChunk, chunk).find("accepted at most 268435456"), std::string::npos);
  EXPECT_NE(refusal(Op::kSchema, "\x01").find("ends 1 bytes too early"), std::string::npos);
  EXPECT_NE(refusal(Op::kChannel, std::string("\x01\0\x05\0\0\0\0\0\0\0\0\0\0\0\0\0", 16)).find("schema 5"),
            std::string::npos);
  EXPECT_NE(refusal(Op::kMessage, std::string(22, '\x07')).find("channel 1799"), std::string::npos);
  EXPECT_NE(refusal(Op{0x42}, "").find("0x42"), std::string::npos);
}

TEST_F(McapFile, RefusesFilesOfOtherKinds) {
  store(file("hashes.bin"), "CNSTHLG2 and more bytes than a header has");
  store(file("empty"), "");
  EXPECT_NE(read_any(file("hashes.bin")).second.find("is not an MCAP file"), std::string::npos);
  EXPECT_NE(read_any(file("empty")).second.find("is empty"), std::string::npos);
  EXPECT_NE(read_any(file("missing")).second.find("No such file"), std::string::npos);
  EXPECT_NE(read_any(folder_.path()).second, "");
}

}  // namespace
}  // namespace constrictor::mcap
