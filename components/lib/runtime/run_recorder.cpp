#include "runtime/run_recorder.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>

#include "barrier/topic_ops.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/message_cdr.hpp"
#include "runtime/domain_tap.hpp"
#include "runtime/loaded_libraries.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/recorded_files.hpp"
#include "runtime/version.hpp"
#include "runtime/wire.hpp"

namespace constrictor {
namespace {

namespace wire = barrier_topics;
namespace fs = std::filesystem;

constexpr std::int64_t kBetweenEpochs_ns = 1'000'000'000;
constexpr std::uint64_t kLeftFree = 64 << 20;  // [byte] on the disk, for the other files of the run
constexpr const char* kImage = "CameraImage";

const char* name_of(RecordedImages images) {
  if (images == RecordedImages::kOn) return "on";
  return images == RecordedImages::kOff ? "off" : "recompute";
}

/// "camera=3,planner=2".
std::string latencies(const std::map<std::string, std::uint16_t>& ticks) {
  std::string text;
  for (const auto& [name, count] : ticks) text += fmt::format("{}{}={}", text.empty() ? "" : ",", name, count);
  return text;
}

RecordedChannel channel_of(std::string_view topic, std::string_view type, mcap::Texts metadata) {
  metadata["dds_type"] = "constrictor::msg::" + std::string(type);
  metadata.emplace("keyed", "yes");
  return {std::string(topic), schema_name(type), find_codec(type)->schema(), std::move(metadata)};
}

/// Whether a topic comes over DDS: all others are recorded where the conductor sends or receives them. A Resume is
/// left out, because it is the checkpoint of a member.
bool arrives_over_dds(const std::string& topic) {
  const bool of_members = std::any_of(topics::kInfos.begin(), topics::kInfos.end(),
                                      [&](const TopicInfo& info) { return info.name == topic; });
  return !of_members && topic != wire::kTick.name && topic != wire::kTickDone.name && topic != wire::kResume.name &&
         topic != wire::kEpochStart.name;
}

}  // namespace

RunRecorder::RunRecorder(const HostContext& context, std::optional<RecordingPosition> from)
    : context_(context), file_(context.options.setup.output_dir / kRecordingFile) {
  make_channels();
  auto writer = from ? resume(*from) : begin();
  const bool realtime = context.options.realtime;
  if (context.options.checkpoints && !realtime) {
    const fs::path unwritten = file_.parent_path() / kOpenChunkFile;
    unwritten_ = std::make_unique<mcap::File>(
        unwritten, from && fs::exists(unwritten) ? mcap::File::Mode::kChange : mcap::File::Mode::kCreate);
  }
  sink_ = std::make_unique<RecordingSink>(std::move(writer), realtime);
  std::string identity = context.identity;
  std::replace(identity.begin(), identity.end(), ',', '+');
  try {
    tap_ = std::make_unique<DomainTap>(context.options.domain, identity, arrives_over_dds, context_.log);
  } catch (const std::exception& error) {
    context_.log.warning("topics of clients and other programs are not recorded: {}", error.what());
  }
}

RunRecorder::~RunRecorder() { finish(); }

void RunRecorder::make_channels() {
  for (const auto& topic : topics::kInfos) {
    members_[topic.id] = channel_of(topic.name, topic.type, {{"writer", std::string(topic.writer)}});
    codecs_[topic.id] = find_codec(topic.type);
  }
  tick_ = channel_of(wire::kTick.name, wire::kTick.type, {{"keyed", "no"}});
  tick_done_ = channel_of(wire::kTickDone.name, wire::kTickDone.type, {{"left_out", "checkpoint"}});
  epoch_start_ = channel_of(wire::kEpochStart.name, wire::kEpochStart.type, {{"keyed", "no"}});
}

std::unique_ptr<mcap::Writer> RunRecorder::begin() const {
  auto writer = std::make_unique<mcap::Writer>(file_, "", fmt::format("constrictor {}", kVersion));
  const HostOptions& options = context_.options;
  const auto now = std::chrono::system_clock::now();
  writer->add_metadata(
      {"recording",
       {{"kind", "run"},
        {"log_time", "simulated"},
        {"images", name_of(options.recording.images)},
        {"pace", options.realtime ? "realtime" : "lockstep"},
        {"began", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(now)))},
        {"plant", options.plant},
        {"roster", fmt::format("{}", fmt::join(options.roster, ","))},
        {"robot_id", std::to_string(options.setup.robot_id)},
        {"mission", options.setup.mission},
        {"latency_ticks", latencies(options.latency_ticks)},
        {"max_sim_time_s", fmt::format("{}", options.max_sim_time_s)},
        {"scenario", options.setup.scenario_file.filename().string()},
        {"config_hash", context_.config_hash}}});
  const auto attach = [&](const std::string& name, const fs::path& file) {
    const auto attachment = attached_file(name, file);
    if (!attachment) return context_.log.warning("{} cannot be attached to the recording: no such file", file.string());
    writer->attach(*attachment);
  };
  attach("scenario.yaml", options.setup.scenario_file);
  attach("robot.yaml", options.setup.robot_file);
  for (const auto& [name, file] : options.recording.attachments) attach(name, file);
  writer->attach(attached_versions(numeric_profile(), loaded_libraries()));
  writer->leave_free(kLeftFree);  // from now on a full disk ends the recording, not the run
  return writer;
}

