// A million mutated answers to the driver: it never takes one of them for the answer of a servo, and never hangs.
#include <gtest/gtest.h>

#include <random>

#include "serial/bus_master.hpp"

namespace constrictor::serial {
namespace {

using dynamixel::Bytes;

/// A port on which a servo answers each question, mutated in every way.
class MutatingPort final : public Port {
 public:
  void write(dynamixel::ByteView) override {
    const std::uint8_t error = 0;
    Bytes answer;
    dynamixel::put_status(answer, 1, error, data);
    right = answer;
    const auto roll = [&](std::size_t below) { return static_cast<std::size_t>(random_() % below); };
    switch (roll(5)) {
      case 0:
        // Not the length: a packet that ends elsewhere is compared with other bytes, and one in 65,536 would pass.
        answer[(roll(2) == 0) ? roll(5) : 7 + roll(answer.size() - 7)] ^= static_cast<std::uint8_t>(1 + roll(255));
        break;
      case 1:
        answer.resize(roll(answer.size()));
        break;
      case 2:
        answer.erase(answer.begin() + static_cast<std::ptrdiff_t>(7 + roll(answer.size() - 7)));
        break;
      case 3:
        for (auto& byte : answer) byte = static_cast<std::uint8_t>(random_());
        break;
      default:
        answer = question_back;  // an adapter that receives what it sends
        break;
    }
    waiting_ = std::move(answer);
  }
  [[nodiscard]] bool read(Bytes& to, std::int64_t deadline_ns) override {
    if (waiting_.empty()) {
      now_ns_ = std::max(now_ns_, deadline_ns);
      return false;
    }
    const std::size_t piece = std::min<std::size_t>(waiting_.size(), 1 + random_() % 16);
    to.insert(to.end(), waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(piece));
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(piece));
    now_ns_ += 1000;
    return true;
  }
  void drop_input() override { waiting_.clear(); }
  [[nodiscard]] std::int64_t now_ns() const override { return now_ns_; }
  [[nodiscard]] std::uint32_t baud() const override { return 4'000'000; }

  Bytes data{1, 2, 3, 4};
  Bytes right;
  Bytes question_back;

 private:
  std::mt19937_64 random_{3};
  Bytes waiting_;
  std::int64_t now_ns_ = 1;
};

TEST(MutatedAnswers, AMillionOfThemAreAllRefused) {
  auto owned = std::make_unique<MutatingPort>();
  MutatingPort& port = *owned;
  dynamixel::put_read(port.question_back, 1, 132, 4);
  BusMaster bus(std::move(owned), 0.001);
  std::uint64_t arrived = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    for (auto& byte : port.data) byte = static_cast<std::uint8_t>(i * 2654435761u >> (8 + i % 16));
    const std::int64_t before_ns = port.now_ns();
    const Answer answer = bus.read(1, 132, 4, 1);
    ASSERT_LT(port.now_ns() - before_ns, 5'000'000) << "the wait has a bound";
    if (answer.arrived) ++arrived;
  }
  EXPECT_EQ(arrived, 0u);
  EXPECT_EQ(bus.counters().timeouts, 1'000'000u);
  EXPECT_GT(bus.line().crc_errors, 100'000u);
}

}  // namespace
}  // namespace constrictor::serial
