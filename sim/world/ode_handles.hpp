// Owners of ODE's handles. ODE destroys bodies and joints together with their world.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <type_traits>

namespace constrictor {

/// Initialises ODE at the first call in the process.
void ensure_ode();

template <auto Destroy>
struct OdeDeleter {
  template <class T>
  void operator()(T* handle) const {
    Destroy(handle);
  }
};

using OdeWorld = std::unique_ptr<std::remove_pointer_t<dWorldID>, OdeDeleter<dWorldDestroy>>;
using OdeJointGroup = std::unique_ptr<std::remove_pointer_t<dJointGroupID>, OdeDeleter<dJointGroupDestroy>>;
using OdeGeom = std::unique_ptr<std::remove_pointer_t<dGeomID>, OdeDeleter<dGeomDestroy>>;

}  // namespace constrictor
