// WriterBook knows the participant of each writer that its readers have matched, also while writers come and go in
// other threads.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/wait_set.hpp"
#include "cyclone/writer_book.hpp"
#include "support/eventually.hpp"

namespace constrictor {
namespace {

using namespace std::chrono_literals;

using testing::eventually;

class WriterBookTest : public ::testing::Test {
 protected:
  using Reader = dds::Reader<msg::Waiting>;
  using Writer = dds::Writer<msg::Waiting>;

  [[nodiscard]] Reader reader(dds::WriterBook& book) const {
    return Reader::guarded(domain_.participant(), barrier_topics::kWaiting, book);
  }
  /// The publication handle of the first sample that arrives, 0 if none does.
  static dds_instance_handle_t first_writer(const Reader& from) {
    dds_instance_handle_t found = 0;
    EXPECT_TRUE(eventually([&] {
      from.take_from([&](const msg::Waiting&, dds_instance_handle_t writer) { found = writer; });
      return found != 0;
    }));
    return found;
  }

  const DomainClaim claim_;
  const dds::Domain domain_{claim_.domain()};
};

TEST_F(WriterBookTest, KnowsWritersFromBeforeAndAfterTheReaderAndRemembersDeadOnes) {
  dds::WriterBook book;
  const dds::Entity other(dds_create_participant(claim_.domain(), nullptr, nullptr), "dds_create_participant");
  const dds::GuidPrefix prefix = dds::own_prefix(other.get());
  auto before = std::make_unique<Writer>(other.get(), barrier_topics::kWaiting);
  const Reader all = reader(book);
  EXPECT_TRUE(book.lives(prefix));
  before->write({});
  EXPECT_EQ(book.participant_of(first_writer(all)), prefix);
  before.reset();
  EXPECT_TRUE(eventually([&] { return !book.lives(prefix); }));

  dds_instance_handle_t handle = 0;
  {
    const Writer after(other.get(), barrier_topics::kWaiting);
    EXPECT_TRUE(eventually([&] { return book.lives(prefix); }));
    after.write({});
    handle = first_writer(all);
  }
  EXPECT_TRUE(eventually([&] { return !book.lives(prefix); }));
  EXPECT_EQ(book.participant_of(handle), prefix) << "samples of a dead writer may still be waiting";
  EXPECT_EQ(book.participant_of(handle + 1), std::nullopt);
}

TEST_F(WriterBookTest, ReadersThatStartWhileWritersAppearDoNotBlock) {
  const auto all_done = [this] {
    std::atomic<bool> stop = false;
    std::vector<std::thread> threads;
    for (int i = 0; i < 2; ++i) {
      threads.emplace_back([&] {
        const dds::Entity other(dds_create_participant(claim_.domain(), nullptr, nullptr), "dds_create_participant");
        while (!stop) const Writer writer(other.get(), barrier_topics::kWaiting);
      });
    }
    dds::WriterBook book;
    // Questions to the book make its listener wait, and so last longer.
    const dds::Entity crowd(dds_create_participant(claim_.domain(), nullptr, nullptr), "dds_create_participant");
    std::vector<Writer> many;
    for (int i = 0; i < 300; ++i) many.emplace_back(crowd.get(), barrier_topics::kWaiting);
    threads.emplace_back([&] {
      while (!stop) static_cast<void>(book.lives({}));
    });
    for (int i = 0; i < 300; ++i) {
      const Reader started = reader(book);
      const dds::WaitSet wait_set(domain_.participant());
      wait_set.attach(started.get());
    }
    stop = true;
    for (auto& thread : threads) thread.join();
  };
  std::packaged_task<void()> task(all_done);
  auto done = task.get_future();
  std::thread worker(std::move(task));
  if (done.wait_for(60s) == std::future_status::timeout) {
    std::fputs("[  FAILED  ] the reader's thread and a writer's thread wait for each other\n", stderr);
    std::fflush(nullptr);
    std::_Exit(1);  // the blocked threads can be neither joined nor ended
  }
  worker.join();
  done.get();
}

}  // namespace
}  // namespace constrictor
