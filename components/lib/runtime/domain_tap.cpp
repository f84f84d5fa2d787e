#include "runtime/domain_tap.hpp"

#include <algorithm>
#include <exception>

#include "constrictor/descriptors.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"

namespace constrictor {
namespace {

constexpr auto kPoll = std::chrono::milliseconds(100);       // until a new topic is noticed
constexpr std::size_t kMostWaiting = std::size_t{16} << 20;  // [byte] of samples that were not taken

}  // namespace

DomainTap::DomainTap(std::uint32_t domain, const std::string& identity, dds::TopicTap::Wanted wanted, const Log& log)
    : participant_(dds::create_participant(domain, dds::Reach::kLoopback, identity)), tap_(participant_.get(), wanted) {
  // Clients write these, and some of them end as soon as they have been answered.
  const auto expect = [&](const char* topic, const dds_topic_descriptor_t& type) {
    const bool kept = topic != std::string_view(barrier_topics::kRequest.name);  // clients write requests volatile
    if (wanted(topic)) tap_.expect(topic, type.m_typename, type.m_nkeys > 0, kept);
  };
#define CONSTRICTOR_UNCOUNTED_TOPIC(constant, Type, name, ...) expect(name, dds::descriptor<msg::Type>());
#include "constrictor/topic_table.def"
#undef CONSTRICTOR_UNCOUNTED_TOPIC
  thread_ = std::thread([this, log] {
    try {
      loop();
    } catch (const std::exception& error) {  // the run goes on; what has arrived is still recorded
      log.error("topics of clients and other programs are no longer recorded: {}", error.what());
    }
  });
}

DomainTap::~DomainTap() {
  stop_ = true;
  thread_.join();
}

RecordedChannel channel_of_topic(const dds::TopicTap::Topic& topic) {
  RecordedChannel channel{topic.name,
                          topic.schema.name,
                          topic.schema.text,
                          {{"dds_type", topic.type}, {"keyed", topic.keyed ? "yes" : "no"}}};
  if (topic.schema.name.empty()) channel.metadata["no_schema"] = topic.schema.why_not;
  return channel;
}

const RecordedChannel* DomainTap::channel_of(const dds::TopicTap::Topic& topic) {
  auto& channel = channels_[&topic];
  if (!channel) channel = std::make_unique<RecordedChannel>(channel_of_topic(topic));
  return channel.get();
}

void DomainTap::loop() {
  while (!stop_) {
    tap_.discover();
    tap_.wait(kPoll);
    tap_.take([this](const dds::TopicTap::Topic& topic, const dds::RawSample& sample) {
      const RecordedChannel* channel = channel_of(topic);
      const std::lock_guard lock(mutex_);
      if (arrived_bytes_ + sample.bytes.size() > kMostWaiting) return;
      arrived_bytes_ += sample.bytes.size();
      arrived_.push_back({channel, static_cast<std::uint64_t>(std::max<std::int64_t>(sample.source_time_ns, 0)),
                          std::string(sample.bytes.begin(), sample.bytes.end())});
    });
  }
}

std::vector<DomainTap::Arrived> DomainTap::take() {
  const std::lock_guard lock(mutex_);
  arrived_bytes_ = 0;
  return std::exchange(arrived_, {});
}

}  // namespace constrictor
