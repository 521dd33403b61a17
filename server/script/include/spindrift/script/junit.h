// The report of a script in the XML form of JUnit, which services for continuous integration read.
#pragma once

#include <cstdint>
#include <string>

#include <spindrift/script/script.h>

namespace spindrift::script {

/// Returns the hash of a state as scripts and reports write it, "0x0123456789abcdef".
[[nodiscard]] std::string hashText(std::uint64_t hash);
/// Returns a suite with one case per step: passed, failed with what was seen and wanted, or skipped after a failure.
[[nodiscard]] std::string toJunit(const ScriptReport& report, const std::string& name);

}  // namespace spindrift::script
