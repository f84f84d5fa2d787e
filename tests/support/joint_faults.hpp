// The faults of faulty_joints.hpp, and the check of `constrictor conform plant` that must name each of them.
#pragma once

#include "support/named_fault.hpp"

namespace constrictor::testing {

inline constexpr NamedFault kJointFaults[] = {
    {"silent", "arrives", "none within 10 s"},
    {"wrong_count", "joint_count", "22 joints"},
    {"nan", "finite", "joint 9"},
    {"zero_off", "range", "joint 2 at 2.0"},
    {"session_0", "numbers", "session 0"},
    {"same_number", "numbers", "number 7 after 7"},
    {"same_stamp", "stamps", "5 ns after 5 ns"},
    {"stamp_in_ms", "stamps", "by the stamps"},
    {"slow", "rate", "10.0 samples a second"},
    {"reports_fault", "fault", "bus power is low"},
    {"confirms_nothing", "confirms", "session 0"},
    {"drifts", "rests", "rad at most"},
    {"gravity_down", "imu", "-9.81"},
    {"few_modules", "contacts", "3 modules"},
    {"frozen", "moves", "did not move"},
    {"dead", "moves", "joint 4 did not move"},
    {"swapped", "order", "joint 5 moved when joint 3 was commanded"},
    {"sign", "sign", "joint 3 moved the other way"},
    {"degrees_in", "unit", "57 times"},
    {"degrees_out", "unit", "57 times"},
    {"gain", "gain", "joint 6"},
    {"late", "delay", "later"},
    {"velocity_in_degrees", "velocity", "times the rate of its angle"},
    {"torque_sign", "torque_sign", "joints 0, 1, 2"},
    {"torque_direction", "torque_sign", "joints 1, 3, 5, 7, 9, 11, 13, 15 and 3 more points against"},
    {"ignores_limit", "limit", "a joint moved by"},
    {"obeys_short", "too_few", "a joint moved by"},
    {"obeys_long", "too_many", "a joint moved by"},
    {"obeys_nan", "not_finite", "a joint moved by"},
    {"obeys_mode", "unknown_mode", "a joint moved by"},
    {"obeys_old", "old_command", "a joint moved by"},
    {"obeys_stranger", "stranger", "a joint moved by"},
    {"ignores_torque", "torque_limit", "limit of 0.30"},
    {"keeps_torque", "relaxed", "0.80 Nm"},
    {"no_torque_mode", "torque_turns", "joint 0 did not turn with 2.00 Nm"},
    {"push_sign", "torque_turns", "joint 6 turned against its torque"},
    {"push_swapped", "torque_order", "joint 5 turned when joint 3 was pushed"},
    {"torque_unbound", "torque_bound", "with a limit of 0.50 Nm"},
    {"pushes_on", "torque_silence", "after the last command"},
    {"ignores_silence", "silence", "after the last command"},
    {"hides_holding", "silence", "holding is false"},
    {"ends_with_commands", "silence", "end with the commands"},
    {"loses_session", "new_session", "0.00 times"},
    {"ignores_stop", "stop", "during a stop"},
    {"loses_epoch", "epoch", "no new epoch"},
};

}  // namespace constrictor::testing
