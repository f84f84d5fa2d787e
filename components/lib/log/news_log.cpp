#include "log/news_log.hpp"

namespace constrictor {

void NewsLog::write(const std::string& text, bool is_good) {
  if (written_ == most_) {
    ++left_out_;
    return;
  }
  ++written_;
  if (is_good) log_.info("{}", text);
  else log_.warning("{}", text);
}

void NewsLog::at(std::int64_t tick) {
  if (tick >= from_tick_ && tick - from_tick_ < kWindow_ticks) return;
  if (left_out_ > 0) log_.warning("{} {}", left_out_, left_out_text_);
  from_tick_ = tick;
  written_ = left_out_ = 0;
}

}  // namespace constrictor
