// Settings with which Fast DDS discovers the processes of Constrictor: the only part of this example that depends on
// the vendor.
#pragma once

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace example {

namespace fdds = eprosima::fastdds::dds;

template <class T>
T* made(T* entity, const std::string& what) {
  if (!entity) throw std::runtime_error("Fast DDS: cannot create " + what);
  return entity;
}

/// A participant with writers and readers. `wait` passes the samples that have arrived to the functions given to
/// `read`.
class Participant {
 public:
  /// `domain` is the number that `constrictor run` prints. `address` is the address of the network interface on which
  /// the robot's processes communicate. `listener`, if given, is called for every participant, reader and writer that
  /// Fast DDS discovers, in a thread of Fast DDS; it must outlive this object.
  Participant(std::uint32_t domain, const std::string& name, const std::string& address = "127.0.0.1",
              fdds::DomainParticipantListener* listener = nullptr) {
    namespace rtps = eprosima::fastrtps::rtps;
    fdds::DomainParticipantQos qos;
    qos.name(name);
    // On one host Constrictor uses UDP on the loopback interface without multicast. By default Fast DDS would use
    // shared memory and multicast there.
    qos.transport().use_builtin_transports = false;
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.push_back(address);
    // Without multicast, Fast DDS finds only participants whose number is below this. A run has about twelve.
    udp->maxInitialPeersRange = 120;
    qos.transport().user_transports.push_back(udp);
    rtps::Locator_t peer;
    peer.kind = LOCATOR_KIND_UDPv4;
    rtps::IPLocator::setIPv4(peer, address);
    qos.wire_protocol().builtin.initialPeersList.push_back(peer);
    participant_ = made(fdds::DomainParticipantFactory::get_instance()->create_participant(domain, qos, listener,
                                                                                           fdds::StatusMask::none()),
                        "a participant");
    subscriber_ = made(participant_->create_subscriber(fdds::SUBSCRIBER_QOS_DEFAULT), "a subscriber");
    publisher_ = made(participant_->create_publisher(fdds::PUBLISHER_QOS_DEFAULT), "a publisher");
  }
  ~Participant() {
    participant_->delete_contained_entities();
    fdds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// Creates a reader of a topic; `wait` calls `use` for each of its samples. `PubSubType` is fastddsgen's class for
  /// the message. The reader keeps the newest `depth` samples until `wait` takes them. If `every` is true, the reader
  /// is reliable and also receives the samples that writers keep for late readers.
  template <class PubSubType, class Use>
  fdds::DataReader* read(const std::string& topic, bool every, int depth, Use use) {
    fdds::DataReaderQos qos;
    qos.reliability().kind = every ? fdds::RELIABLE_RELIABILITY_QOS : fdds::BEST_EFFORT_RELIABILITY_QOS;
    qos.durability().kind = every ? fdds::TRANSIENT_LOCAL_DURABILITY_QOS : fdds::VOLATILE_DURABILITY_QOS;
    qos.history().kind = fdds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = depth;
    qos.data_sharing().off();
    auto* reader = made(subscriber_->create_datareader(find_topic<PubSubType>(topic), qos), "a reader of " + topic);
    reader->get_statuscondition().set_enabled_statuses(fdds::StatusMask::data_available());
    wait_set_.attach_condition(reader->get_statuscondition());
    takers_.push_back([reader, use] {
      typename PubSubType::type message;
      fdds::SampleInfo info;
      while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
        if (info.valid_data) use(message);
      }
    });
    return reader;
  }

  /// Creates a reliable writer. If `lease` is true, `input` regards the source as dead half a second after the end of
  /// this process.
  template <class PubSubType>
  fdds::DataWriter* write(const std::string& topic, int depth, bool lease = true) {
    fdds::DataWriterQos qos;
    qos.reliability().kind = fdds::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = fdds::VOLATILE_DURABILITY_QOS;
    qos.history().kind = fdds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = depth;
    qos.data_sharing().off();
    if (lease) {
      qos.liveliness().kind = fdds::AUTOMATIC_LIVELINESS_QOS;
      qos.liveliness().lease_duration = {0, 500'000'000};
      qos.liveliness().announcement_period = {0, 100'000'000};
    }
    qos.writer_data_lifecycle().autodispose_unregistered_instances = false;
    return made(publisher_->create_datawriter(find_topic<PubSubType>(topic), qos), "a writer of " + topic);
  }

  /// Waits at most `bound_s` seconds for a sample. Then takes the samples of all readers and calls their `use`
  /// functions.
  void wait(double bound_s) {
    fdds::ConditionSeq triggered;
    wait_set_.wait(triggered, {static_cast<std::int32_t>(bound_s),
                               static_cast<std::uint32_t>((bound_s - static_cast<std::int32_t>(bound_s)) * 1e9)});
    for (const auto& take : takers_) take();
  }

 private:
  template <class PubSubType>
  fdds::Topic* find_topic(const std::string& name) {
    fdds::TypeSupport type(new PubSubType());
    // Cyclone DDS 0.10 cannot read the type information of Fast DDS and would not match. Type names suffice, because
    // the types are final.
    type->auto_fill_type_information(false);
    type->auto_fill_type_object(false);
    participant_->register_type(type);
    return made(participant_->create_topic(name, type.get_type_name(), fdds::TOPIC_QOS_DEFAULT), "topic " + name);
  }

  fdds::DomainParticipant* participant_ = nullptr;
  fdds::Subscriber* subscriber_ = nullptr;
  fdds::Publisher* publisher_ = nullptr;
  fdds::WaitSet wait_set_;
  std::vector<std::function<void()>> takers_;
};

}  // namespace example
