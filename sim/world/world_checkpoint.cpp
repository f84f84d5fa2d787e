// The part of World that saves its whole memory and continues from it, bit for bit.
#include <fmt/format.h>
#include <cereal/types/vector.hpp>

#include <stdexcept>

#include "constrictor/archive.hpp"
#include "sim/world/world.hpp"

namespace constrictor {

template <class Archive>
void World::serialize_rest(Archive& archive) {
  archive(steps_done_, hash_, contacts_);
  for (int i = 0; i < 3; ++i) archive(acceleration_m_s2_[i]);
  for (auto& drive : drives_) archive(drive);
  for (Eigen::Vector3d& push_n : pushes_n_) archive(push_n.x(), push_n.y(), push_n.z());
}

std::string World::save() const {
  BytesWriter archive;
  archive(static_cast<std::uint32_t>(module_count()), static_cast<std::uint32_t>(object_count()), dynamics_->save());
  const_cast<World*>(this)->serialize_rest(archive);  // an output archive changes nothing
  return archive.take();
}

void World::load(const std::string& bytes) {
  BytesReader archive(bytes);
  std::uint32_t modules = 0;
  std::uint32_t objects = 0;
  archive(modules, objects);
  if (modules != module_count() || objects != object_count())
    throw std::runtime_error(fmt::format("checkpoint of the world: found {} modules and {} objects, accepted {} and {}",
                                         modules, objects, module_count(), object_count()));
  std::vector<double> memory;
  archive(memory);
  dynamics_->load(memory);
  serialize_rest(archive);
  for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i].place(dynamics_->angle_rad(i), dynamics_->rate_rad_s(i));
}

}  // namespace constrictor
