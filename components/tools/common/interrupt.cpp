#include "common/interrupt.hpp"

namespace constrictor {
namespace {

volatile std::sig_atomic_t g_signal = 0;

}  // namespace

void catch_interrupts(std::initializer_list<int> signals) {
  struct sigaction action {};
  action.sa_handler = [](int number) { g_signal = number; };
  for (const int number : signals) ::sigaction(number, &action, nullptr);
}

void survive_closed_pipes() { ::signal(SIGPIPE, SIG_IGN); }

int interrupt_signal() { return static_cast<int>(g_signal); }

}  // namespace constrictor
