// What happens to devices, for people, and how it gets into the log.
#pragma once

#include <cstdint>
#include <string>

#include "log/log.hpp"

namespace constrictor {

/// Writes news of a device with the log, such as a lost servo or frames of a camera that arrive again, but not as many
/// as a loose contact may cause.
class NewsLog {
 public:
  static constexpr std::int64_t kWindow_ticks = 500;

  /// `most`: lines in a window. `left_out`: follows the number of those that were left out, and says where they are.
  NewsLog(Log log, int most, std::string left_out)
      : log_(std::move(log)), most_(most), left_out_text_(std::move(left_out)) {}
  /// A line on what has happened: information if the device works, or works again, and else a warning.
  void write(const std::string& text, bool is_good);
  /// To be called before write(). Begins the next window when the present one is over, or the ticks begin anew, and
  /// then logs how many lines were left out.
  void at(std::int64_t tick);

 private:
  Log log_;
  int most_;
  std::string left_out_text_;
  std::int64_t from_tick_ = 0;  ///< of the present window
  int written_ = 0;
  int left_out_ = 0;
};

}  // namespace constrictor
