// `constrictor foxglove`: the copy has everything that the recording has, and what viewers draw.
#include <csignal>

#include "integration/pictures_fixture.hpp"
#include "recording/mcap_reader.hpp"
#include "views/view_topics.hpp"

namespace constrictor::testing {
namespace {

/// All messages of a recording, as topic, time and bytes, without those for viewers; and the number of these by topic.
struct Content {
  explicit Content(const fs::path& file) {
    mcap::Reader reader(file);
    mcap::Visitor visitor;
    visitor.message = [&](const mcap::Channel& channel, const mcap::Message& message) {
      if (channel.topic.starts_with("view/")) ++views[channel.topic];
      else
        messages.emplace_back(channel.topic, message.log_time,
                              std::string(reinterpret_cast<const char*>(message.data.data()), message.data.size()));
    };
    visitor.attachment = [&](const mcap::Attachment& one) { attachments[one.name] = one.data; };
    reader.read(visitor);
    incomplete = reader.incomplete();
  }
  std::vector<std::tuple<std::string, std::uint64_t, std::string>> messages;
  std::map<std::string, int> views;
  std::map<std::string, std::string> attachments;
  std::string incomplete;
};

TEST_F(Pictures, TheCopyForFoxgloveHasAllMessagesAndTheViews) {
  ASSERT_EQ(command({"foxglove", run("on").string(), "-o", out("seen.mcap")}), exit_status::kOk) << output_;
  EXPECT_TRUE(says("wrote " + out("seen.mcap"))) << output_;
  const Content before(run("on") / "run.mcap"), copy(out("seen.mcap"));
  EXPECT_GT(before.messages.size(), 500u);
  EXPECT_EQ(copy.messages, before.messages);
  EXPECT_EQ(copy.attachments, before.attachments);
  EXPECT_EQ(copy.incomplete, "");
  std::map<std::string, int> images;
  for (const auto& [topic, time, bytes] : before.messages) ++images[topic];
  for (const auto& view : views::kViewTopics) EXPECT_GT(copy.views.at(view.topic), 0) << view.topic;
  EXPECT_EQ(copy.views.at("view/camera"), images.at("camera/image"));
  EXPECT_EQ(copy.views.at("view/processed"), images.at("perception/image"));
  EXPECT_NEAR(copy.views.at("view/scene"), 0.8 * 17, 2) << "each third tick";

  ASSERT_EQ(command({"info", out("seen.mcap")}), exit_status::kOk) << output_;
  EXPECT_TRUE(says("foxglove.SceneUpdate")) << "the type of a view is that of its schema: " << output_;

  // A copy is a recording: it is replayed, drawn, and copied again without having its views twice.
  EXPECT_EQ(command({"replay", out("seen.mcap"), "--component", "perception"}, 60s), exit_status::kOk) << output_;
  EXPECT_EQ(command({"figure", out("seen.mcap"), "--at", "0.5", "-o", out("f.png")}, 60s), exit_status::kOk) << output_;
  ASSERT_EQ(command({"foxglove", out("seen.mcap"), "-o", out("again.mcap")}), exit_status::kOk) << output_;
  EXPECT_EQ(Content(out("again.mcap")).views, copy.views);
}

TEST_F(Pictures, TheCopyForFoxgloveSaysWhyItHasNoImagesAndRefusesWrongFiles) {
  ASSERT_EQ(command({"foxglove", run("off").string(), "-o", out("seen.mcap")}), exit_status::kOk) << output_;
  EXPECT_TRUE(says("has no camera images")) << output_;
  const std::string recording = (run("on") / "run.mcap").string();
  EXPECT_EQ(command({"foxglove", recording, "-o", recording}), exit_status::kUsage);
  EXPECT_TRUE(says("the recording itself")) << output_;
  EXPECT_EQ(command({"foxglove", recording, "-o", dir_.string()}), exit_status::kUsage);
  EXPECT_TRUE(says("a folder")) << output_;
  write("mine.mcap", "another recording");
  EXPECT_EQ(command({"foxglove", recording, "-o", out("mine.mcap")}), exit_status::kUsage);
  EXPECT_TRUE(says("--output: found " + out("mine.mcap") + ", which exists, accepted a new file (or --force)"))
      << output_;
  EXPECT_EQ(content("mine.mcap"), "another recording");
  EXPECT_EQ(command({"foxglove", recording, "-o", out("mine.mcap"), "--force"}), exit_status::kOk) << output_;
  EXPECT_EQ(Content(out("mine.mcap")).incomplete, "");
  EXPECT_EQ(command({"foxglove", dir_.string()}), exit_status::kUsage);
  EXPECT_TRUE(says("which has no run.mcap")) << output_;
  write("text.mcap", "no recording");
  EXPECT_EQ(command({"foxglove", out("text.mcap"), "-o", out("none.mcap")}), exit_status::kSoftware) << output_;
  EXPECT_EQ(command({"foxglove", recording, "-o", out("no_folder/seen.mcap")}), exit_status::kSoftware) << output_;
  EXPECT_FALSE(fs::exists(out("none.mcap")));
  EXPECT_EQ(unfinished().size(), 0u);
}

}  // namespace
}  // namespace constrictor::testing
