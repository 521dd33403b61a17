#include <spindrift/core/command.h>

namespace spindrift::core {
namespace {

template <class... T>
bool isOneOf(const Action& action) {
  return (std::holds_alternative<T>(action) || ...);
}

}  // namespace

Role roleFor(const Action& action) {
  const bool is_play = isOneOf<Splash, BreakingWave, SpawnBoat, ControlBoat, RemoveBoat, TakeBoat>(action);
  return is_play ? Role::kPlayer : Role::kOperator;
}

}  // namespace spindrift::core
