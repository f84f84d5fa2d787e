// A small MCAP file with messages of two channels in several chunks, an attachment and metadata.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "recording/mcap_reader.hpp"
#include "recording/mcap_writer.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::mcap {

/// One message as it was written, with copies of everything.
struct Line {
  std::string topic;
  std::uint32_t sequence = 0;
  std::uint64_t time = 0;
  std::string data;
  bool operator==(const Line&) const = default;
};

class McapFile : public ::testing::Test {
 protected:
  /// Writes `count` messages, a chunk after every seventh, and finishes the file if `finish` is set.
  std::vector<Line> write(const std::filesystem::path& path, int count, bool finish = true) const {
    std::mt19937 random(7);
    std::vector<Line> lines;
    Writer writer(path, "", "test");
    writer.attach({5, "scenario.yaml", "application/yaml", "seed: 1\n"});
    const std::uint16_t schema = writer.add_schema("test/msg/Number", "ros2msg", "uint32 value\n");
    const std::uint16_t one = writer.add_channel(schema, "one", "cdr", {{"writer", "physics"}});
    const std::uint16_t two = writer.add_channel(0, "two", "cdr");
    for (int i = 0; i < count; ++i) {
      Line line{random() % 3 == 0 ? "two" : "one", static_cast<std::uint32_t>(i), 1'000u + random() % 5'000u,
                std::string(random() % 200, static_cast<char>('a' + random() % 26))};
      writer.write({line.topic == "one" ? one : two, line.sequence, line.time, line.time, bytes_of(line.data)});
      lines.push_back(std::move(line));
      if (i % 7 == 6) writer.close_chunk();
    }
    writer.add_metadata({"end", {{"reason", "test"}}});
    if (finish) writer.finish();
    else writer.close_chunk();
    return lines;
  }
  /// Reads a file as `reader` does and returns its messages.
  static std::vector<Line> lines_of(Reader& reader) {
    std::vector<Line> lines;
    Visitor visitor;
    visitor.message = [&](const Channel& channel, const Message& message) {
      lines.push_back({channel.topic, message.sequence, message.log_time, std::string(text_of(message.data))});
    };
    reader.read(visitor);
    return lines;
  }
  static std::vector<Line> lines_of(const std::filesystem::path& path) {
    Reader reader(path);
    return lines_of(reader);
  }
  static std::string content_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void store(const std::filesystem::path& path, std::string_view content) {
    std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
  }
  [[nodiscard]] std::filesystem::path file(const std::string& name = "a.mcap") const { return folder_.path() / name; }

  const testing::TemporaryFolder folder_;
};

}  // namespace constrictor::mcap
