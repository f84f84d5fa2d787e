#include "cli/interrupt.hpp"

#include <csignal>

namespace constrictor::cli {
namespace {

volatile std::sig_atomic_t g_signal = 0;

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = [](int number) { g_signal = number; };
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) ::sigaction(number, &action, nullptr);
}

int interrupt_signal() { return static_cast<int>(g_signal); }

}  // namespace constrictor::cli
