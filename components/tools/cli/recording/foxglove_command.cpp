// `constrictor foxglove`: a copy of a recording with the topics that viewers draw.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "cli/recording/recorded_messages.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "common/interrupt.hpp"
#include "common/progress_display.hpp"
#include "configuration/counted.hpp"
#include "configuration/whole_file.hpp"
#include "recording/mcap_copy.hpp"
#include "runtime/host.hpp"
#include "views/recorded_views.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

struct FoxgloveOptions {
  std::string file, output = "foxglove.mcap";
  bool force = false;
};

/// Ctrl-C: no file is left.
class ExportInterrupted {};

bool is_view(const std::string& topic) {
  return std::any_of(views::kViewTopics.begin(), views::kViewTopics.end(),
                     [&](const views::ViewTopic& view) { return view.topic == topic; });
}

class CopyForViewers {
 public:
  CopyForViewers(const fs::path& from, const fs::path& to) : reader_(from), copy_(to, reader_) {
    for (const views::ViewTopic& topic : views::kViewTopics) {
      const auto schema = copy_.writer().add_schema(topic.schema_name, topic.schema_encoding, topic.schema);
      view_channels_.push_back(copy_.writer().add_channel(schema, topic.topic, topic.encoding));
    }
  }

  void make() {
    mcap::Visitor visitor;
    visitor.message = [this](const mcap::Channel& channel, const mcap::Message& message) { take(channel, message); };
    visitor.attachment = [this](const mcap::Attachment& attachment) { copy_.copy(attachment); };
    visitor.metadata = [this](const mcap::Metadata& metadata) { copy_.copy(metadata); };
    reader_.read(visitor);
    copy_.finish();
  }
  /// Why the recording is incomplete; empty: it is complete.
  [[nodiscard]] const std::string& incomplete() const { return reader_.incomplete(); }
  [[nodiscard]] std::uint64_t views() const { return views_count_; }
  [[nodiscard]] std::uint64_t images() const { return images_; }
  [[nodiscard]] std::uint64_t size() const { return copy_.writer().size(); }

 private:
  void take(const mcap::Channel& channel, const mcap::Message& message) {
    if (interrupt_signal() != 0) throw ExportInterrupted();
    if (is_view(channel.topic)) return;  // of a recording that is such a copy: they are made again
    copy_.copy(channel, message);
    made_.take(channel.topic, message.data, message.log_time);
    if (++messages_ % 1000 == 0)
      progress_.show_status(fmt::format("foxglove: {} messages copied, {} added", messages_, views_count_));
  }
  void add(views::View view, std::uint64_t time_ns, std::string_view data) {
    ++views_count_;
    if (view == views::View::kCamera) ++images_;
    mcap::Message message;
    message.channel_id = view_channels_.at(static_cast<std::size_t>(view));
    message.sequence = static_cast<std::uint32_t>(views_count_);
    message.log_time = message.publish_time = time_ns;
    message.data = mcap::bytes_of(data);
    copy_.writer().write(message);
  }

  mcap::Reader reader_;
  mcap::Copy copy_;
  std::vector<std::uint16_t> view_channels_;  ///< in the order of views::View
  views::RecordedViews made_{
      [this](views::View view, std::uint64_t time_ns, std::string_view data) { add(view, time_ns, data); }};
  std::uint64_t messages_ = 0, views_count_ = 0, images_ = 0;
  ProgressDisplay progress_;
};

int foxglove(const FoxgloveOptions& options) {
  const fs::path recording = recording_or_throw(options.file);
  std::error_code ignored;
  if (fs::equivalent(recording, options.output, ignored))
    throw UsageError(fmt::format("--output: found {}, the recording itself, accepted another file", options.output));
  if (fs::is_directory(options.output))
    throw UsageError(fmt::format("--output: found {}, a folder, accepted a file", options.output));
  if (!options.force && fs::exists(options.output))
    throw UsageError(fmt::format("--output: found {}, which exists, accepted a new file (or --force)", options.output));
  catch_interrupts();
  NewFile file = NewFile::of_this_process(options.output);
  try {
    CopyForViewers copy(recording, file.part());
    copy.make();
    file.complete();
    ProgressDisplay().print(fmt::format("wrote {}: {:.1f} MB, with {} for viewers", options.output,
                                        static_cast<double>(copy.size()) * 1e-6, counted(copy.views(), "message")));
    if (copy.images() == 0)
      fmt::print(
          "it has no camera images, because the recording has none; `constrictor replay --restore` computes "
          "those of a simulated run again\n");
    if (!copy.incomplete().empty()) fmt::print("the recording is incomplete: {}\n", copy.incomplete());
    return exit_status::kOk;
  } catch (const ExportInterrupted&) {
    ProgressDisplay().print("foxglove: interrupted; nothing was written");
    return interrupt_status();
  }
}

}  // namespace

void add_foxglove(CLI::App& app, Action& action) {
  auto options = std::make_shared<FoxgloveOptions>();
  auto* sub = add_subcommand(app, "foxglove", "copy a recording and add the 3D scene, images and log for Foxglove",
                             action, options, foxglove);
  sub->add_option("FILE", options->file, kFileMeaning)->required()->check(existing_path());
  sub->add_option("-o,--output", options->output, "file to write (MCAP)")->capture_default_str();
  sub->add_flag("--force", options->force, "replace the file if it exists, when the copy is complete");
  sub->footer(help_footer(
      "Foxglove and Lichtblick open every recording and can plot its numbers. The copy also has the topics that the\n"
      "dashboard makes for them (view/scene, view/camera, view/annotations ...), so that they show the scene in 3D, "
      "the\n"
      "images with what perception found, and the log. Import foxglove_layout.json for a layout with all of it.",
      {"constrictor foxglove runs/NAME", "constrictor foxglove run.mcap --output seen.mcap"},
      "0 done; 64 wrong usage; 70 the file cannot be written, the disk is full, or the recording is damaged; 130\n"
      "  Ctrl-C, 143 SIGTERM: nothing is left",
      "none"));
}

}  // namespace constrictor::cli
