// `constrictor run --view`: the dashboard of a run, for as long as the run goes on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "cli/child_process.hpp"

namespace constrictor::cli {

/// Starts the program `dashboard` beside a run, prints its address and opens it in a browser if there is a display. The
/// run does not depend on it: if the dashboard cannot be started, for example because its port is taken, or if it ends,
/// a line says so and the run goes on.
class LiveView {
 public:
  using Print = std::function<void(const std::string& line)>;
  /// `port`: 0: any free one. `logs`: folder for the output of the programs; it is created.
  LiveView(std::uint32_t domain, std::uint16_t port, const std::filesystem::path& logs, Print print);
  /// Ends the dashboard.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Prints what has happened since the last call.
  void poll();

 private:
  void open(const std::string& address);

  Print print_;
  std::filesystem::path log_, browser_log_;
  std::unique_ptr<ChildProcess> dashboard_, browser_;
  bool told_ = false;   ///< the address was printed
  bool ended_ = false;  ///< the end of the dashboard was printed
};

/// The address of the page in the output of the dashboard: "http://127.0.0.1:8765"; empty: there is none yet.
[[nodiscard]] std::string address_in(const std::string& output);

}  // namespace constrictor::cli
