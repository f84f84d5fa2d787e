#include "barrier/topic_ops.hpp"

#include "constrictor/reflect.hpp"

namespace constrictor {
namespace {

template <class T>
TopicOps make_ops(const Topic<T>& topic) {
  TopicOps ops{topic, sizeof(T), nullptr, nullptr, nullptr, nullptr, nullptr};
  ops.stamp = [](const void* message, const msg::Header& header, std::uint16_t robot_id) {
    T stamped = *static_cast<const T*>(message);  // sequences point to the writer's memory until share_copy()
    stamped.header = header;
    stamped.robot_id = robot_id;
    std::shared_ptr<const T> shared = share_copy(stamped);
    return Sample{shared, &shared->header};
  };
  ops.copy = [](const void* message) {
    std::shared_ptr<const T> shared = share_copy(*static_cast<const T*>(message));
    return Sample{shared, &shared->header};
  };
  ops.validate = [](const void* message) { return validate(*static_cast<const T*>(message)); };
  ops.append_bytes = [](const void* message, std::string& bytes) {
    canonical_bytes(*static_cast<const T*>(message), bytes);
  };
  ops.parse = [](std::span<const std::byte> bytes) {
    std::shared_ptr<const T> shared = parse_shared<T>(bytes);
    return shared ? Sample{shared, &shared->header} : Sample{};
  };
  return ops;
}

const auto kOps = std::apply(
    [](const auto&... topic) { return std::array<TopicOps, topics::kCount>{make_ops(topic)...}; }, topics::kAll);

}  // namespace

const TopicOps& topic_ops(std::size_t topic_id) { return kOps.at(topic_id); }

}  // namespace constrictor
