#include "cyclone/run_token.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;

class RunToken : public ::testing::Test {
 protected:
  fs::path file(const std::string& text, fs::perms mode = fs::perms::owner_read | fs::perms::owner_write) const {
    fs::path path = folder_.path() / "token";
    std::ofstream(path) << text;
    fs::permissions(path, mode);
    return path;
  }
  static std::string error_of(const fs::path& path) {
    try {
      static_cast<void>(read_token_file(path));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  const testing::TemporaryFolder folder_;
};

TEST_F(RunToken, EachTokenIsNewAndHas128Bits) {
  const std::string token = new_token();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(new_token(), token);
}

TEST_F(RunToken, AWrittenFileIsReadableByItsOwnerOnlyAndHoldsTheToken) {
  const fs::path path = file("another content\n", fs::perms::all);  // it is replaced with its mode
  write_token_file(path, "secret");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(read_token_file(path), "secret");
  EXPECT_THROW(write_token_file(folder_.path() / "none" / "token", "secret"), std::runtime_error);
}

TEST_F(RunToken, AFileThatOthersCanReadOrThatHoldsNoTokenIsRefusedWithTheCure) {
  EXPECT_NE(error_of(file("secret\n", fs::perms::owner_read | fs::perms::others_read)).find("chmod 600"),
            std::string::npos);
  EXPECT_NE(error_of(folder_.path() / "missing").find("cannot be read"), std::string::npos);
  for (const std::string& text : std::vector<std::string>{"", "\n", "two words", "bell\a", std::string(65, 'x')})
    EXPECT_NE(error_of(file(text)).find("must be 1 to 64 printable ASCII characters"), std::string::npos) << text;
  EXPECT_EQ(error_of(file(std::string(64, 'x'))), "");
}

TEST_F(RunToken, OnlyEqualTokensAreTheSame) {
  EXPECT_TRUE(same_token("abc", "abc"));
  for (const char* other : {"", "ab", "abcd", "abd", "xbc"}) EXPECT_FALSE(same_token("abc", other)) << other;
}

// The expected values are those of RFC 4231, test cases 1 and 2.
TEST_F(RunToken, TheProofIsHmacSha256) {
  EXPECT_EQ(proof_of_token(std::string(20, '\x0b'), "Hi There"),
            "b0344c61d8db38535ca8afceaf0bf12b881dc200c9833da726e9376c2e32cff7");
  EXPECT_EQ(proof_of_token("Jefe", "what do ya want for nothing?"),
            "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
}

}  // namespace
}  // namespace constrictor
