// The part of ConductorSide that stores checkpoints, and continues from one.
#include <fmt/format.h>
#include <cereal/types/set.hpp>
#include <cereal/types/string.hpp>

#include <algorithm>
#include <stdexcept>

#include "component/plant_stop.hpp"
#include "configuration/configuration.hpp"
#include "constrictor/archive.hpp"
#include "runtime/conductor_side.hpp"
#include "runtime/member_side.hpp"

namespace constrictor {
namespace {

constexpr auto kStay = std::chrono::seconds(30);
// A successor that starts after the final tick may not know which members have ended. Members that still run announce
// themselves within this time.
constexpr auto kSuccessorStays = std::chrono::seconds(3);

}  // namespace

void ConductorSide::open_store() {
  const HostOptions& options = context_.options;
  const bool first = options.incarnation == 1;
  if (options.checkpoints && !options.setup.output_dir.empty()) {
    store_ = std::make_unique<RunStore>(options.setup.output_dir, first, context_.log);
  } else if (!first) {
    throw ConfigurationError(fmt::format(
        "--incarnation: found {}, accepted 1: {} keeps no checkpoint (--output and no --no-checkpoints), so that its "
        "process cannot continue a run",
        options.incarnation, options.plant));
  }
}

void ConductorSide::save() {
  if (!store_) return;
  flush_hash_log();
  if (!control_answers_bytes_)
    control_answers_bytes_ = std::make_shared<const std::string>(save_bytes(control_answers_));
  checkpoint_ = conductor_->save(std::move(checkpoint_));
  const RecordingPosition recording = recorder_ ? recorder_->position() : RecordingPosition{};
  const StopOrders::Arrived stops = plant_.stop_orders() ? plant_.stop_orders()->waiting() : StopOrders::Arrived{};
  BytesWriter head(std::move(head_of_conductor_));
  head(checkpoint_.head, hash_log_ ? hash_log_->length() : 0, recording, pacer_, ended_, stops);
  head_of_conductor_ = std::exchange(checkpoint_.head, head.take());
  checkpoint_.blobs.push_back(control_answers_bytes_);
  store_->write(checkpoint_);
}

void ConductorSide::make_successor(ConductorOptions options, const Checkpoint& found) {
  Checkpoint of_conductor = found;
  std::uint64_t log_length = 0;
  RecordingPosition recording;
  StopOrders::Arrived stops;
  options.run_id = context_.options.run_id;  // 0: that of the checkpoint
  try {
    load_bytes(found.head, of_conductor.head, log_length, recording, pacer_, ended_, stops);
    if (found.blobs.empty()) throw std::runtime_error("the checkpoint is incomplete");
    load_bytes(*found.blobs.back(), control_answers_);
  } catch (const cereal::Exception& error) {
    throw std::runtime_error(fmt::format("the checkpoint is of another release: {}", error.what()));
  }
  of_conductor.blobs.pop_back();
  if (plant_.stop_orders()) plant_.stop_orders()->restore(std::move(stops));
  conductor_ = std::make_unique<Conductor>(std::move(options), static_cast<ConductorSink&>(*this), of_conductor);
  if (log_length > 0) hash_log_ = std::make_unique<HashLog>(context_.options.setup.output_dir, log_length);
  if (recording.recording) open_recording(recording);
}

void ConductorSide::open_recording(std::optional<RecordingPosition> from) {
  const HostOptions& options = context_.options;
  if (!options.recording.record || options.setup.output_dir.empty()) return;
  try {
    recorder_ = std::make_unique<RunRecorder>(context_, from);
  } catch (const mcap::Error& error) {
    if (!from) throw;
    context_.log.error("{}; the recording ends here, and the run goes on without it", error.what());
  }
}

void ConductorSide::take_status(const msg::ComponentStatus& status) {
  const auto epoch = conductor_->epoch();
  if (status.state != msg::kComponentEnded || !epoch || EpochId{status.run_id, status.epoch} != *epoch) return;
  if (ended_.insert(status.component).second) save();
}

void ConductorSide::stay_longer() { stays_until_ = HostContext::Clock::now() + kStay; }

bool ConductorSide::stays() {
  // Without a launcher, no process restarts a member.
  if (!store_ || context_.options.run_id == 0 || !conductor_->ended()) return false;
  const auto now = HostContext::Clock::now();
  if (!stays_until_) {
    stays_until_ = now + (context_.options.incarnation > 1 ? kSuccessorStays : kStay);
    members_.publish_last_statuses();  // they show the launcher that the run is over
  }
  context_.note_progress();
  return now < *stays_until_ && !all_ended();
}

bool ConductorSide::all_ended() const {
  const auto& roster = context_.options.roster;
  return std::all_of(roster.begin(), roster.end(),
                     [this](const std::string& name) { return ended_.contains(name) || members_.hosts(name); });
}

void ConductorSide::flush_hash_log() {
  if (!hash_log_) return;
  if (const std::string failure = hash_log_->flush(); !failure.empty())
    context_.log.error("{}; from here on the run is not logged, and `constrictor diff` cannot compare it", failure);
}

}  // namespace constrictor
