#include <spindrift/core/version.h>

namespace spindrift::core {

std::string_view version() {
  return SPINDRIFT_VERSION;
}

std::string_view nameAndVersion() {
  return "spindrift " SPINDRIFT_VERSION;
}

}  // namespace spindrift::core
