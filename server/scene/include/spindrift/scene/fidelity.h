// Fidelity of the simulation: four levels, chosen from what `spindrift-study --suite trade` measures (README,
// "What accuracy costs").
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <spindrift/core/result.h>
#include <spindrift/v1/fidelity_errors.pb.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::scene {

/// The levels, coarsest first.
inline constexpr std::array kFidelities = {v1::FIDELITY_DRAFT, v1::FIDELITY_BALANCED, v1::FIDELITY_FINE,
                                           v1::FIDELITY_REFERENCE};
/// Returns the level's index in kFidelities; that of BALANCED for UNSPECIFIED.
std::size_t rankOf(v1::Fidelity fidelity);
/// Returns the next level; nullopt beyond the last one.
std::optional<v1::Fidelity> coarserThan(v1::Fidelity fidelity);
std::optional<v1::Fidelity> finerThan(v1::Fidelity fidelity);

/// Returns the level for a name in any case, "draft"; nullopt for an unknown name.
std::optional<v1::Fidelity> parseFidelity(std::string_view name);
/// Returns "draft", ...
std::string fidelityName(v1::Fidelity fidelity);

/// Converts the numbers of a parsed scene, which are those of BALANCED, to its `fidelity`. Defaults need not be filled
/// in: fields that the scene leaves out and the level chooses are set. Call it once per scene, because a second call
/// scales again.
void applyFidelity(v1::Scene& scene);

/// A file beside the scenes with their measured errors at the levels, which `./dev study --update` writes.
inline constexpr const char* kFidelityErrorsFile = "fidelity_errors.txtpb";

/// Reads kFidelityErrorsFile in a folder of scenes; empty without that file. Errors: kUnavailable if it cannot be read;
/// kInvalidInput, with the place, if it is not a v1::FidelityErrors with an error of 0 or more per level in each scene.
core::Result<v1::FidelityErrors> loadFidelityErrors(const std::filesystem::path& folder);

}  // namespace spindrift::scene
