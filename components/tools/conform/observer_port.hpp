// A camera in a run that goes on: this process only reads.
#pragma once

#include <cstdint>
#include <functional>

#include "conform/part_port.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/wait_set.hpp"

namespace constrictor::conform {

class ObserverPort final : public PartPort {
 public:
  /// Joins the domain. advance() takes one control period of wall time, and throws PartGone when `interrupted()`.
  ObserverPort(std::uint32_t domain, std::function<bool()> interrupted);
  void begin_epoch() override { throw PartGone("an observer begins no epoch"); }
  [[nodiscard]] std::uint64_t refused() override { return 0; }
  [[nodiscard]] std::string restart() override { return "an observer kills no process of a run"; }
  [[nodiscard]] std::uint32_t incarnation() override { return 1; }

 private:
  void exchange(std::vector<Letter> outgoing) override;
  template <class T>
  void take(dds::Reader<T>& reader, const Topic<T>& topic);
  dds::Domain domain_;
  std::function<bool()> interrupted_;
  dds::Reader<msg::CameraInfo> infos_;
  dds::Reader<msg::CameraImage> images_;
  dds::Reader<msg::JointState> joints_;
  dds::WaitSet wait_set_;
};

}  // namespace constrictor::conform
