// `constrictor figure` and `constrictor film`: what the command passes to the program `pictures`, and what this does.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/figure/canvas.hpp"

namespace constrictor::pictures {

struct FigureOptions {
  std::filesystem::path file;
  std::filesystem::path output;
  figure::Format format = figure::Format::kPng;
  double width = 0.0;                ///< [pixel], for PDF [point]; 0: that of the figure at the end of a run
  std::vector<double> at_s;          ///< moments
  std::vector<std::uint8_t> events;  ///< msg::kEvent…: a moment for each occurrence
};

struct FilmOptions {
  std::filesystem::path file;
  std::filesystem::path output;
  double speed = 1.0;  ///< times the robot's time
  std::optional<double> from_s, to_s;
  double rate_hz = 25.0;
  int width = 1280, height = 720;
  std::size_t jobs = 1;  ///< frames drawn at a time
};

/// Both return the exit status and print what they have made. Throw NoPicture, mcap::Error or std::runtime_error.
int make_figure(const FigureOptions& options);
int make_film(const FilmOptions& options);

/// Throws Interrupted after a signal.
void check_interrupt();
struct Interrupted {};

/// Throws std::runtime_error if no file can be made at `file`. Leaves nothing.
void require_writable(const std::filesystem::path& file);

}  // namespace constrictor::pictures