std::unique_ptr<mcap::Writer> RunRecorder::resume(const RecordingPosition& from) {
  base_ns_ = from.base_ns;
  newest_ns_ = from.newest_ns;
  period_ns_ = from.period_ns;
  std::string open;
  if (from.exact) {
    mcap::Reader reader(file_);
    reader.read();
    const auto& chunks = reader.contents().chunks;
    if (chunks.size() < from.chunks)
      throw mcap::Error(fmt::format("{}: found {} chunks, but at the checkpoint it had {} (was it cut or removed?)",
                                    file_.string(), chunks.size(), from.chunks));
    const mcap::File file(file_, mcap::File::Mode::kChange);
    const fs::path unwritten = file_.parent_path() / kOpenChunkFile;
    if (chunks.size() > from.chunks) {
      // The chunk that was open at the checkpoint has been written since then.
      const mcap::ChunkIndex& chunk = chunks[from.chunks];
      std::string buffer;
      const std::string content = file.read(chunk.offset + mcap::kRecordHeader, chunk.length - mcap::kRecordHeader);
      open = mcap::text_of(mcap::uncompress_chunk(mcap::bytes_of(content), buffer));
      // First the copy, then the cut: this process may die, too.
      mcap::File(unwritten, mcap::File::Mode::kCreate).write(0, open);
      file.truncate(chunk.offset);
    } else if (from.open > 0) {
      open = mcap::File(unwritten, mcap::File::Mode::kRead).read(0, from.open);
    }
    if (open.size() < from.open)
      throw mcap::Error(fmt::format("{}: found {} bytes of the open chunk, but at the checkpoint it had {}",
                                    file_.string(), open.size(), from.open));
    open.resize(from.open);
  }
  mcap::Reader reader(file_);
  const auto note = [this](const mcap::Channel& channel, const mcap::Message& message) {
    if (arrives_over_dds(channel.topic)) known_.emplace(channel.topic, message.publish_time);
  };
  reader.read({note, nullptr, nullptr});
  auto writer = std::make_unique<mcap::Writer>(reader);
  writer->leave_free(kLeftFree);
  writer->restore(open);
  mcap::for_each_record(mcap::bytes_of(writer->open_chunk()), [&](mcap::Op op, mcap::Bytes content, std::uint64_t) {
    if (op != mcap::Op::kMessage) return;
    const mcap::Message message = mcap::decode_message(content);
    note(writer->contents().channels.at(message.channel_id), message);
  });
  return writer;
}

void RunRecorder::write(const RecordedMessage& message) {
  if (!sink_) return;
  newest_ns_ = std::max(newest_ns_, static_cast<std::int64_t>(message.log_time_ns));
  sink_->write(message);
  if (const std::string failure = sink_->failure(); !failure.empty()) give_up(failure);
}

template <class T>
void RunRecorder::write(const RecordedChannel& channel, const T& message, std::uint32_t sequence,
                        std::int64_t time_ns) {
  if (!sink_) return;
  static const MessageCodec* const kCodec = find_codec(Description<T>::kName);
  canonical_.clear();
  canonical_bytes(message, canonical_);
  cdr_.clear();
  kCodec->to_cdr(mcap::bytes_of(canonical_), cdr_);
  const auto log_time = static_cast<std::uint64_t>(base_ns_ + time_ns);
  write({&channel, sequence, log_time, log_time, cdr_});
}

