// Publishes messages of a Python program on a topic.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>

#include "client/topic_publisher.hpp"
#include "python/session.hpp"

namespace constrictor::python {

class Publisher {
 public:
  /// `type`: of a topic that has no reader or writer yet; empty: the type is discovered. Throws CommandError if the
  /// topic must not be written (publishing_refusal()), or if its type is not known.
  Publisher(const std::shared_ptr<Session>& session, const std::string& topic, const std::string& type);

  /// Publishes a dictionary. Throws std::invalid_argument if it does not fit the type.
  void publish(const pybind11::dict& message);
  [[nodiscard]] int readers();
  /// Returns when the topic has a reader. Throws WaitTimeout.
  void wait_for_reader(std::optional<double> timeout_s);
  /// Waits until the reliable readers have everything. False if they have not within `timeout_s`.
  bool flush(double timeout_s);
  void close();

  [[nodiscard]] const std::string& topic() const { return topic_; }
  [[nodiscard]] std::string type() const { return parts().publisher.type(); }

 private:
  struct Parts {
    Parts(std::shared_ptr<dds::Domain> joined, const Session& session, const std::string& topic,
          const std::string& type)
        : domain(std::move(joined)),
          publisher(domain->participant(), session.domain(), topic, type, session.source(), session.key()) {}
    std::shared_ptr<dds::Domain> domain;
    TopicPublisher publisher;
  };
  [[nodiscard]] Parts& parts() const;

  std::string topic_;
  std::unique_ptr<Parts> parts_;  ///< null after close()
};

}  // namespace constrictor::python
