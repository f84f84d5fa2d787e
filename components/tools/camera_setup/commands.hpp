// The subcommands of `constrictor camera`. Each function returns the exit status.
#pragma once

#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "component/data_path.hpp"
#include "video/video_device.hpp"

namespace constrictor::camera_setup {

/// The signal that ends the program; 0: none has arrived.
extern volatile std::sig_atomic_t g_signal;

/// The user has to do something else.
class Failed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Options {
  std::string source;
  video::DeviceRequest device;
  bool rate_given = false;  ///< the rate in `device` is what the user expects; false: it is only a request
  std::string board = "9x6";
  double square_m = 0.025;
  std::filesystem::path out;
  std::string calibration;
  std::filesystem::path robot = default_robot_file();
  std::size_t views = 20;  ///< of the board that are collected from a live source
  double largest_error_px = 1.0;
  std::vector<double> at_m;
  double yaw_deg = 0.0;
  double within_s = 60.0;     ///< in which a live source must show the board on the ground
  bool accept_mount = false;  ///< also a mount that is hardly plausible
  std::vector<std::string> samples;
};

/// Why a value of --board or of --sample is not accepted; empty: it is.
[[nodiscard]] std::string wrong_board(const std::string& text);
[[nodiscard]] std::string wrong_sample(const std::string& text);
/// For a picture that is to be written: its name must end in the name of a format.
[[nodiscard]] std::string wrong_picture_name(const std::string& file);

int show(const Options& options);
int calibrate(const Options& options);
int mount(const Options& options);
int colours(const Options& options);

}  // namespace constrictor::camera_setup
