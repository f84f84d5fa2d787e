// `constrictor list`: the names that other subcommands accept.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace constrictor::cli {

/// Adds the subcommand; when it is chosen, its function is put into `action`.
void add_list(CLI::App& app, std::function<int()>& action);

}  // namespace constrictor::cli
