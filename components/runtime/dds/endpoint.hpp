// Typed DDS readers and writers with the two qualities of service this project knows: member and observer.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "constrictor/text.hpp"
#include "runtime/dds/entity.hpp"

namespace constrictor::dds {

/// Descriptor that idlc made for a message type.
template <class T>
const dds_topic_descriptor_t& descriptor();

#define CONSTRICTOR_DESCRIPTOR(Type)                                     \
  template <>                                                            \
  inline const dds_topic_descriptor_t& descriptor<msg::Type>() {         \
    return constrictor_msg_##Type##_desc;                                \
  }
CONSTRICTOR_DESCRIPTOR(JointState)
CONSTRICTOR_DESCRIPTOR(ContactState)
CONSTRICTOR_DESCRIPTOR(ImuState)
CONSTRICTOR_DESCRIPTOR(JointCommand)
CONSTRICTOR_DESCRIPTOR(SceneDescription)
CONSTRICTOR_DESCRIPTOR(WorldState)
CONSTRICTOR_DESCRIPTOR(TouchedState)
CONSTRICTOR_DESCRIPTOR(CameraInfo)
CONSTRICTOR_DESCRIPTOR(CameraImage)
CONSTRICTOR_DESCRIPTOR(LinePercept)
CONSTRICTOR_DESCRIPTOR(ObjectPercepts)
CONSTRICTOR_DESCRIPTOR(RobotPose)
CONSTRICTOR_DESCRIPTOR(FieldMap)
CONSTRICTOR_DESCRIPTOR(TaskCommand)
CONSTRICTOR_DESCRIPTOR(TaskStatus)
CONSTRICTOR_DESCRIPTOR(TaskEvent)
CONSTRICTOR_DESCRIPTOR(DesiredTrajectory)
CONSTRICTOR_DESCRIPTOR(MotionStatus)
CONSTRICTOR_DESCRIPTOR(Request)
CONSTRICTOR_DESCRIPTOR(Authority)
CONSTRICTOR_DESCRIPTOR(RequestAnswer)
CONSTRICTOR_DESCRIPTOR(MissionStatus)
CONSTRICTOR_DESCRIPTOR(Tick)
CONSTRICTOR_DESCRIPTOR(TickDone)
CONSTRICTOR_DESCRIPTOR(Hello)
CONSTRICTOR_DESCRIPTOR(Ready)
CONSTRICTOR_DESCRIPTOR(EpochStart)
CONSTRICTOR_DESCRIPTOR(Resume)
CONSTRICTOR_DESCRIPTOR(Refused)
CONSTRICTOR_DESCRIPTOR(Waiting)
CONSTRICTOR_DESCRIPTOR(ComponentStatus)
CONSTRICTOR_DESCRIPTOR(RunControl)
CONSTRICTOR_DESCRIPTOR(RunState)
CONSTRICTOR_DESCRIPTOR(MotionCommand)
CONSTRICTOR_DESCRIPTOR(ParameterChange)
CONSTRICTOR_DESCRIPTOR(ParameterList)
#undef CONSTRICTOR_DESCRIPTOR

/// A writer that keeps its last `depth` samples for readers that come late or again. It never blocks: keep-last.
dds_entity_t create_writer(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& topic,
                           int depth, const std::string& user_data);
/// A reader that loses nothing a writer keeps (reliable, keep-all, transient-local).
dds_entity_t create_member_reader(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& topic,
                                  const std::string& user_data);
/// A reader that never holds anybody up (best effort, keep-last `depth`).
dds_entity_t create_observer_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                    const std::string& topic, int depth);

/// Takes everything there is, calling `use(const void* message)` for each valid sample; loans are returned also if it throws.
template <class Use>
void take_all(dds_entity_t reader, Use&& use) {
  constexpr std::size_t kBatch = 32;
  for (;;) {
    std::array<void*, kBatch> messages{};
    std::array<dds_sample_info_t, kBatch> infos{};
    const int count = check(dds_take(reader, messages.data(), infos.data(), kBatch, kBatch), "dds_take");
    if (count == 0) return;
    struct Loan {
      dds_entity_t reader;
      void** messages;
      int count;
      ~Loan() { dds_return_loan(reader, messages, count); }
    } const loan{reader, messages.data(), count};
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (infos[i].valid_data) use(static_cast<const void*>(messages[i]));
    }
    if (count < static_cast<int>(kBatch)) return;
  }
}

template <class T>
class Writer {
 public:
  Writer() = default;
  Writer(dds_entity_t participant, const std::string& topic, int depth, const std::string& user_data = {})
      : entity_(create_writer(participant, descriptor<T>(), topic, depth, user_data), "dds_create_writer") {}
  void write(const T& message) const { check(dds_write(entity_.get(), &message), "dds_write"); }
  /// How many readers it has met.
  [[nodiscard]] int readers() const { return check(dds_get_matched_subscriptions(entity_.get(), nullptr, 0), "dds_get_matched_subscriptions"); }
  [[nodiscard]] dds_entity_t get() const { return entity_.get(); }

 private:
  Entity entity_;
};

template <class T>
class Reader {
 public:
  Reader() = default;
  static Reader member(dds_entity_t participant, const std::string& topic, const std::string& user_data = {}) {
    return Reader(create_member_reader(participant, descriptor<T>(), topic, user_data));
  }
  static Reader observer(dds_entity_t participant, const std::string& topic, int depth = 1) {
    return Reader(create_observer_reader(participant, descriptor<T>(), topic, depth));
  }
  template <class Use>
  void take(Use&& use) const {
    take_all(entity_.get(), [&](const void* message) { use(*static_cast<const T*>(message)); });
  }
  /// How many writers it has met that are still there.
  [[nodiscard]] int writers() const { return check(dds_get_matched_publications(entity_.get(), nullptr, 0), "dds_get_matched_publications"); }
  [[nodiscard]] dds_entity_t get() const { return entity_.get(); }

 private:
  explicit Reader(dds_entity_t handle) : entity_(handle, "dds_create_reader") {}
  Entity entity_;
};

using constrictor::set_text;

/// User data of every endpoint matched with a reader or writer.
std::vector<std::string> matched_user_data(dds_entity_t endpoint, bool is_writer);

}  // namespace constrictor::dds
