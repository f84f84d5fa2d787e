// All topics as C++ constants, made from topic_table.def.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Facts about one member topic that do not depend on its message type.
struct TopicInfo {
  std::uint8_t id;            ///< index in Tick.visible
  std::string_view name;      ///< DDS topic name
  std::string_view type;      ///< IDL type
  std::string_view writer;    ///< the one component that writes it
  std::uint8_t max_per_tick;  ///< most samples that a step of the writer may write
  std::uint16_t depth;        ///< DDS history depth, also for restarted readers
  bool simulation_only;       ///< ground truth: no component of components/ may read it
  std::string_view rate;      ///< for people
  std::string_view doc;       ///< one line for people
};

/// A topic of members with its message type; ports are made from it.
template <class Message>
struct Topic : TopicInfo {
  using message_type = Message;
};

/// Facts about a topic whose samples no tick counts.
struct UncountedTopicInfo {
  const char* name;          ///< DDS topic name
  std::string_view type;     ///< IDL type
  std::string_view writers;  ///< for people
  std::string_view readers;  ///< for people
  int depth;                 ///< DDS history depth of each writer, for each key
  std::string_view rate;     ///< for people
  std::string_view doc;      ///< one line for people
  /// The DDS topic name.
  operator std::string() const { return name; }            // NOLINT(google-explicit-constructor)
  constexpr operator const char*() const { return name; }  // NOLINT(google-explicit-constructor)
};

/// Such a topic with its message type.
template <class Message>
struct UncountedTopic : UncountedTopicInfo {
  using message_type = Message;
};

namespace topics {

/// Numbers of the rows.
namespace row {
enum Row : std::uint8_t {
#define CONSTRICTOR_MEMBER_TOPIC(constant, ...) constant,
#include "constrictor/topic_table.def"
#undef CONSTRICTOR_MEMBER_TOPIC
  kCount
};
}  // namespace row

inline constexpr bool kRobot = false;
inline constexpr bool kSimulation = true;

#define CONSTRICTOR_MEMBER_TOPIC(constant, Type, name, writer, samples, steps, world, rate, doc) \
  inline constexpr Topic<msg::Type> constant{                                                    \
      {row::constant, name, #Type, writer, samples, (samples) * (steps), world, rate, doc}};
#include "constrictor/topic_table.def"
#undef CONSTRICTOR_MEMBER_TOPIC

/// Every member topic, by id.
inline constexpr std::tuple kAll{
#define CONSTRICTOR_MEMBER_TOPIC(constant, ...) constant,
#include "constrictor/topic_table.def"
#undef CONSTRICTOR_MEMBER_TOPIC
};
inline constexpr std::size_t kCount = row::kCount;
static_assert(kCount <= msg::kMaxTopics);

/// The member topics without types, for tools and messages to people.
inline constexpr std::array<TopicInfo, kCount> kInfos =
    std::apply([](const auto&... topic) { return std::array<TopicInfo, kCount>{TopicInfo(topic)...}; }, kAll);

}  // namespace topics

/// Topics whose samples no tick counts: the barrier's own, and those between clients and the run.
namespace barrier_topics {

#define CONSTRICTOR_UNCOUNTED_TOPIC(constant, Type, name, writers, readers, depth, rate, doc) \
  inline constexpr UncountedTopic<msg::Type> constant{{name, #Type, writers, readers, depth, rate, doc}};
#include "constrictor/topic_table.def"
#undef CONSTRICTOR_UNCOUNTED_TOPIC

inline constexpr UncountedTopicInfo kInfos[] = {
#define CONSTRICTOR_UNCOUNTED_TOPIC(constant, ...) constant,
#include "constrictor/topic_table.def"
#undef CONSTRICTOR_UNCOUNTED_TOPIC
};

}  // namespace barrier_topics
}  // namespace constrictor
