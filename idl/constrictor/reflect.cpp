#include "constrictor/reflect.hpp"

#include <cstdio>

namespace constrictor {
namespace reflect {

std::string violation(const FieldInfo& info, std::ptrdiff_t index, double found) {
  char text[192];
  char accepted[96];
  if (info.has_range) std::snprintf(accepted, sizeof(accepted), "%g to %g", info.min, info.max);
  else std::snprintf(accepted, sizeof(accepted), "finite");
  std::snprintf(text, sizeof(text), ": found %g, accepted %s%s", found, accepted, info.nan_allowed ? " or nan" : "");
  return std::string(info.name) + (index < 0 ? "" : "[" + std::to_string(index) + "]") + text;
}

std::string violation(const FieldInfo& info, const char* found_and_accepted) {
  return std::string(info.name) + ": " + found_and_accepted;
}

}  // namespace reflect

}  // namespace constrictor
