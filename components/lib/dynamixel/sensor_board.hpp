// The registers of the boards with sensors: a board of one's own needs a serial port, this map, and the instructions
// Ping, Read, Write, Sync Read and Fast Sync Read. README.md has the map as a table.
#pragma once

#include <cstddef>
#include <cstdint>

namespace constrictor::dynamixel::sensor_board {

inline constexpr std::uint16_t kImuModel = 0xC101;      ///< register model_number (address 0)
inline constexpr std::uint16_t kContactModel = 0xC102;  ///< the same, of a board with the contact sensors of a module

inline constexpr std::uint16_t kBegin = 64;  ///< the first address of the measurements

/// Vectors are three signed numbers of two bytes, x first. [unit of the number]
namespace imu {
inline constexpr std::uint16_t kCount = 64;               ///< 2 bytes, one more after each measurement
inline constexpr std::uint16_t kOrientation = 66;         ///< four numbers: w, x, y, z [1/32767]
inline constexpr std::uint16_t kAngularVelocity = 74;     ///< vector [0.001 rad/s]
inline constexpr std::uint16_t kLinearAcceleration = 80;  ///< vector [0.005 m/s2], 9.81 upwards at rest
inline constexpr std::uint16_t kEnd = 86;
}  // namespace imu

/// A contact board has room for four contacts of its module, the strongest first. The flat belly alone has two contacts
/// with the ground, which are stronger than a light touch of an object.
namespace contact {
inline constexpr std::uint16_t kCount = 64;     ///< 2 bytes, one more after each measurement
inline constexpr std::uint16_t kForce = 66;     ///< vector [0.01 N]: sum of the forces on the module, in its frame
inline constexpr std::uint16_t kMoment = 72;    ///< vector [0.001 Nm]: sum of their moments about the module's centre
inline constexpr std::uint16_t kContacts = 78;  ///< 1 byte: number of contacts below, 0 to 4
inline constexpr std::uint16_t kFirst = 79;     ///< position [0.1 mm], normal [1/32767], force [0.01 N]: three vectors
inline constexpr std::size_t kMost = 4;
inline constexpr std::uint16_t kBytesOfOne = 18;
inline constexpr std::uint16_t kEnd = kFirst + kMost * kBytesOfOne;
}  // namespace contact

inline constexpr double kUnitVector = 1.0 / 32767.0;
inline constexpr double kRate_rad_s = 0.001;
inline constexpr double kAcceleration_m_s2 = 0.005;
inline constexpr double kForce_n = 0.01;
inline constexpr double kMoment_nm = 0.001;
inline constexpr double kPosition_m = 0.0001;

}  // namespace constrictor::dynamixel::sensor_board
