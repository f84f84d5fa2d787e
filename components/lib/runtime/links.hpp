// The DDS side of one process: its participant, and a wait that calls a function when a reader has samples.
#pragma once

#include <atomic>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "constrictor/reflect.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/mailbox.hpp"
#include "runtime/admission.hpp"
#include "runtime/arrivals.hpp"

namespace constrictor {

class Links {
 public:
  /// Receives the reason why a message on a topic was rejected.
  using Reject = std::function<void(const std::string& topic, const std::string& reason)>;

  /// Joins `domain`, in a secured run with this identity. Writers do not wait for readers when they are deleted: call
  /// dds::wait_for_acknowledgements() before. Throws what dds::Domain throws.
  Links(std::uint32_t domain, const std::string& identity);
  [[nodiscard]] dds_entity_t participant() const { return participant_.get(); }

  /// Sets the function that receives rejections. Must be called before the first message is taken.
  void on_rejected(Reject reject) { reject_ = std::move(reject); }
  /// When the samples of a reader end a wait().
  enum class Wakes {
    kAlways,
    kIfWanted,  ///< only while the process needs them at once; else they are taken after the next wait
  };

  /// Calls `take` when `reader` has samples. The reader must not outlive this object.
  void attach(dds_entity_t reader, std::function<void()> take, Wakes wakes = Wakes::kAlways);
  /// Calls `use(message)` for each message that obeys its IDL; others are rejected. Both `reader` and what `use` refers
  /// to must outlive the last wait().
  template <class T, class Use>
  void attach(const dds::Reader<T>& reader, const char* topic, Use use) {
    attach(reader.get(), [this, &reader, topic, use = std::move(use)] {
      reader.take([&](const T& message) {
        if (const auto violation = validate(message)) return reject_(topic, *violation);
        use(message);
      });
    });
  }

  /// The same for messages of members: `writer_of(message)` is the component that must have written it. Messages of a
  /// process that has not announced this component wait for its Hello; if another process has announced it, they are
  /// counted as rejected at once, because they may be a stranger's.
  template <class T, class WriterOf, class Use>
  void attach(const dds::Reader<T>& reader, const char* topic, WriterOf writer_of, Use use) {
    attach(reader.get(), [this, &reader, topic, writer_of = std::move(writer_of), use = std::move(use)] {
      reader.take_from([&](const T& message, dds_instance_handle_t writer) {
        if (const auto violation = validate(message)) return reject_(topic, *violation);
        const std::string component = writer_of(message);
        const Admission::Verdict verdict = admission_.judge(component, writer);
        if (verdict == Admission::Verdict::kAccepted) return use(message);
        T found = message;
        reflect::OctetsFinder octets;
        Description<T>::visit(found, octets);
        const std::size_t bytes = sizeof(T) + (octets.found ? octets.found->_length : 0);
        const bool room = admission_.has_room(writer, bytes);
        if (room) admission_.keep(component, writer, bytes, [copy = share_copy(message), use] { use(*copy); });
        if (!room || verdict == Admission::Verdict::kStranger) reject_(topic, kNotAnnounced);
      });
    });
  }
  static constexpr const char* kNotAnnounced = "writer: found a process that has not announced itself as this member";
  [[nodiscard]] Admission& admission() { return admission_; }

  /// Ends the present or else the next wait(). Any thread may call it.
  void wake();
  /// Lets the samples of a reader end a wait() only when there are so many more of them than at the last wait(), until
  /// one of them was taken. It saves switches between threads when the samples are useful only together.
  void expect(dds_entity_t reader, std::size_t samples);
  /// From now on, the thread that receives takes during a wait() what has arrived, and calls `turn` then: that saves a
  /// switch between threads. The wait() ends only if `turn` returns true; what `turn` throws, wait() throws. `turn` and
  /// the thread of wait() never run at the same time. Must be called by the thread of wait(), before the first wait().
  void let_receiver_turn(std::function<bool()> turn);
  /// Whether readers with Wakes::kIfWanted matter from now on. Only wait() and `turn` may call it.
  void want(bool wanted);
  /// Takes everything that has arrived.
  void take_all();
  /// Waits until a message arrives or wake() is called, for at most `bound_ns`, and takes everything that has arrived.
  /// `wanted`: whether readers with Wakes::kIfWanted end the wait.
  void wait(dds_duration_t bound_ns, bool wanted);

 private:
  /// Takes from the readers that have samples.
  void take_arrived();
  /// In the thread that receives: takes and turns, unless the thread of wait() is active.
  void turn_in_receiver();

  /// What the listener of a reader is given.
  struct Place {
    Arrivals* arrivals;
    std::size_t source;
  };
  struct Attached {
    dds_entity_t reader;
    std::function<void()> take;
    Place place;
  };

  Arrivals arrivals_;              // before the participant: the listeners of its readers use it
  std::deque<Attached> attached_;  ///< index: the source in arrivals_. The listeners point to the elements
  Arrivals::Sources always_ = 0;   ///< the readers with Wakes::kAlways
  std::optional<dds::Mailbox::EmptiedAtOnce> emptied_at_once_{std::in_place};  ///< while inputs are wanted
  Admission admission_;  // before the participant: the readers of this process note their writers in it
  dds::Entity domain_;
  dds::Entity participant_;
  Reject reject_;

  std::function<bool()> turn_;
  std::mutex active_mutex_;  ///< held by the thread of wait() except while it waits, and during a turn
  std::unique_lock<std::mutex> active_;
  std::atomic<bool> receiver_turns_ = false;
  std::atomic<Arrivals::Sources> mattering_ = 0;
  std::exception_ptr thrown_;                                  ///< by turn_
  std::optional<dds::Mailbox::BeforeWaiting> before_waiting_;  // last: it calls the others
};

}  // namespace constrictor
