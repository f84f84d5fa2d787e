// The part of World that saves its whole memory and continues from it, bit for bit.
#include <fmt/format.h>
#include <cereal/archives/portable_binary.hpp>
#include <cereal/types/vector.hpp>

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>

#include "sim/world/world.hpp"

namespace constrictor {
namespace {

/// One body of ODE: position, quaternion, rotation matrix, velocity and angular velocity.
using BodyValues = std::array<double, 3 + 4 + 12 + 3 + 3>;

BodyValues values_of(dBodyID body) {
  BodyValues values{};
  double* to = values.data();
  to = std::copy_n(dBodyGetPosition(body), 3, to);
  to = std::copy_n(dBodyGetQuaternion(body), 4, to);
  to = std::copy_n(dBodyGetRotation(body), 12, to);
  to = std::copy_n(dBodyGetLinearVel(body), 3, to);
  std::copy_n(dBodyGetAngularVel(body), 3, to);
  return values;
}

void set_values(dBodyID body, const BodyValues& values) {
  const double* from = values.data();
  dBodySetPosition(body, from[0], from[1], from[2]);  // also marks the body's geometry as moved
  // dBodySetQuaternion() and dBodySetRotation() normalise what they are given, which changes its last bits. ODE has no
  // function that sets the raw values, but its getters return pointers to them.
  std::copy_n(from + 3, 4, const_cast<dReal*>(dBodyGetQuaternion(body)));
  std::copy_n(from + 7, 12, const_cast<dReal*>(dBodyGetRotation(body)));
  dBodySetLinearVel(body, from[19], from[20], from[21]);
  dBodySetAngularVel(body, from[22], from[23], from[24]);
  dBodySetForce(body, 0.0, 0.0, 0.0);
  dBodySetTorque(body, 0.0, 0.0, 0.0);
}

}  // namespace

template <class Archive>
void World::serialize_rest(Archive& archive) {
  std::uint64_t reorder_state = reorder_state_;
  archive(reorder_state, steps_done_, hash_, contacts_);
  reorder_state_ = static_cast<unsigned long>(reorder_state);
  for (int i = 0; i < 3; ++i) archive(acceleration_m_s2_[i]);
  for (auto& drive : drives_) archive(*drive);
  for (Eigen::Vector3d& force_n : forces_n_) archive(force_n.x(), force_n.y(), force_n.z());
}

std::string World::save() const {
  std::vector<BodyValues> bodies;
  for (const auto* list : {&modules_, &objects_}) {
    for (const dBodyID body : *list) bodies.push_back(values_of(body));
  }
  std::ostringstream stream;
  cereal::PortableBinaryOutputArchive archive(stream);
  archive(static_cast<std::uint32_t>(modules_.size()), static_cast<std::uint32_t>(objects_.size()), bodies);
  const_cast<World*>(this)->serialize_rest(archive);  // an output archive changes nothing
  return std::move(stream).str();
}

void World::load(const std::string& bytes) {
  std::istringstream stream(bytes);
  cereal::PortableBinaryInputArchive archive(stream);
  std::uint32_t modules = 0;
  std::uint32_t objects = 0;
  archive(modules, objects);
  if (modules != modules_.size() || objects != objects_.size())
    throw std::runtime_error(fmt::format("checkpoint of the world: found {} modules and {} objects, accepted {} and {}",
                                         modules, objects, modules_.size(), objects_.size()));
  std::vector<BodyValues> bodies;
  archive(bodies);
  if (bodies.size() != modules_.size() + objects_.size())
    throw std::runtime_error(fmt::format("checkpoint of the world: found {} bodies, accepted {}", bodies.size(),
                                         modules_.size() + objects_.size()));
  for (std::size_t i = 0; i < bodies.size(); ++i)
    set_values(i < modules_.size() ? modules_[i] : objects_[i - modules_.size()], bodies[i]);
  serialize_rest(archive);
}

}  // namespace constrictor
