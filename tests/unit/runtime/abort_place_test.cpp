// A process that Cyclone DDS aborts says where.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "cyclone/abort_place.hpp"

namespace constrictor::dds {
namespace {

TEST(AbortPlace, AnAbortedProcessNamesTheCallsAndEndsByTheSignal) {
  const auto aborted = [] {
    say_where_aborted();
    std::abort();
  };
  EXPECT_EXIT(aborted(), ::testing::KilledBySignal(SIGABRT), "aborted; please report these lines.*\n.*abort");
}

TEST(AbortPlace, TheHandlerOfAProgramStays) {
  const auto handled = [] {
    std::signal(SIGABRT, [](int) { std::_Exit(7); });
    say_where_aborted();
    std::abort();
  };
  EXPECT_EXIT(handled(), ::testing::ExitedWithCode(7), "^$");
}

}  // namespace
}  // namespace constrictor::dds
