// Which messages of other processes a process of the run accepts: those of the processes that have announced themselves
// as a member of the run by Hello.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cyclone/writer_book.hpp"

namespace constrictor {

/// A member's messages come from the participant that has sent its Hello. A message that arrives before the Hello waits
/// for it. Not thread-safe, the book aside.
class Admission {
 public:
  /// Bounds on what waits for the Hello of its writer. For each writer, so that none can use up the room of another.
  static constexpr std::size_t kMostMessages = 1024;
  static constexpr std::size_t kMostBytes = 8u << 20;
  static constexpr std::size_t kMostWriters = 64;

  /// To be called for each Hello that was found to be of this run, before its content is used. Returns false if another
  /// living participant has announced the member with the same or a higher incarnation: the Hello must be ignored.
  bool announce(const std::string& component, std::uint32_t incarnation, const dds::GuidPrefix& participant);

  /// Whether a participant that has announced the component is in the domain. One that was killed counts until its
  /// lease lapses.
  [[nodiscard]] bool lives(const std::string& component) const;

  enum class Verdict {
    kAccepted,
    kUnknown,   ///< no participant has announced this member yet
    kStranger,  ///< the writer is not in the participant that has announced it, or not yet
  };
  [[nodiscard]] Verdict judge(const std::string& component, dds_instance_handle_t writer);
  /// Whether keep() has room for a message of this writer.
  [[nodiscard]] bool has_room(dds_instance_handle_t writer, std::size_t bytes) const;
  /// Keeps a message whose verdict is not kAccepted, and calls `deliver` when the participant of its writer announces
  /// the member. When a restarted process takes the place of a member, its first messages may arrive before its Hello,
  /// because they come from other writers than the Hello. If another participant announces the member, the message is
  /// dropped. Returns false, and drops the message, if there is no room.
  bool keep(const std::string& component, dds_instance_handle_t writer, std::size_t bytes,
            std::function<void()> deliver);

  dds::WriterBook& book() { return book_; }

 private:
  struct Announced {
    std::uint32_t incarnation = 0;
    /// The participants of the member's incarnations, newest first. Earlier ones are accepted, too: their last samples
    /// may arrive late.
    std::vector<dds::GuidPrefix> participants;
    /// Other participants of the same incarnation, ignored while the announced one is alive. The conductor may have
    /// accepted another one of them first than this process; those that it refuses end.
    std::vector<dds::GuidPrefix> rivals;
  };
  struct Waiting {
    std::string component;
    dds_instance_handle_t writer = 0;
    std::size_t bytes = 0;
    std::function<void()> deliver;
  };
  struct Load {
    std::size_t messages = 0;
    std::size_t bytes = 0;
  };
  void deliver_waiting(const std::string& component);

  dds::WriterBook book_;
  std::map<std::string, Announced> announced_;
  std::deque<Waiting> waiting_;
  std::map<dds_instance_handle_t, Load> load_;
};

}  // namespace constrictor
