// The token of a run: a secret text that shows that a program may command the run, or be a member of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace constrictor {

/// A new token: 128 random bits as 32 hexadecimal digits.
[[nodiscard]] std::string new_token();

/// A number that distinguishes a run from others; never 0. Nothing that a run computes depends on it.
[[nodiscard]] std::uint64_t new_run_id();

/// Writes the token into a new file that only this user can read. Throws std::runtime_error.
void write_token_file(const std::filesystem::path& file, const std::string& token);

/// The token in the first line of a file: 1 to 64 printable characters without blanks. Throws std::runtime_error if the
/// file cannot be read, if other users can read it, or if it contains something else.
[[nodiscard]] std::string read_token_file(const std::filesystem::path& file);

/// True if both are equal. The time that it takes does not depend on where they differ.
[[nodiscard]] bool same_token(std::string_view a, std::string_view b);

/// HMAC-SHA-256 (RFC 2104) of `text` with the token as its key, as 64 hexadecimal digits.
[[nodiscard]] std::string proof_of_token(std::string_view token, std::string_view text);

}  // namespace constrictor
