// A file of faults to inject into a run: `constrictor run --faults FILE`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "constrictor/topics.hpp"
#include "device_faults/device_commands.hpp"

namespace constrictor {

/// The fault of the samples of one topic, for all of its readers alike, or for `readers`.
struct TopicFault {
  enum class Kind {
    kDrop,       ///< the sample never arrives
    kDelay,      ///< it arrives `delay_ticks` later, with its own time stamp
    kDuplicate,  ///< it arrives twice
    kCorrupt,    ///< one bit of it is changed; readers refuse it if it is not a valid message then
    kFreeze,     ///< it has the content of the last sample before the fault, with its own time stamp
    kBias,       ///< `amount` is added to the number `field`
    kLinkDown,   ///< it arrives when the link is up again, if the topic's history still contains it then
  };
  Kind kind = Kind::kDrop;
  const TopicInfo* topic = nullptr;
  std::int64_t from_ns = 0;          ///< simulated time of the first sample that may be concerned
  std::int64_t until_ns = 0;         ///< and of the first one that is not any more
  double probability = 1.0;          ///< that a sample within this time is concerned
  int delay_ticks = 0;               ///< [ticks] of kDelay
  std::string field;                 ///< of kBias: "position_rad[3]", "pose.x_m"
  double amount = 0.0;               ///< of kBias, in the unit of the field
  std::vector<std::string> readers;  ///< of kLinkDown: the components on the other side of the link from the writer
  std::uint64_t number = 0;          ///< its place in the file; with the seeds it decides which samples are concerned
};

/// The link between some components and all others carries nothing. FaultPlan::topics contains what follows from it for
/// each topic that crosses the link.
struct LinkFault {
  std::vector<std::string> components;  ///< on one side of the link
  std::int64_t from_ns = 0;             ///< simulated time
  std::int64_t until_ns = 0;            ///< simulated time
};

/// The fault of the process of one component. It changes no result in lock-step.
struct ProcessFault {
  enum class Kind {
    kKill,  ///< killed; the launcher starts it again
    kStop,  ///< stopped for `for_s` of wall time
    kSlow,  ///< each step takes `step_ms` longer until `until_ns`
  };
  Kind kind = Kind::kKill;
  std::string component;
  std::int64_t from_ns = 0;   ///< simulated time
  std::int64_t until_ns = 0;  ///< simulated time, of kSlow
  double for_s = 0.0;         ///< [s] wall time, of kStop
  double step_ms = 0.0;       ///< [ms] wall time, of kSlow
};

/// The fault of an emulated device that runs beside the run. The device is not a member, so it receives no ticks.
struct DeviceFault {
  DeviceOrder order;
  std::int64_t from_ns = 0;   ///< simulated time
  std::int64_t until_ns = 0;  ///< simulated time
};

struct FaultPlan {
  std::uint64_t seed = 1;
  std::vector<TopicFault> topics;
  std::vector<LinkFault> links;
  std::vector<ProcessFault> processes;
  std::vector<DeviceFault> devices;
};

/// The names that a file of faults may contain.
struct FaultTargets {
  std::vector<std::string> roster;
  /// The programs that run beside the run; empty: not checked, because only the launcher knows them.
  std::optional<std::vector<std::string>> beside = std::nullopt;
  std::size_t joints = msg::kMaxJoints, modules = msg::kMaxModules;  ///< of the robot
};

/// Reads a file of faults; an empty path is a plan without faults. Throws ConfigurationError with file, line, key, what
/// was found and what is accepted.
[[nodiscard]] FaultPlan load_fault_plan(const std::filesystem::path& file, const FaultTargets& targets);

/// "drop of perception/objects", for messages.
[[nodiscard]] std::string describe(const TopicFault& fault);
[[nodiscard]] std::string describe(const LinkFault& fault);
[[nodiscard]] std::string describe(const ProcessFault& fault);
[[nodiscard]] std::string describe(const DeviceFault& fault);

}  // namespace constrictor
