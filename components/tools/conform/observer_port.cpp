#include "conform/observer_port.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace constrictor::conform {

using namespace std::chrono_literals;

ObserverPort::ObserverPort(std::uint32_t domain, std::function<bool()> interrupted)
    : domain_(domain),
      interrupted_(std::move(interrupted)),
      // Reliable, so that no image seems to be missing; no reader can delay the camera.
      infos_(dds::Reader<msg::CameraInfo>::member(domain_.participant(), std::string(topics::kCameraInfo.name))),
      images_(dds::Reader<msg::CameraImage>::member(domain_.participant(), std::string(topics::kCameraImage.name))),
      joints_(dds::Reader<msg::JointState>::observer(domain_.participant(), std::string(topics::kJointState.name), 8)),
      wait_set_(domain_.participant()) {
  wait_set_.attach(images_.get());
}

template <class T>
void ObserverPort::take(dds::Reader<T>& reader, const Topic<T>& topic) {
  reader.take([&](const T& message) {
    tick_ = std::max(tick_, message.header.tick);
    epoch_ = message.header.epoch;
    arrived_.push_back({topic.id, topic_ops(topic.id).copy(&message)});
  });
}

void ObserverPort::exchange(std::vector<Letter>) {
  if (interrupted_()) throw PartGone("interrupted");
  const auto end = std::chrono::steady_clock::now() + 20ms;
  wait_set_.wait(20ms);
  std::this_thread::sleep_until(end);
  take(infos_, topics::kCameraInfo);
  take(images_, topics::kCameraImage);
  take(joints_, topics::kJointState);
}

}  // namespace constrictor::conform
