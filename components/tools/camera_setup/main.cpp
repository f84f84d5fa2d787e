// camera_setup: what is done once with a new camera. `constrictor camera` becomes this program.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>

#include "camera_setup/commands.hpp"
#include "configuration/command_line.hpp"
#include "configuration/configuration.hpp"
#include "runtime/host.hpp"
#include "runtime/version.hpp"

namespace {

using namespace constrictor;
using namespace constrictor::camera_setup;

void add_source(CLI::App& sub, Options& options) {
  sub.add_option("--source", options.source,
                 "device, address, pipeline of GStreamer, file NAME.url, video, picture, or folder of pictures")
      ->required();
  sub.add_option_function<double>(
         "--rate",
         [&options](double rate_hz) {
           options.device.frame_rate_hz = rate_hz;
           options.rate_given = true;
         },
         "[Hz] frames in a second that a live source should send; without it, 30 is asked of a device and `show` "
         "counts "
         "no\nmissing frames")
      ->check(number(0.5, 240.0, "Hz"));
  sub.add_option("--width", options.device.width, "[pixel] width of the pictures of a device; 0: the device chooses")
      ->check(whole_number(0, 4096));
  sub.add_option("--height", options.device.height, "[pixel] height of the pictures of a device; 0: the device chooses")
      ->check(whole_number(0, 4096));
}

void add_board(CLI::App& sub, Options& options) {
  sub.add_option("--board", options.board, "inner corners of the chessboard, COLUMNSxROWS")
      ->capture_default_str()
      ->check(wrong_board);
  sub.add_option("--square", options.square_m,
                 "[m] edge of one square of the chessboard, measured on the printed board")
      ->required()
      ->check(number(0.001, 1.0, "m"));
  sub.add_option("--largest-error", options.largest_error_px,
                 "[pixel] the result is refused if the root mean square error of the corners is larger")
      ->capture_default_str()
      ->check(number(0.01, 100.0, "pixels"));
}

constexpr const char* kShow = "  constrictor camera show --source /dev/video0 --out picture.png";
constexpr const char* kCalibrate =
    "  constrictor camera calibrate --source http://10.0.0.7:8080/stream --square 0.024 --out camera.yaml";
constexpr const char* kMount =
    "  constrictor camera mount --source /dev/video0 --calibration camera.yaml --board 6x5 --square 0.04 --at 0.36,0";
constexpr const char* kColours =
    "  constrictor camera colours --source picture.png --sample blue=150,200,20,10 --sample ground=20,200,40,20 --out "
    "colours.yaml";

/// The last part of a --help.
std::string footer(const std::string& examples) {
  return fmt::format(
      "EXAMPLES\n{}\n\n"
      "EXIT STATUS\n  0 done; 1 it did not succeed, with what to do; 64 wrong usage; 70 the source cannot be read; 78 "
      "a "
      "file is wrong;\n  130 Ctrl-C",
      examples);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  int (*chosen)(const Options&) = nullptr;
  CLI::App app{"Sets a new camera up: try it, calibrate its lens, find its mount, teach colours.",
               "constrictor camera"};
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  const auto add = [&](const char* name, const char* what, const char* example, int (*run)(const Options&)) {
    CLI::App* sub = app.add_subcommand(name, what);
    sub->callback([&chosen, run] { chosen = run; });
    add_source(*sub, options);
    sub->footer(footer(example));
    return sub;
  };
  CLI::App* sub = add("show", "try a source: size, rate, brightness; save a picture", kShow, show);
  sub->add_option("--out", options.out, "file for the last picture: .png, .jpg, .bmp, .tif or .webp")
      ->check(wrong_picture_name);
  sub = add("calibrate", "find the model of the lens with a chessboard", kCalibrate, calibrate);
  add_board(*sub, options);
  sub->add_option("--views", options.views, "how many views of a live source are collected")
      ->capture_default_str()
      ->check(whole_number(6, 200));
  sub->add_option("--out", options.out, "calibration file (YAML)")->required();
  sub = add("mount", "find the place of the camera in the head with a chessboard on the ground", kMount, mount);
  add_board(*sub, options);
  sub->add_option("--calibration", options.calibration, "calibration file of the lens")
      ->required()
      ->check(existing_file());
  sub->add_option("--at", options.at_m,
                  "[m] X,Y of the middle of the inner corners: ahead of the head's centre, and to its left")
      ->required()
      ->delimiter(',')
      ->expected(2)
      ->check(number(-10.0, 10.0, "m"));
  sub->add_option("--yaw", options.yaw_deg,
                  "[degrees] 0: the board's rows lie across the robot; positive: turned to the left")
      ->capture_default_str()
      ->check(number(-180.0, 180.0, "degrees"));
  sub->add_option("--robot", options.robot, "robot file")->check(existing_file());
  sub->add_option("--within", options.within_s,
                  "[s] a live source must show the board at most this long after its first picture")
      ->capture_default_str()
      ->check(number(1.0, 3600.0, "s"));
  sub->add_flag("--accept-mount", options.accept_mount,
                "write also a mount that is far from the head, or from the mount of the robot file");
  sub->add_option("--out", options.out, "calibration file with the mount (default: that of --calibration)");
  sub = add("colours", "teach colours from a picture", kColours, colours);
  sub->add_option("--sample", options.samples,
                  "COLOUR=X,Y,WIDTH,HEIGHT: a box in the picture that shows this colour only (" +
                      listed(constants::kColour, msg::kColourUnknown + 1) +
                      ", or ground for what has none); may be repeated")
      ->required()
      ->check(wrong_sample);
  sub->add_option("--calibration", options.calibration, "calibration file: the boxes are then in the rectified picture")
      ->check(existing_file());
  sub->add_option("--out", options.out, "configuration of perception (YAML)")->required();
  app.footer(footer(fmt::format("{}\n{}\n{}\n{}", kShow, kCalibrate, kMount, kColours)));
  struct sigaction action {};
  action.sa_handler = [](int number) { g_signal = number; };
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
  int status = exit_status::kSoftware;
  try {
    const auto finished = parse_command_line(app, argc, argv);
    status = finished ? *finished : chosen(options);
  } catch (const Failed& error) {
    fmt::print(stderr, "camera: {}\n", error.what());
    status = exit_status::kFailed;
  } catch (const ConfigurationError& error) {
    fmt::print(stderr, "camera: {}\n", error.what());
    status = exit_status::kConfiguration;
  } catch (const std::exception& error) {
    fmt::print(stderr, "camera: {}\n", error.what());
  }
  std::fflush(nullptr);
  ::_exit(status);  // a thread may still wait for a source that does not answer
}
