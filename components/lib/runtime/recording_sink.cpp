#include "runtime/recording_sink.hpp"

#include <utility>

namespace constrictor {

using Clock = std::chrono::steady_clock;

RecordingSink::RecordingSink(std::unique_ptr<mcap::Writer> writer, bool threaded) : writer_(std::move(writer)) {
  if (!writer_->open_chunk().empty()) chunk_began_ = Clock::now();
  if (threaded) thread_ = std::thread([this] { loop(); });
}

RecordingSink::~RecordingSink() { finish({}); }

void RecordingSink::put(const RecordedMessage& message) {
  const auto [id, is_new] = ids_.try_emplace(message.channel, 0);
  if (is_new) {
    const RecordedChannel& channel = *message.channel;
    const std::uint16_t schema = channel.schema_name.empty()
                                     ? std::uint16_t{0}
                                     : writer_->add_schema(channel.schema_name, "ros2msg", channel.schema);
    id->second = writer_->add_channel(schema, channel.topic, "cdr", channel.metadata);
  }
  const std::uint64_t before = writer_->chunks();
  writer_->write(
      {id->second, message.sequence, message.log_time_ns, message.publish_time_ns, mcap::bytes_of(message.cdr)});
  if (writer_->chunks() != before) chunk_began_.reset();
  else if (!chunk_began_) chunk_began_ = Clock::now();
}

void RecordingSink::close_old_chunk() {
  if (!chunk_began_ || Clock::now() - *chunk_began_ < kChunkTime) return;
  writer_->close_chunk();
  chunk_began_.reset();
}

void RecordingSink::write(const RecordedMessage& message) {
  if (!thread_.joinable()) {
    if (!failure_.empty()) return;
    try {
      put(message);
    } catch (const mcap::Error& error) {
      failure_ = error.what();
    }
    return;
  }
  const std::lock_guard lock(mutex_);
  if (!failure_.empty()) return;
  if (waiting_bytes_ + message.cdr.size() > kMostWaiting) {
    ++gaps_[message.channel->topic];
    return;
  }
  waiting_bytes_ += message.cdr.size();
  waiting_.push_back({message, std::string(message.cdr)});
  wake_.notify_one();
}

void RecordingSink::poll() {
  if (thread_.joinable() || !failure_.empty()) return;
  try {
    close_old_chunk();
  } catch (const mcap::Error& error) {
    failure_ = error.what();
  }
}

void RecordingSink::loop() {
  std::unique_lock lock(mutex_);
  while (failure_.empty()) {
    wake_.wait_for(lock, kChunkTime / 2, [this] { return stop_ || !waiting_.empty(); });
    if (stop_ && waiting_.empty()) return;
    std::deque<Waiting> batch = std::exchange(waiting_, {});
    lock.unlock();
    std::string failure;
    try {
      for (auto& [message, cdr] : batch) {
        message.cdr = cdr;
        put(message);
      }
      close_old_chunk();
    } catch (const mcap::Error& error) {
      failure = error.what();
    }
    lock.lock();
    for (const auto& [message, cdr] : batch) waiting_bytes_ -= cdr.size();
    failure_ = failure;
  }
}

std::string RecordingSink::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

std::map<std::string, std::uint64_t> RecordingSink::gaps() const {
  const std::lock_guard lock(mutex_);
  return gaps_;
}

std::string RecordingSink::finish(std::vector<mcap::Metadata> last) {
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }
  if (!writer_) return failure_;
  mcap::Texts gaps;
  for (const auto& [topic, count] : gaps_) gaps[topic] = std::to_string(count);
  if (!gaps.empty()) last.push_back({"gaps", gaps});
  try {
    writer_->finish(last);
  } catch (const mcap::Error& error) {
    if (failure_.empty()) failure_ = error.what();
  }
  writer_.reset();
  return failure_;
}

}  // namespace constrictor
