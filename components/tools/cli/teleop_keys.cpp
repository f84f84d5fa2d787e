#include "cli/teleop_keys.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace constrictor::cli {
namespace {

constexpr double kTurn_1_m = 0.8;          // path curvature of "left" and "right"
constexpr double kRotate_rad_per_m = 2.5;  // turn rate on the spot, divided by the chosen speed
constexpr double kLook_rad = 0.25;
constexpr std::size_t kMaxSequence = 16;  // largest number of bytes of a key

constexpr std::array<std::pair<char, TeleopAction>, 24> kKeys{{
    {'i', TeleopAction::kForward},   {',', TeleopAction::kBack},       {'j', TeleopAction::kLeft},
    {'l', TeleopAction::kRight},     {'u', TeleopAction::kRotateLeft}, {'o', TeleopAction::kRotateRight},
    {'k', TeleopAction::kStand},     {'+', TeleopAction::kFaster},     {'=', TeleopAction::kFaster},
    {'-', TeleopAction::kSlower},    {'f', TeleopAction::kLookLeft},   {'g', TeleopAction::kLookAhead},
    {'h', TeleopAction::kLookRight}, {'w', TeleopAction::kWrapLeft},   {'e', TeleopAction::kWrapRight},
    {'s', TeleopAction::kSqueeze},   {'d', TeleopAction::kOpen},       {' ', TeleopAction::kEmergencyStop},
    {'c', TeleopAction::kClearStop}, {'t', TeleopAction::kTask},       {'x', TeleopAction::kCancel},
    {'r', TeleopAction::kRelease},   {'q', TeleopAction::kQuit},       {'\003', TeleopAction::kQuit},
}};

TeleopAction action_of_character(char key) {
  const auto* found = std::find_if(kKeys.begin(), kKeys.end(), [key](const auto& row) { return row.first == key; });
  return found == kKeys.end() ? TeleopAction::kNone : found->second;
}

}  // namespace

const char* const kTeleopHelp[3] = {"i/, forward/back  j/l turn  u/o rotate  k stand  +/- speed  f/g/h look  w/e wrap",
                                    "s squeeze  d open  t task  x cancel task  r release authority  q quit",
                                    "SPACE emergency stop  c clear it"};

std::string KeyReader::next(bool quiet) {
  if (typed_.empty()) return {};
  std::size_t length = 1;
  if (typed_[0] == '\033') {
    const char kind = typed_.size() > 1 ? typed_[1] : '\0';
    bool whole = kind != '\0' && kind != '[' && kind != 'O';  // the next byte is a key of its own
    if (kind == '[' || kind == 'O') {
      // Parameters, then one final character. Any other byte ends the sequence and is a key of its own: a space must
      // always be the emergency stop.
      std::size_t end = 2;
      while (end < typed_.size() && end < kMaxSequence && typed_[end] >= '0' && typed_[end] <= '?') ++end;
      whole = end < typed_.size();
      length = whole && typed_[end] >= '@' && typed_[end] <= '~' ? end + 1 : end;
    }
    if (!whole) {
      if (!quiet) return {};
      length = typed_.size();
    }
  }
  std::string key = typed_.substr(0, length);
  typed_.erase(0, length);
  return key;
}

TeleopAction action_of(std::string_view key) {
  if (key.size() == 1) return action_of_character(key[0]);
  if (key.size() < 3 || key[0] != '\033') return TeleopAction::kNone;
  switch (key.back()) {
    case 'A':
      return TeleopAction::kForward;
    case 'B':
      return TeleopAction::kBack;
    case 'C':
      return TeleopAction::kRight;
    case 'D':
      return TeleopAction::kLeft;
    default:
      return TeleopAction::kNone;
  }
}

double TeleopDrive::turn_rad_s() const {
  return forward == 0.0 ? turn * kRotate_rad_per_m * speed_m_s : turn * kTurn_1_m * speed_m_s;
}

bool TeleopDrive::apply(TeleopAction action) {
  switch (action) {
    case TeleopAction::kForward:
    case TeleopAction::kBack:
      forward = action == TeleopAction::kForward ? 1.0 : -1.0;
      turn = 0.0;
      return true;
    case TeleopAction::kLeft:
    case TeleopAction::kRight:
      if (forward == 0.0) forward = 1.0;
      turn = action == TeleopAction::kLeft ? 1.0 : -1.0;
      return true;
    case TeleopAction::kRotateLeft:
    case TeleopAction::kRotateRight:
      forward = 0.0;
      turn = action == TeleopAction::kRotateLeft ? 1.0 : -1.0;
      return true;
    case TeleopAction::kStand:
      forward = turn = 0.0;
      return true;
    case TeleopAction::kFaster:
      speed_m_s = std::min(0.9, speed_m_s + 0.1);
      return true;
    case TeleopAction::kSlower:
      speed_m_s = std::max(0.1, speed_m_s - 0.1);
      return true;
    case TeleopAction::kLookLeft:
      look_rad = std::min(1.5, look_rad + kLook_rad);
      return false;
    case TeleopAction::kLookRight:
      look_rad = std::max(-1.5, look_rad - kLook_rad);
      return false;
    case TeleopAction::kLookAhead:
      look_rad = 0.0;
      return false;
    default:
      return false;
  }
}

}  // namespace constrictor::cli
