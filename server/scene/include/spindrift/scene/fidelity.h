// Fidelity of the simulation: four levels, chosen from what `spindrift study --suite trade` measures (README,
// "What accuracy costs").
#pragma once

#include <optional>
#include <string>

#include <spindrift/v1/scene.pb.h>

namespace spindrift::scene {

/// Returns the level for a name in any case, "draft"; nullopt for an unknown name.
std::optional<v1::Fidelity> parseFidelity(std::string_view name);
/// Returns "draft", ...
std::string fidelityName(v1::Fidelity fidelity);

/// Converts the numbers of a parsed scene, which are those of BALANCED, to its `fidelity`. Defaults need not be filled
/// in: fields that the scene leaves out and the level chooses are set. Call it once per scene, because a second call
/// scales again.
void applyFidelity(v1::Scene& scene);

}  // namespace spindrift::scene
