// Errors of Cairo as exceptions.
#pragma once

#include <cairo.h>

#include <stdexcept>
#include <string>

namespace constrictor::figure {

/// Throws std::runtime_error unless `status` is a success.
inline void require(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(std::string("cannot draw: ") + cairo_status_to_string(status));
}

}  // namespace constrictor::figure
