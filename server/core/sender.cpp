#include <array>
#include <cstddef>

#include <spindrift/core/sender.h>

namespace spindrift::core {
namespace {

constexpr std::array<std::string_view, 3> kRoleNames{"viewer", "player", "operator"};

}  // namespace

std::string_view roleName(Role role) {
  return kRoleNames[static_cast<std::size_t>(role)];
}

std::optional<Role> parseRole(std::string_view name) {
  for (std::size_t k = 0; k < kRoleNames.size(); ++k) {
    if (kRoleNames[k] == name) return static_cast<Role>(k);
  }
  return std::nullopt;
}

}  // namespace spindrift::core
