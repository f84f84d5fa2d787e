#include "sim/camera_emulator/run_world.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor::camera_emulator {

struct RunWorld::Impl {
  explicit Impl(std::uint32_t number) : domain(number) {}
  dds::Domain domain;
  dds::Reader<msg::SceneDescription> scene =
      dds::Reader<msg::SceneDescription>::member(domain.participant(), std::string(topics::kSceneDescription.name));
  dds::Reader<msg::WorldState> world =
      dds::Reader<msg::WorldState>::observer(domain.participant(), std::string(topics::kWorldState.name));
  std::optional<msg::WorldState> newest;
};

RunWorld::RunWorld(std::uint32_t domain) : impl_(std::make_unique<Impl>(domain)) {}
RunWorld::~RunWorld() = default;

std::optional<msg::WorldState> RunWorld::read(const msg::SceneDescription& expected) {
  impl_->scene.take([&](const msg::SceneDescription& scene) {
    const std::string_view found = scene.scenario, own = expected.scenario;
    if (found != own || scene.seed != expected.seed || scene.object_count != expected.object_count ||
        scene.module_count != expected.module_count)
      throw std::runtime_error(
          fmt::format("--run: found a run with scenario {}, seed {} and {} modules, accepted {}, {} and "
                      "{}: give the same --scenario, --seed and --robot",
                      found, scene.seed, scene.module_count, own, expected.seed, expected.module_count));
  });
  impl_->world.take([this, &expected](const msg::WorldState& world) {
    if (world.module_count == expected.module_count && world.object_count == expected.object_count)
      impl_->newest = world;
  });
  return impl_->newest;
}

}  // namespace constrictor::camera_emulator
