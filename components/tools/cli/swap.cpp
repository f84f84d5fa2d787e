#include "cli/swap.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "configuration/whole_file.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
constexpr const char* kFolder = "swaps";

fs::path file_of(const fs::path& report_dir, const ProcessPlan& process) {
  return report_dir / kFolder / (process.name() + ".json");
}

}  // namespace

void write_swap(const fs::path& report_dir, const ProcessPlan& process, const Swap& swap) {
  fs::create_directories(report_dir / kFolder);
  const nlohmann::json json = {{"program", swap.program}, {"config", swap.config.string()}};
  write_whole(file_of(report_dir, process), json.dump(1) + "\n");
}

std::optional<Swap> read_swap(const fs::path& report_dir, const ProcessPlan& process) {
  std::ifstream file(file_of(report_dir, process));
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_object() || !json.contains("program") || !json["program"].is_string()) return {};
  return Swap{json["program"], json.value("config", "")};
}

void remove_swaps(const fs::path& report_dir) {
  std::error_code ignored;
  fs::remove_all(report_dir / kFolder, ignored);
}

CommandLine with_swaps(CommandLine command_line, const fs::path& report_dir) {
  return [command_line = std::move(command_line), report_dir](const ProcessPlan& process, std::uint32_t incarnation) {
    const auto swap = read_swap(report_dir, process);
    if (!swap) return command_line(process, incarnation);
    ProcessPlan other = process;
    other.program = swap->program;
    auto arguments = command_line(other, incarnation);
    arguments.emplace_back("--replace");
    if (!swap->config.empty()) {
      arguments.emplace_back("--config");
      arguments.push_back(fmt::format("{}={}", process.components.front(), swap->config.string()));
    }
    return arguments;
  };
}

}  // namespace constrictor::cli
