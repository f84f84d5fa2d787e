// How the checks see a plant: one control period at a time. Implementations: a process on the topics hardware/*, a
// plant that is a member of a run, and doubles in tests.
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace constrictor::conform {

/// Measured joints, as they arrived. The vectors have one entry for each joint that the sample claims to have.
struct JointSample {
  std::uint64_t session = 0;  ///< of the writer; for a member: its incarnation
  std::uint64_t number = 0;
  std::int64_t time_ns = 0;  ///< [ns] the writer's stamp
  double arrival_s = 0.0;    ///< [s] when it arrived
  std::uint64_t confirmed_session = 0, confirmed_number = 0;
  bool holding = false;
  std::string fault;
  std::vector<double> position_rad, velocity_rad_s, torque_nm;
};

struct ImuSample {
  std::array<double, 4> orientation{};  ///< w x y z
  std::array<double, 3> rate_rad_s{}, acceleration_m_s2{};
};

struct ContactSample {
  int module_count = 0;
  int contact_count = 0;
  bool finite = true;
};

/// A command to the joints. Its size and values may be wrong on purpose.
struct PlantCommand {
  std::vector<double> position_rad, velocity_rad_s, torque_limit_nm, torque_nm;
  bool relaxed = false;
  bool torque = false;  ///< the joints exert torque_nm, and the positions do not count
  bool unknown_mode = false;
  /// The origin, if the port can choose it: an older number than the newest, or another session than its own.
  enum class Origin { kProper, kOld, kStranger } origin = Origin::kProper;
};

/// The user has pressed Ctrl-C.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// The plant or the run has ended; what() contains the reason.
struct PlantGone : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class PlantPort {
 public:
  struct Abilities {
    bool sessions = false;  ///< commands have sessions and numbers, and the plant confirms them
    bool stops = false;     ///< the plant obeys emergency stops
    bool epochs = false;    ///< a new epoch can begin
    bool raw = false;       ///< values that are not finite, and unknown modes, can be sent
  };
  virtual ~PlantPort() = default;
  [[nodiscard]] virtual Abilities abilities() const = 0;
  /// Sends the commands and goes on by one control period. Throws Interrupted, PlantGone.
  virtual void advance(const std::vector<PlantCommand>& commands) = 0;
  /// [s] now.
  [[nodiscard]] virtual double now_s() const = 0;

  // The samples that arrived during the last advance(), oldest first.
  [[nodiscard]] const std::vector<JointSample>& joints() const { return joints_; }
  [[nodiscard]] const std::vector<ImuSample>& imus() const { return imus_; }
  [[nodiscard]] const std::vector<ContactSample>& contacts() const { return contacts_; }

  /// The session of the proper commands, and the number of the newest; where `sessions`.
  [[nodiscard]] virtual std::uint64_t session() const { return 0; }
  [[nodiscard]] virtual std::uint64_t number() const { return 0; }
  /// Begins another session, whose numbers begin at 1. Where `sessions`.
  virtual void begin_session() {}
  /// Orders an emergency stop, and clears it. Where `stops`.
  virtual void order_stop() {}
  virtual void clear_stop() {}
  /// Whether the plant says that it is stopped.
  [[nodiscard]] virtual bool stopped() const { return false; }
  /// Begins a new epoch. Where `epochs`.
  virtual void begin_epoch() {}
  [[nodiscard]] virtual std::uint32_t epoch() const { return 0; }
  /// Kills the plant's process and orders its restart, without waiting for the new process. Returns why this is not
  /// possible; empty: the restart has begun.
  [[nodiscard]] virtual std::string restart() = 0;
  /// A number that is another one after each start of the plant's process, as far as it is known by now.
  [[nodiscard]] virtual std::uint64_t incarnation() const = 0;

 protected:
  std::vector<JointSample> joints_;
  std::vector<ImuSample> imus_;
  std::vector<ContactSample> contacts_;
};

}  // namespace constrictor::conform
