// Reads a script (proto/spindrift/v1/script.proto) and checks what can be checked before a client connects.
#pragma once

#include <filesystem>
#include <string>

#include <spindrift/core/result.h>
#include <spindrift/v1/script.pb.h>

namespace spindrift::script {

inline constexpr int kScriptClientMaxCount = 256;
inline constexpr int kScriptStepMaxCount = 10'000;

/// Loads a script. Errors: kUnavailable for a file that cannot be read, kInvalidInput with `FILE:LINE:COLUMN: what` or
/// `FILE: steps[3]: what`. The result has at least one client, and every step names one.
core::Result<v1::Script> loadScript(const std::filesystem::path& file);
core::Result<v1::Script> parseScript(const std::string& text, const std::string& label);

}  // namespace spindrift::script
