// Number fields of a message, by reflection: their options, ranges and defaults. The only code that reads the proto
// options.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <google/protobuf/message.h>

#include <spindrift/v1/options.pb.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::scene {

/// An error in one field.
struct FieldIssue {
  v1::RejectReason reason = v1::REJECT_REASON_UNSPECIFIED;
  std::string path;     ///< relative to the message checked: "events[0].effect.splash.depth_m"
  std::string message;  ///< value, bound, what to do; without the path
  /// The permitted value that is nearest to the refused one, where the rule knows it.
  std::optional<double> nearest{};
};

inline void addRange(std::vector<FieldIssue>& issues, std::string path, std::string message,
                     std::optional<double> nearest = std::nullopt) {
  issues.push_back({v1::REJECT_REASON_OUT_OF_RANGE, std::move(path), std::move(message), nearest});
}

inline void addAbsent(std::vector<FieldIssue>& issues, std::string path, std::string message) {
  issues.push_back({v1::REJECT_REASON_ABSENT_PART, std::move(path), std::move(message)});
}

/// Calls `visit` for every field that is not a message, whether it is set or not, in the message and in the parts of it
/// that are present: with its part, and with its path, in front of which stands `prefix`.
using FieldVisitor = std::function<void(const google::protobuf::Message& part,
                                        const google::protobuf::FieldDescriptor& field, const std::string& path)>;
void forEachField(const google::protobuf::Message& message, const std::string& prefix, const FieldVisitor& visit);

/// Returns the field's options; null if the field is not a number with a range.
const v1::ParameterOptions* parameterOptions(const google::protobuf::FieldDescriptor& field);

/// Returns the value of a number field; its default if the field was left out and has presence.
double numberOf(const google::protobuf::Message& message, const google::protobuf::FieldDescriptor& field);

/// Sets a number field to a value that checkNumber() accepted.
void setNumber(google::protobuf::Message& message, const google::protobuf::FieldDescriptor& field, double value);

/// Returns the reason why `value` does not fit the field (not finite, not whole, out of range, not a multiple); nullopt
/// if it fits. The path is not set.
std::optional<FieldIssue> checkNumber(const google::protobuf::FieldDescriptor& field, double value);

/// Checks every number and enum that is set, in the parts that are present. `prefix` is put in front of each path.
void checkFields(const google::protobuf::Message& message, const std::string& prefix, std::vector<FieldIssue>& issues);

/// Sets defaults for every number left out and every enum UNSPECIFIED (its value 1, as the proto files say), in the
/// parts that are present. An enum with presence (`optional`) stays as it is.
void fillMessageDefaults(google::protobuf::Message& message);

}  // namespace spindrift::scene
