// Fidelity of the simulation: four levels, chosen from what `spindrift study --suite trade` measures (README,
// "What accuracy costs").
#pragma once

#include <optional>
#include <string>

#include <spindrift/v1/scene.pb.h>

namespace spindrift::scene {

/// The level of a name in any case, "draft"; nullopt where there is none.
std::optional<v1::Fidelity> parseFidelity(std::string_view name);
/// "draft"
std::string fidelityName(v1::Fidelity fidelity);

/// Turns the numbers of a parsed scene, which are those of BALANCED, into those of its `fidelity`. Defaults need not be
/// filled in; what the scene leaves out and the level chooses is set. Once a scene: numbers scale again when called
/// again.
void applyFidelity(v1::Scene& scene);

}  // namespace spindrift::scene
