#include "cyclone/run_token.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <random>
#include <stdexcept>

#include "constrictor/hex.hpp"
#include "constrictor/sha256.hpp"

namespace constrictor {
namespace {

constexpr std::size_t kMostLetters = 64;
}  // namespace

std::string new_token() {
  std::random_device entropy;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", static_cast<std::uint32_t>(entropy()));
  return token;
}

std::uint64_t new_run_id() {
  std::random_device entropy;
  return (static_cast<std::uint64_t>(entropy()) << 32 | entropy()) | 1;
}

void write_token_file(const std::filesystem::path& file, const std::string& token) {
  const std::string line = token + "\n";
  std::error_code ignored;
  std::filesystem::remove(file, ignored);  // a file of another owner or mode must not receive the token
  const int descriptor = ::open(file.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC | O_NOFOLLOW, 0600);
  const bool written = descriptor >= 0 && ::write(descriptor, line.data(), line.size()) == ssize_t(line.size());
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!written) throw std::runtime_error(fmt::format("token file {}: {}", file.string(), ::strerrordesc_np(error)));
}

std::string read_token_file(const std::filesystem::path& file) {
  struct stat status {};
  std::ifstream stream(file);
  if (!stream || ::stat(file.c_str(), &status) != 0)
    throw std::runtime_error(fmt::format("token file {}: cannot be read", file.string()));
  if ((status.st_mode & 077) != 0) {
    throw std::runtime_error(
        fmt::format("token file {0}: found mode {1:04o}, accepted a file that only its owner can "
                    "read (chmod 600 {0})",
                    file.string(), status.st_mode & 07777));
  }
  std::string token;
  std::getline(stream, token);
  const bool printable = std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c <= '~'; });
  if (token.empty() || token.size() > kMostLetters || !printable) {
    throw std::runtime_error(
        fmt::format("token file {}: the first line must be 1 to {} printable ASCII characters without spaces",
                    file.string(), kMostLetters));
  }
  return token;
}

bool same_token(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

std::string proof_of_token(std::string_view token, std::string_view text) { return hex(hmac_sha256(token, text)); }

}  // namespace constrictor
