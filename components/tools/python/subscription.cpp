#include "python/subscription.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "client/polling.hpp"
#include "configuration/closest_name.hpp"
#include "constrictor/field_table.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/discovery.hpp"
#include "cyclone/kept_samples.hpp"
#include "cyclone/raw_reader.hpp"
#include "cyclone/type_tree.hpp"
#include "cyclone/wait_set.hpp"

namespace constrictor::python {
namespace {

namespace py = pybind11;
using namespace std::chrono_literals;
constexpr auto kDiscovery = 1500ms;  // by then a writer that exists has been found
constexpr auto kSlice = 50ms;        // between two looks for signals
constexpr auto kRunLook = 200ms;     // between two looks whether the run goes on
constexpr auto kSettle = 500ms;      // the longest wait for the samples that writers keep

/// The IDL type of a topic in this project's table; empty if the table does not contain the topic.
std::string known_type(const std::string& topic) {
  for (const auto& info : topics::kInfos) {
    if (info.name == topic) return "constrictor::msg::" + std::string(info.type);
  }
  for (const auto& info : barrier_topics::kInfos) {
    if (info.name == topic) return "constrictor::msg::" + std::string(info.type);
  }
  return {};
}

std::vector<std::string> names_of_topics(const dds::Discovery& discovery) {
  std::set<std::string> names;
  for (const auto& info : topics::kInfos) names.emplace(info.name);
  for (const auto& info : barrier_topics::kInfos) names.emplace(info.name);
  for (const auto& endpoint : discovery.endpoints()) names.insert(endpoint.topic);
  return {names.begin(), names.end()};
}

/// A writer of the topic, or what this project's table says about it.
dds::Endpoint find_writer(const dds::Discovery& discovery, const std::string& topic, std::uint32_t domain) {
  for (const auto end = WaitClock::now() + kDiscovery; WaitClock::now() < end;) {
    for (auto& endpoint : discovery.endpoints()) {
      if (endpoint.writer && endpoint.topic == topic) return std::move(endpoint);
    }
    std::this_thread::sleep_for(kPoll);
    if (signal_arrived()) throw CommandError("interrupted", CommandError::Cause::kInterrupted);
  }
  dds::Endpoint endpoint;
  endpoint.topic = topic;
  endpoint.type = known_type(topic);
  if (const auto* fields = fields_of(endpoint.type))
    endpoint.keyed = std::any_of(fields->begin(), fields->end(), [](const auto& field) { return field.info.is_key; });
  endpoint.qos.reliable = endpoint.qos.transient_local = true;
  if (!endpoint.type.empty()) return endpoint;
  const auto names = names_of_topics(discovery);
  const bool read = std::find(names.begin(), names.end(), topic) != names.end();
  throw CommandError(
      read ? fmt::format("topic '{}' has no writer in DDS domain {}, and its type is not known", topic, domain)
           : fmt::format("no topic '{}' in DDS domain {}{} (see `constrictor topic list`)", topic, domain,
                         did_you_mean(topic, names)));
}

}  // namespace

struct Subscription::Parts {
  Parts(std::shared_ptr<dds::Domain> joined, const std::string& topic, std::uint32_t number, bool history)
      : domain(std::move(joined)), wait_set(domain->participant()) {
    const dds::Discovery discovery(domain->participant());
    writer = find_writer(discovery, topic, number);
    tree = dds::TypeTree::find(domain->participant(), writer, 2s);
    if (!tree) tree = dds::TypeTree::known(domain->participant(), writer.type);
    if (!tree) {
      throw CommandError(fmt::format("topic '{}': its writer does not describe its type {}", topic, writer.type));
    }
    // Reliable if the writer is: no reader delays a writer of this project, whatever it asks for.
    const dds::RawQos wanted{writer.qos.reliable, history && writer.qos.reliable && writer.qos.transient_local, false};
    reader.emplace(domain->participant(), writer, wanted);
    wait_set.attach(reader->get());
  }
  std::shared_ptr<dds::Domain> domain;
  dds::WaitSet wait_set;
  dds::Endpoint writer;
  std::unique_ptr<dds::TypeTree> tree;
  std::optional<dds::RawReader> reader;
  std::atomic<bool> closed = false;
};

Subscription::Subscription(std::shared_ptr<Session> session, std::string topic, bool history, std::size_t depth,
                           SampleForm form)
    : session_(std::move(session)), topic_(std::move(topic)), depth_(depth), form_(form) {
  if (depth == 0 || depth > 1'000'000)
    throw std::invalid_argument(fmt::format("depth: found {}, accepted 1 to 1000000", depth));
  const py::gil_scoped_release others;
  parts_ = std::make_shared<Parts>(session_->participant(), topic_, session_->domain(), history);
  type_ = parts_->writer.type;
  if (history) kept_.emplace(dds::KeptSamples::now_ns());
}

void Subscription::collect() {
  const auto parts = parts_;
  if (!parts) return;
  parts->reader->take([this](const dds::RawSample& sample) {
    waiting_.emplace_back(sample.bytes.begin(), sample.bytes.end());
    if (kept_) kept_->arrived(sample.source_time_ns, WaitClock::now());
    if (waiting_.size() <= depth_) return;
    waiting_.pop_front();
    ++dropped_;
  });
}

void Subscription::wait_for_sample(std::optional<double> timeout_s) {
  if (timeout_s && !(*timeout_s >= 0.0 && *timeout_s <= 1e6))
    throw std::invalid_argument(fmt::format("timeout: found {}, accepted 0 to 1000000 s, or None", *timeout_s));
  const auto start = WaitClock::now();
  for (;;) {
    collect();
    if (!waiting_.empty()) return;
    const auto parts = parts_;
    if (!parts || session_->closed()) throw py::stop_iteration("the subscription was closed");
    const std::chrono::duration<double> waited = WaitClock::now() - start;
    if (timeout_s && waited.count() >= *timeout_s)
      throw WaitTimeout(fmt::format("no sample of '{}' within {} s", topic_, *timeout_s));
    bool signal = false;
    std::string over;
    {
      const py::gil_scoped_release others;
      const auto left = timeout_s ? std::chrono::duration<double>(*timeout_s) - waited : std::chrono::hours(1);
      parts->wait_set.wait(
          std::chrono::ceil<std::chrono::milliseconds>(std::min<std::chrono::duration<double>>(kSlice, left)));
      signal = signal_arrived();
      if (!signal && WaitClock::now() - looked_ > kRunLook) {
        over = session_->over();
        looked_ = WaitClock::now();
      }
    }
    if (signal) throw py::error_already_set();
    if (over.empty()) continue;
    collect();  // what arrived before the end
    if (waiting_.empty()) throw py::stop_iteration(over);
  }
}

py::object Subscription::decode(const std::vector<std::uint8_t>& bytes) const {
  const auto parts = parts_;
  if (!parts) throw py::stop_iteration("the subscription was closed");
  return to_python(*parts->tree, bytes, form_);
}

py::object Subscription::next(std::optional<double> timeout_s) {
  wait_for_sample(timeout_s);
  const auto bytes = std::move(waiting_.front());
  waiting_.pop_front();
  return decode(bytes);
}

py::object Subscription::newest(std::optional<double> timeout_s) {
  wait_for_sample(timeout_s);
  for (const auto end = WaitClock::now() + kSettle; kept_ && WaitClock::now() < end; collect()) {
    if (kept_->complete(WaitClock::now())) break;
    const py::gil_scoped_release others;
    std::this_thread::sleep_for(1ms);
  }
  kept_.reset();
  if (waiting_.empty()) throw py::stop_iteration("the subscription was closed");
  const auto bytes = std::move(waiting_.back());
  waiting_.clear();
  return decode(bytes);
}

py::list Subscription::take() {
  collect();
  py::list list;
  while (!waiting_.empty()) {
    list.append(decode(waiting_.front()));
    waiting_.pop_front();
  }
  return list;
}

void Subscription::close() {
  waiting_.clear();
  auto parts = std::exchange(parts_, nullptr);
  const py::gil_scoped_release others;  // deleting the reader may wait for DDS
  parts.reset();
}

nlohmann::ordered_json list_topics(Session& session) {
  const auto domain = session.participant();
  const dds::Discovery discovery(domain->participant());
  // Waits until discovery has found nothing new for a moment.
  const auto end = WaitClock::now() + kDiscovery;
  std::size_t before = 0;
  auto changed = WaitClock::now();
  while (WaitClock::now() < end && (before == 0 || WaitClock::now() - changed < 250ms)) {
    const std::size_t now = discovery.endpoints().size();
    if (now != before) changed = WaitClock::now();
    before = now;
    std::this_thread::sleep_for(kPoll);
    if (signal_arrived()) throw CommandError("interrupted", CommandError::Cause::kInterrupted);
  }
  struct Row {
    std::string type;
    int writers = 0, readers = 0;
  };
  std::map<std::string, Row> rows;
  for (const auto& endpoint : discovery.endpoints()) {
    Row& row = rows[endpoint.topic];
    row.type = endpoint.type;
    ++(endpoint.writer ? row.writers : row.readers);
  }
  auto json = nlohmann::ordered_json::object();
  for (const auto& [name, row] : rows)
    json[name] = {{"type", row.type}, {"writers", row.writers}, {"readers", row.readers}};
  return json;
}

bool signal_arrived() {
  const py::gil_scoped_acquire mine;
  return PyErr_Occurred() || PyErr_CheckSignals() != 0;
}

}  // namespace constrictor::python
