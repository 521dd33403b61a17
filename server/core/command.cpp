#include <array>
#include <cstddef>

#include <spindrift/core/command.h>

namespace spindrift::core {
namespace {

template <class... T>
bool isOneOf(const Action& action) {
  return (std::holds_alternative<T>(action) || ...);
}

constexpr std::array<std::string_view, 3> kRoleNames{"viewer", "player", "operator"};

}  // namespace

Role roleFor(const Action& action) {
  const bool is_play = isOneOf<Splash, BreakingWave, SpawnBoat, ControlBoat, RemoveBoat, TakeBoat>(action);
  return is_play ? Role::kPlayer : Role::kOperator;
}

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
