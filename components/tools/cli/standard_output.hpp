// The standard output of all subcommands.
#pragma once

#include <string_view>

namespace constrictor::cli {

/// Writes `text` to the standard output, and what was printed before. Throws std::runtime_error, with the reason, if
/// not all of it has arrived, for example on a full disk.
void write_standard_output(std::string_view text = {});

}  // namespace constrictor::cli
