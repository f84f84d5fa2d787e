// The parameters of the driver of a real camera: one row each. video_capture.yaml and the table in README.md follow
// from the rows.
#pragma once

#include <string>

#include "configuration/parameter_set.hpp"

namespace constrictor {

struct VideoCaptureConfig : ParameterSet {
  std::string source =
      add(source, "source", "camera_emulator.url", {},
          "Device, address, pipeline of GStreamer, file NAME.url, video, picture, or folder of pictures");
  std::string calibration = add(calibration, "calibration", "none", {},
                                "Calibration file (constrictor camera calibrate); none: the camera of the robot file");
  int image_width = add(image_width, "image.width", 0, "pixels", {0, 4096}, kAtStart,
                        "Width of the published images; 0: as calibrated");
  int image_height = add(image_height, "image.height", 0, "pixels", {0, 4096}, kAtStart,
                         "Height of the published images; 0: as calibrated");
  double frame_rate_hz = add(frame_rate_hz, "stream.frame_rate_hz", 10.0, "Hz", {0.5, 240.0}, kAtStart,
                             "Frames in a second: asked of a device, promised by a stream, shown of a file");
  int stream_width = add(stream_width, "stream.width", 0, "pixels", {0, 4096}, kAtStart,
                         "Width that is asked of a device; 0: the device chooses");
  int stream_height = add(stream_height, "stream.height", 0, "pixels", {0, 4096}, kAtStart,
                          "Height that is asked of a device; 0: the device chooses");
  double delay_s = add(delay_s, "stream.delay_s", 0.0, "s", {0.0, 2.0}, kAtStart,
                       "Time from the exposure of a frame until this host receives it");
  double late_after_s = add(late_after_s, "stream.late_after_s", 0.5, "s", {0.02, 10.0}, kAtStart,
                            "A frame that was exposed longer ago than this is not published");
  double gone_after_s = add(gone_after_s, "stream.gone_after_s", 1.0, "s", {0.1, 60.0}, kAtStart,
                            "Without a frame for so long, the camera is reported as gone");
  double timeout_s = add(timeout_s, "stream.timeout_s", 1.0, "s", {0.2, 30.0}, kAtStart,
                         "A source that is silent for so long is closed and opened again");
  double retry_s =
      add(retry_s, "stream.retry_s", 0.5, "s", {0.05, 60.0}, kAtStart, "Pause before a source is opened again");
  bool lock_exposure =
      add(lock_exposure, "device.lock_exposure", true, "Switch the automatic exposure of a device off");
  double exposure_ms = add(exposure_ms, "device.exposure_ms", 0.0, "ms", {0.0, 1000.0}, kAtStart,
                           "Exposure of a device; 0: as the automatic control has left it");
  bool lock_white_balance =
      add(lock_white_balance, "device.lock_white_balance", true, "Switch the automatic white balance of a device off");
  double white_balance_k = add(white_balance_k, "device.white_balance_k", 0.0, "K", {0.0, 15000.0}, kAtStart,
                               "White balance of a device; 0: as the automatic control has left it");
  bool lock_focus = add(lock_focus, "device.lock_focus", true, "Switch the automatic focus of a device off");
  bool repeat = add(repeat, "file.repeat", false, "Begin a video or folder again after its last picture");

  void complete(const Configuration& root) const {
    if ((image_width == 0) != (image_height == 0))
      throw root.error("image", "found one of width and height, accepted both or neither");
    if (delay_s >= late_after_s)
      throw root.error("stream.late_after_s",
                       "found no more than stream.delay_s, accepted more: every frame would be late");
  }
};

}  // namespace constrictor
