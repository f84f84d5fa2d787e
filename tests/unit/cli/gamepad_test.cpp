// The mapping of a gamepad, what its events mean, and which gamepad is chosen.
#include "cli/gamepad/gamepad.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "cli/gamepad/device.hpp"
#include "configuration/configuration.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

using Actions = std::vector<TeleopAction>;

constexpr const char* kText =
    "dead_man: BTN_TL\n"
    "drive: {axis: ABS_Y, invert: true, largest_m_s: 0.5, dead_zone: 0.2, minimum: 0, maximum: 200}\n"
    "turn: {axis: ABS_RX, largest_rad_s: 1.0, dead_zone: 0.0}\n"
    "buttons: {emergency_stop: BTN_EAST, wrap_left: BTN_WEST, release: BTN_SELECT}\n";

class GamepadTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file(const std::string& text) const {
    std::ofstream(folder_.path() / "pad.yaml") << text;
    return folder_.path() / "pad.yaml";
  }
  /// Why the mapping is refused, without the folder of the file.
  [[nodiscard]] std::string refusal(const std::string& line, const std::string& with) const {
    std::string text = kText;
    const auto at = text.find(line);
    EXPECT_NE(at, std::string::npos) << line;
    text.replace(at, line.size(), with);
    try {
      static_cast<void>(GamepadMapping::load(file(text)));
    } catch (const ConfigurationError& error) {
      const std::string what = error.what();
      return what.substr(what.find("pad.yaml"));
    }
    return "accepted";
  }
  void key(std::uint16_t code, std::int32_t value) {
    pad_.take(EV_KEY, code, value);
    pad_.take(EV_SYN, SYN_REPORT, 0);
  }
  void axis(std::uint16_t code, std::int32_t value) {
    pad_.take(EV_ABS, code, value);
    pad_.take(EV_SYN, SYN_REPORT, 0);
  }

  const testing::TemporaryFolder folder_;
  Gamepad pad_{GamepadMapping::load(file(kText)), {{ABS_RX, {-100, 100}}, {ABS_Y, {-5, 5}}}};
};

TEST_F(GamepadTest, MovesOnlyWhileTheDeadManButtonIsHeld) {
  axis(ABS_Y, 0);
  EXPECT_EQ(pad_.drive_m_s(), 0);
  key(BTN_TL, 1);
  EXPECT_DOUBLE_EQ(pad_.drive_m_s(), 0.5) << "inverted: the smallest value is full speed forwards";
  axis(ABS_RX, -50);
  EXPECT_DOUBLE_EQ(pad_.turn_rad_s(), -0.5);
  key(BTN_TL, 2);
  EXPECT_TRUE(pad_.held()) << "the repetition of a key is no release";
  EXPECT_FALSE(pad_.take_released());
  key(BTN_TL, 0);
  EXPECT_EQ(pad_.drive_m_s(), 0);
  EXPECT_EQ(pad_.turn_rad_s(), 0);
  key(BTN_TL, 1);
  EXPECT_TRUE(pad_.take_released()) << "although it is held again";
  EXPECT_FALSE(pad_.take_released());
}

TEST_F(GamepadTest, TheDeadZoneIsCutOutAndTheRestReachesTheWholeSpeed) {
  key(BTN_TL, 1);
  // Of 0 to 200 with the middle 100: 20 is the end of the dead zone of 0.2.
  for (const auto& [raw, share] : std::vector<std::pair<int, double>>{
           {100, 0}, {85, 0}, {80, 0}, {40, 0.5}, {0, 1}, {-1000, 1}, {160, -0.5}, {200, -1}, {1000, -1}}) {
    axis(ABS_Y, raw);
    EXPECT_NEAR(pad_.drive_m_s(), 0.5 * share, 1e-12) << raw;
  }
}

TEST_F(GamepadTest, ButtonsActOnceAndMotionsOnlyWithTheDeadManButton) {
  key(BTN_WEST, 1);
  EXPECT_EQ(pad_.take_actions(), Actions{});
  key(BTN_WEST, 0);
  key(BTN_TL, 1);
  key(BTN_WEST, 1);
  key(BTN_WEST, 2);
  EXPECT_EQ(pad_.take_actions(), Actions{TeleopAction::kWrapLeft});
  EXPECT_EQ(pad_.take_actions(), Actions{});
  key(BTN_TL, 0);
  key(BTN_EAST, 1);
  key(BTN_SELECT, 1);
  EXPECT_EQ(pad_.take_actions(), (Actions{TeleopAction::kEmergencyStop, TeleopAction::kRelease}));
}

TEST_F(GamepadTest, NothingIsHeldAfterALossOfEventsOrOfTheDevice) {
  axis(ABS_Y, 0);
  key(BTN_TL, 1);
  pad_.take(EV_SYN, SYN_DROPPED, 0);
  EXPECT_FALSE(pad_.held());
  pad_.take(EV_KEY, BTN_TL, 1);  // of the lost part: it may be old
  pad_.take(EV_SYN, SYN_REPORT, 0);
  EXPECT_FALSE(pad_.held());
  key(BTN_TL, 1);
  EXPECT_TRUE(pad_.held());
  EXPECT_EQ(pad_.drive_m_s(), 0) << "the stick is not known before it moves";
  axis(ABS_Y, 0);
  EXPECT_GT(pad_.drive_m_s(), 0);
  pad_.lost();
  EXPECT_FALSE(pad_.held());
  EXPECT_EQ(pad_.drive_m_s(), 0);
}

