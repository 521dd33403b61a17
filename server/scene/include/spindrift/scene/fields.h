// Numbers of a message by reflection: their options, ranges and defaults. The only reader of the proto options.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <google/protobuf/message.h>

#include <spindrift/v1/options.pb.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::scene {

/// One thing wrong with one field.
struct FieldIssue {
  v1::RejectReason reason = v1::REJECT_REASON_UNSPECIFIED;
  std::string path;     ///< from the message checked: "events[0].effect.splash.depth_m"
  std::string message;  ///< value, bound, what to do; without the path
};

inline void addRange(std::vector<FieldIssue>& issues, std::string path, std::string message) {
  issues.push_back({v1::REJECT_REASON_OUT_OF_RANGE, std::move(path), std::move(message)});
}

inline void addAbsent(std::vector<FieldIssue>& issues, std::string path, std::string message) {
  issues.push_back({v1::REJECT_REASON_ABSENT_PART, std::move(path), std::move(message)});
}

/// The field's options; null where the field is no number with a range.
const v1::ParameterOptions* parameterOptions(const google::protobuf::FieldDescriptor& field);

/// The value of a number field, its default where a field that can tell was left out.
double numberOf(const google::protobuf::Message& message, const google::protobuf::FieldDescriptor& field);

/// Sets a number field to a value that checkNumber found fine.
void setNumber(google::protobuf::Message& message, const google::protobuf::FieldDescriptor& field, double value);

/// Why `value` does not fit the field (not finite, not whole, out of range, not a multiple); nullopt = fits. No path
/// set.
std::optional<FieldIssue> checkNumber(const google::protobuf::FieldDescriptor& field, double value);

/// Checks every number and enum that is set, in the parts that are present. `prefix` goes in front of each path.
void checkFields(const google::protobuf::Message& message, const std::string& prefix, std::vector<FieldIssue>& issues);

/// Defaults for every number left out and every enum UNSPECIFIED (its value 1, as the proto files say), in the parts
/// that are present.
void fillMessageDefaults(google::protobuf::Message& message);

}  // namespace spindrift::scene
