// Parameters: every number a scene holds, described by the options on its proto field and by nothing else.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::scene {

/// Returns what SetParameter takes in this scene, with current values: the fields of the present parts that need no
/// restart, in the order of the proto file. Events are no parameters.
std::vector<v1::ParameterDescription> describeParameters(const v1::Scene& scene);

/// Why a parameter was not set.
struct ParameterError {
  v1::RejectReason reason = v1::REJECT_REASON_UNSPECIFIED;
  std::string field;    ///< the path asked for, cleaned and shortened for display
  std::string message;  ///< one line for a person: value, bound with unit, what to do
};

/// Checks whether `value` may be set at `path` ("particles.viscosity_pas"); nullopt = yes. Reasons: UNKNOWN_PARAMETER,
/// ABSENT_PART, NEEDS_RESTART, NOT_FINITE, OUT_OF_RANGE (also a count that is not whole, or what the rest of the scene
/// forbids: water shallower than a boat's draught). Slider steps are not enforced.
std::optional<ParameterError> checkParameter(const v1::Scene& scene, std::string_view path, double value);

/// Sets it, or leaves the scene untouched and says why as checkParameter does.
std::optional<ParameterError> setParameter(v1::Scene& scene, std::string_view path, double value);

/// Every number of a scene, restart-only ones and those of events included, as one Markdown table for the reference
/// documentation.
std::string parameterReferenceMarkdown();

}  // namespace spindrift::scene
