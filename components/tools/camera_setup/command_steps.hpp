// Steps that several subcommands of `constrictor camera` have in common.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "camera_setup/commands.hpp"
#include "camera_setup/frame_reader.hpp"

namespace constrictor::camera_setup {

/// Whether a signal has asked this process to end.
[[nodiscard]] bool stopped();
/// Opens the source. Throws VideoError.
[[nodiscard]] FrameReader reader_of(const Options& options);
/// The next picture; prints what happens to the source meanwhile. Throws VideoError if a live source gives none.
[[nodiscard]] std::optional<cv::Mat> next(FrameReader& reader);

/// Throws Failed if the file cannot be written: before the work whose result it shall hold. An older file stays.
void require_writable(const std::filesystem::path& file);
/// Replaces the file and prints its name. Throws Failed.
void write(const std::filesystem::path& file, const std::string& text);

}  // namespace constrictor::camera_setup
