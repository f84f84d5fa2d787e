// The messages between launcher and agent.
#include "cli/remote/message_channel.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

#include "cli/remote/dds_configuration.hpp"

namespace constrictor::cli {
namespace {

class Channels : public ::testing::Test {
 protected:
  Channels() {
    std::array<int, 2> sockets{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, sockets.data()), 0);
    left_ = std::make_unique<MessageChannel>(Descriptor(sockets[0]));
    right_ = std::make_unique<MessageChannel>(Descriptor(sockets[1]));
  }
  /// Writes bytes past the channel `left_`.
  void write(const std::string& bytes) const {
    ASSERT_EQ(::write(left_->descriptor(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    right_->exchange();
  }
  std::unique_ptr<MessageChannel> left_, right_;
};

TEST_F(Channels, DeliverMessagesInOrderAlsoThoseThatAreLongerThanTheSocketsBuffer) {
  const std::string text(3 << 20, 'x');
  left_->send({{"text", text}});
  left_->send({{"text", "second"}});
  std::optional<nlohmann::json> first;
  for (int i = 0; i < 10000 && !first; ++i) {
    left_->exchange();
    right_->exchange();
    first = right_->receive();
  }
  ASSERT_TRUE(first);
  EXPECT_EQ(field<std::string>(*first, "text"), text);
  left_->exchange();
  right_->exchange();
  EXPECT_EQ(field<std::string>(right_->receive().value(), "text"), "second");
  EXPECT_FALSE(right_->receive());
}

TEST_F(Channels, SkipTheGreetingOfALoginShellButNoLaterLine) {
  write("Welcome to Debian\n{\"op\": \"hello\"}\n");
  EXPECT_EQ(field<std::string>(right_->receive().value(), "op"), "hello");
  write("Segmentation fault\n");
  EXPECT_THROW(right_->receive(), ProtocolError);
}

TEST_F(Channels, KeepWhatArrivedBeforeTheOtherSideClosed) {
  left_->send({{"op", "last"}});
  left_->exchange();
  left_.reset();
  right_->exchange();
  EXPECT_TRUE(right_->closed());
  EXPECT_EQ(field<std::string>(right_->receive().value(), "op"), "last");
}

TEST_F(Channels, NameTheFieldThatIsMissingOrWrong) {
  const auto error = [](const nlohmann::json& message) -> std::string {
    try {
      field<int>(message, "number");
    } catch (const ProtocolError& failed) {
      return failed.what();
    }
    return "none";
  };
  EXPECT_EQ(error({{"other", 1}}), "a message lacks the field \"number\"");
  EXPECT_EQ(error({{"number", "text"}}), "a message has a field \"number\" of another type");
  EXPECT_EQ(error({{"number", 3}}), "none");
}

TEST(PlainName, IsNoPathAndNotHidden) {
  for (const char* good : {"mamba.yaml", "navigation+control", "A_1-b"}) EXPECT_TRUE(is_plain_name(good)) << good;
  for (const char* bad : {"", ".", "..", ".hidden", "a/b", "/etc", "a b", "a\nb", "\xff"})
    EXPECT_FALSE(is_plain_name(bad)) << bad;
  EXPECT_TRUE(is_plain_path("snapshots/3.png"));
  for (const char* bad : {"", "/etc/passwd", "../x", "a/../../x", "a//b", "a/"})
    EXPECT_FALSE(is_plain_path(bad)) << bad;
}

TEST(DdsConfiguration, ResolvesFilesAndKeepsXml) {
  EXPECT_EQ(resolve_dds_uri("<CycloneDDS>a,b</CycloneDDS>"), "<CycloneDDS>a,b</CycloneDDS>");
  EXPECT_ANY_THROW(static_cast<void>(resolve_dds_uri("file:///no/such/file.xml")));
}

}  // namespace
}  // namespace constrictor::cli
