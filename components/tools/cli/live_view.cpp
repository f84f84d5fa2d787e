#include "cli/live_view.hpp"

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>
#include <utility>

#include "cli/launch_plan.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kViewGrace = 3s;

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* value = std::getenv(name);
    if (value && *value) return true;
  }
  return false;
}

}  // namespace

std::string address_in(const std::string& output) {
  const auto begin = output.find("http://");
  if (begin == std::string::npos) return {};
  const auto end = output.find(' ', begin);
  return end == std::string::npos ? std::string() : output.substr(begin, end - begin);
}

LiveView::LiveView(std::uint32_t domain, std::uint16_t port, const std::filesystem::path& logs, Print print)
    : print_(std::move(print)), log_(logs / "dashboard.log"), browser_log_(logs / "browser.log") {
  std::filesystem::create_directories(logs);
  for (const auto& file : {log_, browser_log_}) std::filesystem::remove(file);
  dashboard_ =
      std::make_unique<ChildProcess>(std::vector<std::string>{(program_folder() / "dashboard").string(), "--run",
                                                              std::to_string(domain), "--port", std::to_string(port)},
                                     run_environment(), log_);
}

LiveView::~LiveView() {
  if (dashboard_->poll()) return;
  dashboard_->signal(SIGTERM);
  const auto end = std::chrono::steady_clock::now() + kViewGrace;
  while (!dashboard_->poll() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(10ms);
}

void LiveView::poll() {
  if (!told_) {
    if (const std::string address = address_in(content_of(log_)); !address.empty()) {
      told_ = true;
      print_("the run is shown at " + address);
      if (has_display()) open(address);
    }
  }
  if (browser_ && browser_->poll()) {
    if (!browser_->poll()->clean())
      print_(fmt::format("no browser was opened: xdg-open {}; open the address above yourself",
                         browser_->poll()->describe()));
    browser_.reset();
  }
  if (ended_ || !dashboard_->poll()) return;
  ended_ = true;
  if (dashboard_->poll()->clean()) return;  // it has seen the end of the run
  for (const auto& line : last_lines(log_, 0, 1)) print_(line);
  print_(
      fmt::format("the run goes on and is not shown, because the dashboard {}; `constrictor dashboard` starts "
                  "another one",
                  dashboard_->poll()->describe()));
}

void LiveView::open(const std::string& address) {
  // Found in PATH. It returns at once: the browser is a process of its own and outlives the run.
  browser_ = std::make_unique<ChildProcess>(std::vector<std::string>{"/usr/bin/env", "xdg-open", address},
                                            run_environment(), browser_log_);
}

}  // namespace constrictor::cli
