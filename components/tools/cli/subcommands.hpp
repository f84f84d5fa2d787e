// The subcommands of `constrictor`, and how each is added to the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <memory>
#include <string>

namespace constrictor::cli {

/// The action of the chosen subcommand. It returns the exit status.
using Action = std::function<int()>;

/// Each adds the subcommands that its file implements. When one of them is chosen on the command line, `action` is set.
void add_run(CLI::App& app, Action& action);          ///< run, check
void add_evaluate(CLI::App& app, Action& action);     ///< evaluate
void add_serve(CLI::App& app, Action& action);        ///< serve
void add_keys(CLI::App& app, Action& action);         ///< keys
void add_list(CLI::App& app, Action& action);         ///< list
void add_robot(CLI::App& app, Action& action);        ///< robot
void add_scenario(CLI::App& app, Action& action);     ///< scenario
void add_servo(CLI::App& app, Action& action);        ///< servo
void add_swap(CLI::App& app, Action& action);         ///< swap
void add_commands(CLI::App& app, Action& action);     ///< end, diff; host has only its help here
void add_run_control(CLI::App& app, Action& action);  ///< pause, resume, step, pace, reset, stop, clear-stop, release
void add_teleop(CLI::App& app, Action& action);       ///< teleop
void add_task(CLI::App& app, Action& action);         ///< task
void add_param(CLI::App& app, Action& action);        ///< param
void add_topic(CLI::App& app, Action& action);        ///< topic
void add_node(CLI::App& app, Action& action);         ///< node
void add_status(CLI::App& app, Action& action);       ///< status
void add_doctor(CLI::App& app, Action& action);       ///< doctor
void add_log(CLI::App& app, Action& action);          ///< log
void add_record(CLI::App& app, Action& action);       ///< record
void add_replay(CLI::App& app, Action& action);       ///< replay
void add_recording_files(CLI::App& app, Action& action);  ///< info, recover
void add_pictures(CLI::App& app, Action& action);         ///< figure, film
void add_foxglove(CLI::App& app, Action& action);         ///< foxglove
void add_agent(CLI::App& app, Action& action);            ///< agent
void add_completion(CLI::App& app, Action& action);       ///< completion
/// man-pages; `date` of the release, for the pages, or empty.
void add_man_pages(CLI::App& app, Action& action, const std::string& date);

inline constexpr std::array kSubcommands{
    add_run,  add_evaluate, add_serve,           add_list,  add_robot,  add_commands, add_run_control, add_teleop,
    add_task, add_param,    add_topic,           add_node,  add_status, add_doctor,   add_agent,       add_completion,
    add_keys, add_record,   add_recording_files, add_servo, add_swap,   add_replay,   add_pictures,    add_foxglove,
    add_log,  add_scenario};

/// Adds the subcommand `name` to `parent`. When it is chosen, `action` becomes `run(*options)`.
template <class Options, class Run>
CLI::App* add_subcommand(CLI::App& parent, const std::string& name, const std::string& what, Action& action,
                         std::shared_ptr<Options> options, Run run) {
  CLI::App* sub = parent.add_subcommand(name, what);
  sub->callback([&action, options, run] { action = [options, run] { return run(*options); }; });
  return sub;
}

/// Adds the subcommand `name` whose own subcommands do the work; one of them must be chosen.
inline CLI::App* add_group(CLI::App& parent, const std::string& name, const std::string& what) {
  CLI::App* group = parent.add_subcommand(name, what);
  group->require_subcommand(1);
  return group;
}

}  // namespace constrictor::cli
