// The folder in which Mesa keeps the machine code of compiled shaders, so that only the first run compiles them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace constrictor {

/// The folder below which programs of this user keep what they can make again: the first of $CACHE_DIRECTORY (which
/// systemd sets), $XDG_CACHE_HOME and $HOME/.cache that is an absolute path. Nothing if there is none.
std::optional<std::filesystem::path> cache_root();

/// The lines of a text like /proc/cpuinfo that say which instructions the first CPU has.
std::string cpu_features(std::string_view cpuinfo);

/// A folder below `root` for the machine code that suits a CPU and the settings of the compiler, given as one text.
/// Mesa 22.3 does not compare the vector width of cached code with its own, so each text has a folder of its own. The
/// folder is made if it is missing. Nothing if it cannot be made, or if another user could write into it: what it
/// contains will be executed.
std::optional<std::filesystem::path> shader_cache_folder(const std::filesystem::path& root, std::string_view settings);

/// Sets Mesa's environment variables so that it uses shader_cache_folder() with the present settings of llvmpipe, or
/// no cache where there is no such folder. Mesa reads them at the first context. A MESA_SHADER_CACHE_DISABLE of the
/// environment takes precedence.
void set_up_shader_cache();

}  // namespace constrictor
