// The part of Conductor that saves its whole state, and continues from a saved state.
#include <fmt/format.h>
#include <cereal/types/array.hpp>
#include <cereal/types/deque.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>

#include <algorithm>
#include <stdexcept>

#include "barrier/conductor.hpp"
#include "constrictor/archive.hpp"

namespace constrictor {
namespace {

/// Writes blobs into a list, and their places in it between the numbers and texts.
struct Writer {
  explicit Writer(Checkpoint memory) : archive(std::move(memory.head)), blobs(std::move(memory.blobs)) {
    blobs.clear();
  }
  BytesWriter archive;
  std::vector<Blob> blobs;

  template <class... T>
  void values(const T&... values) {
    archive(values...);
  }
  void blob(const Blob& blob) {
    archive(static_cast<std::uint32_t>(blob ? blobs.size() + 1 : 0));
    if (blob) blobs.push_back(blob);
  }
};

/// The inverse. Throws cereal::Exception if the numbers end too early, or std::runtime_error if a blob is missing.
struct Reader {
  explicit Reader(const Checkpoint& checkpoint) : archive(checkpoint.head), blobs(checkpoint.blobs) {}
  BytesReader archive;
  const std::vector<Blob>& blobs;

  template <class... T>
  void values(T&... values) {
    archive(values...);
  }
  void blob(Blob& blob) {
    std::uint32_t place = 0;
    archive(place);
    if (place > blobs.size()) throw std::runtime_error("checkpoint of the conductor: a part is missing");
    blob = place == 0 ? nullptr : blobs[place - 1];
  }
};

void require_equal(const char* what, const std::string& found, const std::string& accepted) {
  if (found == accepted) return;
  throw std::runtime_error(
      fmt::format("the checkpoint belongs to another run: {}: found '{}', accepted '{}'", what, found, accepted));
}

}  // namespace

/// One walk over the state for both directions, so that they cannot differ.
struct Conductor::Archived {
  template <class Archive, class Container>
  static void size_of(Archive& archive, Container& container) {
    auto size = static_cast<std::uint32_t>(container.size());
    archive.values(size);
    if constexpr (!std::is_const_v<Container>) container.resize(size);
  }

  template <class Archive>
  static void hello(Archive& archive, Hello& h) {
    std::uint64_t reads = h.reads.bits();
    std::uint64_t writes = h.writes.bits();
    archive.values(h.component, h.run_id, h.incarnation, h.pid, h.host, h.release, h.idl_hash, h.config_hash,
                   h.component_hash, h.numeric_profile, h.timing.period, h.timing.latency, reads, writes);
    h.reads = TopicSet::from_bits(reads);
    h.writes = TopicSet::from_bits(writes);
  }

  template <class Archive>
  static void member(Archive& archive, MemberState& m) {
    hello(archive, m.hello);
    archive.values(m.hello_received, m.ready, m.last_done, m.published, m.output_hash, m.state_index);
    archive.blob(m.state);
    size_of(archive, m.pending);
    for (Pending& step : m.pending) archive.values(step.index, step.incarnation, step.published, step.output_hash);
    for (std::size_t topic = 0; topic < topics::kCount; ++topic) {
      if (!m.hello.writes.contains(topic)) continue;
      auto& samples = m.history[static_cast<std::uint8_t>(topic)];
      size_of(archive, samples);
      for (Blob& sample : samples) archive.blob(sample);
    }
  }

  template <class Archive>
  static void rest(Archive& archive, Conductor& c) {
    EpochId epoch = c.epoch_.value_or(EpochId{});
    archive.values(epoch.run_id, epoch.epoch, c.seed_, c.next_index_, c.ended_, c.end_requested_at_, c.visible_,
                   c.incarnations_);
    if (epoch.epoch > 0) c.epoch_ = epoch;
    size_of(archive, c.ticks_);
    for (msg::Tick& tick : c.ticks_) {
      // A plain struct of numbers; only the same release on the same kind of machine reads it.
      auto bytes = cereal::binary_data(&tick, sizeof tick);
      archive.values(bytes);
    }
    for (auto& [name, each] : c.members_) member(archive, each);
  }
};

Checkpoint Conductor::save(Checkpoint memory) const {
  static_assert(std::is_trivially_copyable_v<msg::Tick>);
  Writer writer(std::move(memory));
  writer.values(options_.release, options_.run_id, options_.roster, options_.plant, options_.idl_hash,
                options_.config_hash, options_.numeric_profile, options_.period_ns, options_.realtime);
  Archived::rest(writer, const_cast<Conductor&>(*this));  // writing changes nothing
  return {writer.archive.take(), std::move(writer.blobs)};
}

Conductor::Conductor(ConductorOptions options, ConductorSink& sink, const Checkpoint& checkpoint)
    : Conductor(std::move(options), sink) {
  Reader reader(checkpoint);
  try {
    ConductorOptions found;
    reader.values(found.release, found.run_id, found.roster, found.plant, found.idl_hash, found.config_hash,
                  found.numeric_profile, found.period_ns, found.realtime);
    require_equal("release", found.release, options_.release);
    if (options_.run_id == 0) options_.run_id = found.run_id;
    require_equal("run id", std::to_string(found.run_id), std::to_string(options_.run_id));
    require_equal("IDL hash", found.idl_hash, options_.idl_hash);
    require_equal("configuration hash", found.config_hash, options_.config_hash);
    require_equal("numeric profile", found.numeric_profile, options_.numeric_profile);
    require_equal("roster", fmt::format("{}", fmt::join(found.roster, ",")),
                  fmt::format("{}", fmt::join(options_.roster, ",")));
    require_equal("plant", found.plant, options_.plant);
    require_equal("period in ns", std::to_string(found.period_ns), std::to_string(options_.period_ns));
    require_equal("real-time pace", std::to_string(found.realtime), std::to_string(options_.realtime));
    Archived::rest(reader, *this);
  } catch (const cereal::Exception& error) {
    throw std::runtime_error(fmt::format("checkpoint of the conductor: {}", error.what()));
  }
  successor_ = awaits_plant_ = true;
  MemberState& owner = members_.at(options_.plant);
  if (next_index_ > 0 && !owner.state) throw std::runtime_error("the checkpoint contains no state of the plant");
  // The plant died with this conductor's predecessor. It repeats the steps that its checkpoint does not contain.
  owner.last_done = owner.state_index;
  std::erase_if(owner.pending, [&](const Pending& step) { return step.index > owner.last_done; });
}

void Conductor::continue_epoch() {
  if (successor_ && epoch_) sink_.continue_epoch(*epoch_, seed_, {ticks_.begin(), ticks_.end()});
}

}  // namespace constrictor
