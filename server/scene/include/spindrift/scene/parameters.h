// Parameters: the numbers of a scene, described only by the options on their proto fields.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/scene/fields.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::scene {

/// Returns the parameters that SetParameter accepts in this scene, with current values: the fields of the present parts
/// that need no restart, in the order of the proto file. Numbers of events are not included.
std::vector<v1::ParameterDescription> describeParameters(const v1::Scene& scene);

/// Returns those of describeParameters(now) whose values differ from those in `file`, the same scene as it was read.
std::vector<v1::ParameterDescription> changedParameters(const v1::Scene& file, const v1::Scene& now);

/// Checks whether `value` may be set at `path` ("particles.viscosity_pas"); nullopt = yes. The issue's path is the
/// requested one, cleaned and shortened for display. Reasons: UNKNOWN_PARAMETER,
/// ABSENT_PART, NEEDS_RESTART, NOT_FINITE, OUT_OF_RANGE (also for a count that is not whole, or a conflict with the
/// rest of the scene, such as water shallower than a boat's draught). Slider steps are not enforced.
std::optional<FieldIssue> checkParameter(const v1::Scene& scene, std::string_view path, double value);

/// Sets the parameter. On error, returns it as checkParameter() does and leaves the scene unchanged.
std::optional<FieldIssue> setParameter(v1::Scene& scene, std::string_view path, double value);

/// Gives `to`, the same scene at another level of fidelity, the present values of the parameters that change while a
/// room runs (`from`), except those that applyFidelity() chooses. Does not check the result.
void keepParameters(const v1::Scene& from, v1::Scene& to);

/// Returns one Markdown table of every number of a scene, including restart-only ones and those of events, for the
/// reference documentation.
std::string parameterReferenceMarkdown();

}  // namespace spindrift::scene