TEST_F(GamepadTest, AWrongMappingIsRefusedWithLineKeyFoundAndAccepted) {
  struct Row {
    const char *part, *with, *refusal;
  };
  for (const Row& row : {
           Row{"axis: ABS_Y", "axis: ABS_YY",
               "pad.yaml:2: drive.axis: found 'ABS_YY', accepted the name of an axis as Linux has it (ABS_X, ABS_Y, "
               "ABS_RX, ABS_RY, ABS_HAT0X, ...), did you mean 'ABS_Y'?"},
           Row{"axis: ABS_Y", "axis: BTN_TL", "pad.yaml:2: drive.axis: found 'BTN_TL'"},
           Row{"dead_man: BTN_TL", "dead_man: KEY_A", "pad.yaml:1: dead_man: found 'KEY_A'"},
           Row{"dead_man: BTN_TL", "", "dead_man"},
           Row{"axis: ABS_RX", "axis: ABS_Y", "pad.yaml:3: turn.axis: found the axis of drive"},
           Row{"wrap_left: BTN_WEST", "wrap_left: BTN_EAST", "which has an action already"},
           Row{"wrap_left: BTN_WEST", "wrap_left: BTN_TL", "found the dead-man button"},
           Row{"wrap_left", "wrap_lift", "wrap_lift"},
           Row{"emergency_stop: BTN_EAST, ", "", "found no emergency_stop"},
           Row{"largest_m_s: 0.5", "largest_m_s: 50", "drive.largest_m_s: found 50"},
           Row{"maximum: 200", "maximum: -200", "drive.maximum: found -200"},
       }) {
    EXPECT_NE(refusal(row.part, row.with).find(row.refusal), std::string::npos) << refusal(row.part, row.with);
  }
}

TEST_F(GamepadTest, TheShippedMappingIsAccepted) {
  const GamepadMapping mapping = GamepadMapping::load(GamepadMapping::default_file());
  EXPECT_EQ(mapping.dead_man, BTN_TL);
  EXPECT_EQ(mapping.buttons.at(BTN_EAST), TeleopAction::kEmergencyStop);
}

TEST_F(GamepadTest, ReadsAStreamInAnyPieces) {
  const auto fifo = folder_.path() / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  GamepadDevice device(fifo, GamepadMapping::load(file(kText)), "pad.yaml");
  EXPECT_TRUE(device.read(pad_)) << "a FIFO that has no writer yet is not gone";
  const int writer = ::open(fifo.c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_GE(writer, 0);
  std::vector<input_event> events(3);
  events[0].type = EV_ABS, events[0].code = ABS_RX, events[0].value = 32767;
  events[1].type = EV_KEY, events[1].code = BTN_TL, events[1].value = 1;
  events[2].type = EV_SYN, events[2].code = SYN_REPORT;
  const auto* bytes = reinterpret_cast<const char*>(events.data());
  for (std::size_t at = 0; at < 3 * sizeof(input_event); at += 7) {
    EXPECT_FALSE(pad_.held());
    const std::size_t count = std::min<std::size_t>(7, 3 * sizeof(input_event) - at);
    ASSERT_EQ(::write(writer, bytes + at, count), static_cast<ssize_t>(count));
    EXPECT_TRUE(device.read(pad_));
  }
  EXPECT_TRUE(pad_.held());
  EXPECT_DOUBLE_EQ(pad_.turn_rad_s(), 1.0);
  ::close(writer);
  EXPECT_FALSE(device.read(pad_)) << "the writer is gone";
}

TEST(GamepadChoice, IsTheOnlyOneOrTheNamedOne) {
  const GamepadCandidate one{"/dev/input/event3", "Pad A"};
  const GamepadCandidate two{"/dev/input/event7", "Pad B"};
  EXPECT_EQ(choose_gamepad("auto", {one}), one.device);
  EXPECT_EQ(choose_gamepad("/dev/input/event7", {one, two}), two.device);
  EXPECT_EQ(choose_gamepad("/tmp/fifo", {}), "/tmp/fifo");
  try {
    static_cast<void>(choose_gamepad("auto", {one, two}));
    FAIL() << "two gamepads: it is not clear which one is meant";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("--gamepad /dev/input/event3  (Pad A)"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("--gamepad /dev/input/event7  (Pad B)"), std::string::npos);
  }
  EXPECT_THROW(static_cast<void>(choose_gamepad("auto", {})), std::runtime_error);
}

TEST(GamepadDevices, ThatAreNoneAreRefused) {
  const GamepadMapping mapping = GamepadMapping::load(GamepadMapping::default_file());
  EXPECT_THROW(GamepadDevice("/nowhere", mapping, "m"), std::runtime_error);
  EXPECT_THROW(GamepadDevice("/dev/null", mapping, "m"), std::runtime_error) << "a device, but none with events";
  EXPECT_TRUE(find_gamepads("/nowhere").empty());
}

}  // namespace
}  // namespace constrictor::cli
