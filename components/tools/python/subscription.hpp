// The samples of one topic, for a Python program.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cyclone/kept_samples.hpp"
#include "python/python_sample.hpp"
#include "python/session.hpp"

namespace constrictor::python {

class Subscription {
 public:
  /// Waits up to 1.5 s for a writer of the topic, to learn its type; topics of this project need none. Throws
  /// CommandError if there is no such topic, or if its writer does not describe its type. `history`: the samples that
  /// writers keep for late readers arrive first. At most `depth` samples wait to be taken; newer ones replace the
  /// oldest.
  Subscription(std::shared_ptr<Session> session, std::string topic, bool history, std::size_t depth, SampleForm form);

  /// The next sample, in the order of arrival. `timeout_s`: empty: until the run ends. Throws WaitTimeout, and
  /// StopIteration if the run has ended, or this subscription or its session was closed.
  pybind11::object next(std::optional<double> timeout_s);
  /// Takes what has arrived and returns the newest sample; waits for one if none has arrived since the last call.
  pybind11::object newest(std::optional<double> timeout_s);
  /// All samples that have arrived, without waiting.
  pybind11::list take();
  void close();

  [[nodiscard]] const std::string& topic() const { return topic_; }
  [[nodiscard]] const std::string& type() const { return type_; }
  /// Number of samples that newer ones replaced before they were taken.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  struct Parts;
  void wait_for_sample(std::optional<double> timeout_s);
  void collect();
  pybind11::object decode(const std::vector<std::uint8_t>& bytes) const;

  std::shared_ptr<Session> session_;
  std::string topic_;
  std::string type_;
  std::size_t depth_;
  SampleForm form_;
  std::shared_ptr<Parts> parts_;  ///< null after close(); a thread that waits keeps them
  std::deque<std::vector<std::uint8_t>> waiting_;
  std::uint64_t dropped_ = 0;
  std::optional<dds::KeptSamples> kept_;            ///< empty: those that were asked for have arrived
  std::chrono::steady_clock::time_point looked_{};  ///< last look whether the run goes on
};

/// The topics in the domain of a session: names, types, numbers of writers and readers.
nlohmann::ordered_json list_topics(Session& session);

/// True if a signal has arrived for which Python has a handler that raises an exception, as for Ctrl-C; the exception
/// is then set. Takes the GIL.
bool signal_arrived();

}  // namespace constrictor::python
