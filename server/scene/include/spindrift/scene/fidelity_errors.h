// Measured errors of scenes at the fidelity levels: a file beside the scenes that `./dev study --update` writes.
#pragma once

#include <filesystem>

#include <spindrift/core/result.h>
#include <spindrift/v1/fidelity_errors.pb.h>

namespace spindrift::scene {

inline constexpr const char* kFidelityErrorsFile = "fidelity_errors.txtpb";

/// Reads kFidelityErrorsFile in a folder of scenes; empty without that file. Errors: kUnavailable if it cannot be read;
/// kInvalidInput, with the place, if it is not a v1::FidelityErrors with an error of 0 or more per level in each scene.
core::Result<v1::FidelityErrors> loadFidelityErrors(const std::filesystem::path& folder);

}  // namespace spindrift::scene