void RunRecorder::add(const msg::EpochStart& start) {
  base_ns_ = newest_ns_ == 0 ? 0 : newest_ns_ + kBetweenEpochs_ns;  // so that log times never go back
  tick_index_ = -1;
  write(epoch_start_, start, start.epoch, 0);
}

void RunRecorder::add(const msg::Tick& tick) {
  tick_index_ = tick.index;
  period_ns_ = tick.period_ns;
  write(tick_, tick, static_cast<std::uint32_t>(tick.index), tick.time_ns);
}

void RunRecorder::add(const TickDone& done) {
  if (!sink_) return;
  // Without the checkpoint, which only the conductor needs.
  const TickDone light{done.component, done.epoch,       done.incarnation, done.index, done.published,
                       done.consumed,  done.output_hash, done.end_of_run,  {},         {}};
  std::string none;
  write(tick_done_, to_wire(light, none), static_cast<std::uint32_t>(done.index), done.index * period_ns_);
}

void RunRecorder::add(const TopicInfo& topic, const Sample& sample) {
  canonical_.clear();
  topic_ops(topic.id).append_bytes(sample.message.get(), canonical_);
  add(topic.id, canonical_);
}

void RunRecorder::add(std::uint8_t topic, const std::string& canonical) {
  const TopicInfo& info = topics::kInfos.at(topic);
  const bool is_image = info.type == kImage;
  if (!sink_ || (is_image && context_.options.recording.images == RecordedImages::kOff)) return;
  const auto bytes = std::as_bytes(std::span(canonical));
  const auto header_at = topic_ops(topic).header_at(bytes);
  if (!header_at) return;
  const msg::Header header = parse_header(bytes.subspan(*header_at).first<kHeaderSize>());
  const auto log_time = static_cast<std::uint64_t>(base_ns_ + header.time_ns);
  const bool without_pixels = is_image && context_.options.recording.images == RecordedImages::kRecompute;
  const auto convert = without_pixels ? codecs_[topic]->to_cdr_without_octets : codecs_[topic]->to_cdr;
  cdr_.clear();
  if (!convert(mcap::bytes_of(canonical), cdr_)) return;
  write({&members_[topic], static_cast<std::uint32_t>(header.sequence_number), log_time, log_time, cdr_});
}

void RunRecorder::poll() {
  if (!sink_) return;
  if (tap_) {
    for (const auto& arrived : tap_->take()) {
      if (known_.contains({arrived.channel->topic, arrived.source_time_ns})) continue;
      write({arrived.channel, 0, static_cast<std::uint64_t>(newest_ns_), arrived.source_time_ns, arrived.cdr});
    }
  }
  if (!sink_) return;
  sink_->poll();
  if (const std::string failure = sink_->failure(); !failure.empty()) give_up(failure);
}

RecordingPosition RunRecorder::position() {
  if (!sink_) return {};
  if (!unwritten_) return {true, false, 0, 0, base_ns_, newest_ns_, period_ns_};
  try {
    store_open_chunk();
  } catch (const mcap::Error& error) {
    give_up(error.what());
    return {};
  }
  const mcap::Writer& writer = sink_->writer();
  return {true, true, writer.chunks(), writer.open_chunk().size(), base_ns_, newest_ns_, period_ns_};
}

void RunRecorder::store_open_chunk() {
  const mcap::Writer& writer = sink_->writer();
  if (unwritten_chunk_ != writer.chunks()) {
    unwritten_chunk_ = writer.chunks();
    unwritten_size_ = 0;
  }
  unwritten_->write(unwritten_size_, writer.open_chunk().substr(unwritten_size_));
  unwritten_size_ = writer.open_chunk().size();
}

void RunRecorder::give_up(const std::string& reason) {
  context_.log.error("{}; the recording ends at tick {}, and the run goes on without it", reason, tick_index_);
  if (!sink_) return;
  unwritten_.reset();
  fs::remove(file_.parent_path() / kOpenChunkFile);  // first: its space may be all that the end of the file needs
  sink_->finish({{"dropped", {{"tick", std::to_string(tick_index_)}, {"reason", reason}}}});
  sink_.reset();
}

void RunRecorder::finish() {
  poll();
  if (!sink_) return;
  tap_.reset();
  unwritten_.reset();
  if (const std::string failure = sink_->finish({}); !failure.empty())
    context_.log.error("{}; the end of the recording is missing", failure);
  sink_.reset();
  fs::remove(file_.parent_path() / kOpenChunkFile);
}

}  // namespace constrictor
