#include "cyclone/abort_place.hpp"

#include <execinfo.h>
#include <unistd.h>

#include <csignal>
#include <string_view>

namespace constrictor::dds {
namespace {

constexpr int kMostCalls = 64;

void write_calls(int number) {
  constexpr std::string_view kWords = "aborted; please report these lines, the innermost call is the first:\n";
  (void)!::write(STDERR_FILENO, kWords.data(), kWords.size());
  void* calls[kMostCalls];
  ::backtrace_symbols_fd(calls, ::backtrace(calls, kMostCalls), STDERR_FILENO);
  ::raise(number);  // with the default action, which SA_RESETHAND has restored
}

}  // namespace

void say_where_aborted() {
  struct sigaction before {};
  if (::sigaction(SIGABRT, nullptr, &before) != 0 || before.sa_handler != SIG_DFL) return;
  void* call = nullptr;
  ::backtrace(&call, 1);  // the first call loads a library, which a signal handler must not do
  struct sigaction action {};
  action.sa_handler = write_calls;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGABRT, &action, nullptr);
}

}  // namespace constrictor::dds
