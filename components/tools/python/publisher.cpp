#include "python/publisher.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "client/polling.hpp"
#include "python/python_sample.hpp"
#include "python/subscription.hpp"

namespace constrictor::python {

namespace py = pybind11;

Publisher::Publisher(const std::shared_ptr<Session>& session, const std::string& topic, const std::string& type)
    : topic_(topic) {
  const py::gil_scoped_release others;
  parts_ = std::make_unique<Parts>(session->participant(), *session, topic, type);
  static_cast<void>(parts_->publisher.readers());  // creates the writer, so that readers find it
}

Publisher::Parts& Publisher::parts() const {
  if (!parts_) throw CommandError(fmt::format("the publisher of '{}' was closed", topic_));
  return *parts_;
}

void Publisher::publish(const py::dict& message) {
  TopicPublisher& publisher = parts().publisher;
  publisher.write(publisher.encode(publisher.completed(to_json(message))));
}

int Publisher::readers() { return parts().publisher.readers(); }

void Publisher::wait_for_reader(std::optional<double> timeout_s) {
  for (const auto start = WaitClock::now(); readers() == 0;) {
    const std::chrono::duration<double> waited = WaitClock::now() - start;
    if (timeout_s && waited.count() >= *timeout_s) {
      std::string mismatched;
      for (const auto& reader : parts().publisher.mismatched_readers())
        mismatched += fmt::format("; a reader cannot receive from it: {}", reader);
      throw WaitTimeout(fmt::format("no reader of '{}' within {} s{}", topic_, *timeout_s, mismatched));
    }
    bool signal = false;
    {
      const py::gil_scoped_release others;
      std::this_thread::sleep_for(kPoll);
      signal = signal_arrived();
    }
    if (signal) throw py::error_already_set();
  }
}

bool Publisher::flush(double timeout_s) {
  if (!(timeout_s >= 0.0 && timeout_s <= 1e6))
    throw std::invalid_argument(fmt::format("timeout: found {}, accepted 0 to 1000000 s", timeout_s));
  TopicPublisher& publisher = parts().publisher;
  for (const auto start = WaitClock::now();;) {
    bool done = false;
    bool signal = false;
    {
      const py::gil_scoped_release others;
      done = publisher.flush(kPoll);
      signal = !done && signal_arrived();
    }
    if (signal) throw py::error_already_set();
    if (done || WaitClock::now() - start > std::chrono::duration<double>(timeout_s)) return done;
  }
}

void Publisher::close() {
  auto parts = std::exchange(parts_, nullptr);
  const py::gil_scoped_release others;
  parts.reset();
}

}  // namespace constrictor::python
