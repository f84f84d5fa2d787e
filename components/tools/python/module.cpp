// The Python module constrictor._native: sessions and subscriptions. The package around it (constrictor/*.py) is what
// people use.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <nlohmann/json.hpp>

#include "client/run_registry.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/json.hpp"
#include "python/publisher.hpp"
#include "python/python_sample.hpp"
#include "python/session.hpp"
#include "python/subscription.hpp"

namespace py = pybind11;

namespace constrictor::python {
namespace {

/// Sets the exception of this name in constrictor.errors.
void raise(const char* name, const char* text) {
  const py::object type = py::module_::import("constrictor.errors").attr(name);
  PyErr_SetString(type.ptr(), text);
}

void translate(std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param): pybind11 asks for a copy
  if (!thrown) return;
  try {
    std::rethrow_exception(thrown);
  } catch (const CommandError& error) {
    // Ctrl-C: Python's signal handler has set its exception, KeyboardInterrupt, before the wait ended.
    if (PyErr_Occurred()) return;
    using Cause = CommandError::Cause;
    const Cause cause = error.cause();
    raise(cause == Cause::kNoRun      ? "NoRunError"
          : cause == Cause::kRefused  ? "RefusedError"
          : cause == Cause::kNoAnswer ? "NoAnswerError"
                                      : "Error",
          error.what());
  } catch (const WaitTimeout& error) {
    raise("WaitTimeoutError", error.what());
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const std::invalid_argument&) {
    throw;  // pybind11 makes a ValueError
  } catch (const std::runtime_error& error) {
    raise("Error", error.what());
  }
}

py::dict to_dict(const RunNote& note) {
  py::dict made;
  made["domain"] = note.domain;
  made["pid"] = note.pid;
  made["scenario"] = note.scenario;
  made["seed"] = note.seed;
  made["roster"] = note.roster;
  made["plant"] = note.plant;
  made["directory"] = note.report_dir.string();
  made["run_id"] = note.run_id;
  made["on_this_host"] = note.on_this_host;
  return made;
}

py::dict to_dict(const msg::TaskEvent& event) {
  py::dict made;
  made["event"] = name_of(constants::kEvent, event.event);
  made["goal_state"] = name_of(constants::kGoal, event.goal_state);
  made["task"] = name_of(constants::kTask, event.task);
  made["time_s"] = static_cast<double>(event.header.time_ns) * 1e-9;
  made["tick"] = event.header.tick;
  made["colour"] = name_of(constants::kColour, event.colour);
  made["object_handle"] = event.object_handle;
  made["detail"] = text_of(event.detail);
  return made;
}

py::object to_dict(const msg::RunState& state) { return to_python(constrictor::to_json(state)); }

template <class... Arguments>
auto released(Arguments&&... arguments) {
  const py::gil_scoped_release others;
  return std::invoke(std::forward<Arguments>(arguments)...);
}

py::object authority_of(Session& session) {
  const msg::Authority authority = released(&Session::authority, session);
  py::dict made;
  made["level"] = name_of(constants::kAuthority, authority.level);
  made["source"] = text_of(authority.source);
  made["emergency_stop"] = authority.emergency_stop;
  made["mine"] = session.source() == text_of(authority.source) && authority.level != msg::kAuthorityNone;
  return made;
}

void add_session(py::module_& module) {
  using Free = py::call_guard<py::gil_scoped_release>;
  const auto control = [](auto&& use) {
    return [use](Session& session, auto... argument) {
      return to_dict(released(&Session::control, session,
                              [&](RunControlClient& client) { return std::invoke(use, client, argument...); }));
    };
  };
  py::class_<Session, std::shared_ptr<Session>>(module, "Session")
      .def(py::init([](std::optional<std::uint32_t> domain, const std::string& directory, bool observe,
                       const std::string& name, bool as_operator, bool detached, const std::string& token,
                       const std::string& token_file) {
             const SessionOptions options{domain, directory, observe, name, as_operator, detached, token, token_file};
             const py::gil_scoped_release others;
             return std::make_shared<Session>(options, signal_arrived);
           }),
           py::kw_only(), py::arg("domain"), py::arg("directory"), py::arg("observe"), py::arg("name"),
           py::arg("as_operator"), py::arg("detached"), py::arg("token"), py::arg("token_file"))
      .def("close", &Session::close, Free())
      .def_property_readonly("closed", &Session::closed)
      .def_property_readonly("domain", &Session::domain)
      .def_property_readonly("source", &Session::source)
      .def_property_readonly(
          "note",
          [](const Session& session) { return session.note() ? py::object(to_dict(*session.note())) : py::none(); })
      .def("over", &Session::over, Free())
      .def("state", [](Session& session) { return to_dict(released(&Session::state, session)); })
      .def("authority", &authority_of)
      .def("components", [](Session& session) { return to_python(released(&Session::components, session)); })
      .def("topics", [](Session& session) { return to_python(released(list_topics, session)); })
      .def("take", &Session::take, Free())
      .def("release", &Session::release, Free())
      .def("move", &Session::move, Free(), py::arg("motion"), py::arg("speed_m_s"), py::arg("curvature_1_m"),
           py::arg("angle_rad"))
      .def("drive", &Session::drive, Free(), py::arg("speed_m_s"), py::arg("turn_rad_s"))
      .def(
          "start",
          [](Session& session, const std::string& task, std::optional<std::string> line_colour,
             std::optional<std::string> object_colour, std::optional<std::string> drop_zone_colour,
             std::optional<std::string> direction, std::optional<std::uint16_t> object_handle,
             std::map<std::string, double> numbers, std::vector<std::pair<double, double>> path) {
            return session.start(task, {std::move(line_colour), std::move(object_colour), std::move(drop_zone_colour),
                                        std::move(direction), object_handle, std::move(numbers), std::move(path)});
          },
          Free(), py::arg("task"), py::kw_only(), py::arg("line_colour"), py::arg("object_colour"),
          py::arg("drop_zone_colour"), py::arg("direction"), py::arg("object_handle"), py::arg("numbers"),
          py::arg("path"))
      .def("wait_for_end", &Session::wait_for_end, Free(), py::arg("goal"), py::arg("timeout"))
      .def(
          "wait_for_event",
          [](Session& session, std::uint64_t goal, const std::string& event, std::optional<double> timeout) {
            return to_dict(released(&Session::wait_for_event, session, goal, event, timeout));
          },
          py::arg("goal"), py::arg("event"), py::arg("timeout"))
      .def("events",
           [](Session& session, std::uint64_t goal) {
             py::list list;
             for (const auto& event : released(&Session::events, session, goal)) list.append(to_dict(event));
             return list;
           })
      .def("emergency_stop", &Session::emergency_stop, Free())
      .def("clear_stop", &Session::clear_stop, Free())
      .def("wait", &Session::wait, Free(), py::arg("duration"))
      .def("parameters", [](Session& session) { return to_python(released(&Session::parameters, session)); })
      .def("set_parameter", &Session::set_parameter, Free(), py::arg("name"), py::arg("value"), py::arg("at_tick"))
      .def("pause", [control](Session& session) { return control(&RunControlClient::pause)(session); })
      .def("resume", [control](Session& session) { return control(&RunControlClient::resume)(session); })
      .def("step",
           [control](Session& session, std::uint32_t ticks) {
             return control([](RunControlClient& client, std::uint32_t count) { return client.step(count); })(session,
                                                                                                              ticks);
           })
      .def("pace",
           [control](Session& session, double pace) { return control(&RunControlClient::set_pace)(session, pace); })
      .def("reset",
           [control](Session& session, std::uint64_t seed) { return control(&RunControlClient::reset)(session, seed); })
      .def("end", [control](Session& session) { return control(&RunControlClient::end)(session); });
}

void add_subscription(py::module_& module) {
  py::class_<Subscription>(module, "Subscription")
      .def(py::init([](std::shared_ptr<Session> session, std::string topic, bool history, std::size_t depth, bool names,
                       bool whole) {
             return std::make_unique<Subscription>(std::move(session), std::move(topic), history, depth,
                                                   SampleForm{names, whole});
           }),
           py::arg("session"), py::arg("topic"), py::kw_only(), py::arg("history"), py::arg("depth"), py::arg("names"),
           py::arg("whole"))
      .def("next", &Subscription::next, py::arg("timeout"))
      .def("newest", &Subscription::newest, py::arg("timeout"))
      .def("take", &Subscription::take)
      .def("close", &Subscription::close)
      .def_property_readonly("topic", &Subscription::topic)
      .def_property_readonly("type", &Subscription::type)
      .def_property_readonly("dropped", &Subscription::dropped);
}

void add_publisher(py::module_& module) {
  py::class_<Publisher>(module, "Publisher")
      .def(py::init<const std::shared_ptr<Session>&, const std::string&, const std::string&>(), py::arg("session"),
           py::arg("topic"), py::arg("type"))
      .def("publish", &Publisher::publish, py::arg("message"))
      .def("wait_for_reader", &Publisher::wait_for_reader, py::arg("timeout"))
      .def("flush", &Publisher::flush, py::arg("timeout"))
      .def("close", &Publisher::close)
      .def_property_readonly("readers", &Publisher::readers)
      .def_property_readonly("topic", &Publisher::topic)
      .def_property_readonly("type", &Publisher::type);
}

py::dict names_of_groups() {
  py::dict made;
  const auto add = [&](const char* key, const ConstantGroup& group, std::uint8_t first) {
    made[key] = py::tuple(py::cast(names_of(group, first)));
  };
  add("tasks", constants::kTask, 1);
  add("events", constants::kEvent, 1);
  add("colours", constants::kColour, 1);
  add("directions", constants::kDirection, 1);
  add("motions", constants::kMotion, 0);
  return made;
}

}  // namespace
}  // namespace constrictor::python

PYBIND11_MODULE(_native, module) {
  using namespace constrictor::python;
  module.doc() = "Sessions and subscriptions of the package constrictor. Use the package, not this module.";
  py::register_local_exception_translator(translate);
  add_session(module);
  add_subscription(module);
  add_publisher(module);
  module.def("live_runs", [] {
    py::list list;
    for (const auto& run : constrictor::live_runs()) list.append(to_dict(run));
    return list;
  });
  module.def("names", &names_of_groups);
  module.attr("__version__") = CONSTRICTOR_VERSION;
}
