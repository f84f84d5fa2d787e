#include "runtime/step_thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <semaphore>
#include <stdexcept>
#include <vector>

namespace constrictor {
namespace {

TEST(StepThread, RunsFunctionsOneAfterTheOtherInAThreadOfItsOwn) {
  std::vector<int> done;
  StepThread thread([] {});
  for (int i = 0; i < 100; ++i) {
    thread.start([&done, i, caller = std::this_thread::get_id()] {
      EXPECT_NE(std::this_thread::get_id(), caller);
      done.push_back(i);
    });
    EXPECT_GE(thread.collect().count(), 0);
    ASSERT_EQ(done.size(), static_cast<std::size_t>(i + 1));
  }
  EXPECT_EQ(done.back(), 99);
}

TEST(StepThread, NotifiesWhenTheFunctionIsFinished) {
  std::binary_semaphore notified{0}, go_on{0};
  StepThread thread([&] { notified.release(); });
  EXPECT_FALSE(thread.finished());
  thread.start([&] { go_on.acquire(); });
  EXPECT_FALSE(thread.finished());
  go_on.release();
  notified.acquire();
  EXPECT_TRUE(thread.finished());
  thread.collect();
  EXPECT_FALSE(thread.finished());
}

TEST(StepThread, RethrowsInTheThreadOfItsOwner) {
  StepThread thread([] {});
  thread.start([] { throw std::runtime_error("no image"); });
  EXPECT_THROW(thread.collect(), std::runtime_error);
  bool ran = false;
  thread.start([&ran] { ran = true; });
  thread.collect();
  EXPECT_TRUE(ran);
}

TEST(StepThread, EndsWithoutAFunctionAndAfterOne) {
  {
    const StepThread thread([] {});
  }
  std::atomic<int> begun = 0, ended = 0;
  for (int i = 0; i < 100; ++i) {
    StepThread thread([] {});
    thread.start([&] {
      ++begun;
      ++ended;
    });
  }
  EXPECT_EQ(begun, ended) << "the destructor waits for the function in progress";
}

}  // namespace
}  // namespace constrictor
