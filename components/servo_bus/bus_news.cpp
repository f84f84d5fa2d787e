#include "servo_bus/bus_news.hpp"

namespace constrictor {

void NewsLog::write(const BusNews& news) {
  if (written_ == kMost) {
    ++left_out_;
    return;
  }
  ++written_;
  if (news.is_good) log_.info("{}", news.text);
  else log_.warning("{}", news.text);
}

void NewsLog::at(std::int64_t tick) {
  if (tick - from_tick_ < kWindow_ticks && tick >= from_tick_) return;
  if (left_out_ > 0) log_.warning("{} more events were left out; servo_bus.json shows the newest ones", left_out_);
  from_tick_ = tick;
  written_ = left_out_ = 0;
}

}  // namespace constrictor
