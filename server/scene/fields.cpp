#include <cmath>
#include <cstdint>
#include <utility>

#include <google/protobuf/descriptor.h>

#include <spindrift/core/text.h>
#include <spindrift/scene/fields.h>

namespace spindrift::scene {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

bool isWholeNumberField(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_UINT32;
}

std::string rangeAdvice(const v1::ParameterOptions& options) {
  return "; choose " + core::formatNumber(options.min()) + " to " + core::formatQuantity(options.max(), options.unit());
}

std::string multipleAdvice(const v1::ParameterOptions& options, double value) {
  const double multiple = options.multiple_of();
  const double below = std::floor(value / multiple) * multiple;
  const double above = below + multiple;
  const bool below_fits = below >= options.min();
  const bool above_fits = above <= options.max();
  std::string text = "; choose ";
  if (below_fits) text += core::formatNumber(below);
  if (below_fits && above_fits) text += " or ";
  if (above_fits) text += core::formatNumber(above);
  return text;
}

FieldIssue outOfRange(std::string message) {
  return {v1::REJECT_REASON_OUT_OF_RANGE, {}, std::move(message)};
}

}  // namespace

void forEachField(const Message& message, const std::string& prefix, const FieldVisitor& visit) {
  const Reflection& reflection = *message.GetReflection();
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    const std::string path = prefix + field.name();
    if (field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
      visit(message, field, path);
    } else if (field.is_repeated()) {
      for (int k = 0; k < reflection.FieldSize(message, &field); ++k)
        forEachField(reflection.GetRepeatedMessage(message, &field, k), path + "[" + std::to_string(k) + "].", visit);
    } else if (reflection.HasField(message, &field)) {
      forEachField(reflection.GetMessage(message, &field), path + ".", visit);
    }
  }
}

const v1::ParameterOptions* parameterOptions(const FieldDescriptor& field) {
  if (field.is_repeated() || !field.options().HasExtension(v1::parameter)) return nullptr;
  return &field.options().GetExtension(v1::parameter);
}

double numberOf(const Message& message, const FieldDescriptor& field) {
  const Reflection& reflection = *message.GetReflection();
  if (field.has_presence() && !reflection.HasField(message, &field)) return parameterOptions(field)->default_();
  if (isWholeNumberField(field)) return reflection.GetUInt32(message, &field);
  return reflection.GetDouble(message, &field);
}

void setNumber(Message& message, const FieldDescriptor& field, double value) {
  const Reflection& reflection = *message.GetReflection();
  if (isWholeNumberField(field)) {
    reflection.SetUInt32(&message, &field, static_cast<std::uint32_t>(value));
  } else {
    reflection.SetDouble(&message, &field, value);
  }
}

std::optional<FieldIssue> checkNumber(const FieldDescriptor& field, double value) {
  const v1::ParameterOptions& options = *parameterOptions(field);
  const std::string text = core::formatQuantity(value, options.unit());
  if (!std::isfinite(value)) {
    return FieldIssue{
        v1::REJECT_REASON_NOT_FINITE, {}, core::formatNumber(value) + " is not a finite number" + rangeAdvice(options)};
  }
  if (value < options.min()) {
    return outOfRange(text + " is below the minimum of " + core::formatQuantity(options.min(), options.unit()) +
                      rangeAdvice(options));
  }
  if (value > options.max()) {
    return outOfRange(text + " is above the maximum of " + core::formatQuantity(options.max(), options.unit()) +
                      rangeAdvice(options));
  }
  if (!isWholeNumberField(field)) return std::nullopt;
  if (value != std::floor(value)) return outOfRange(text + " is not a whole number" + rangeAdvice(options));
  if (options.multiple_of() > 0 && std::fmod(value, options.multiple_of()) != 0.0) {
    return outOfRange(text + " is not a multiple of " + core::formatNumber(options.multiple_of()) +
                      multipleAdvice(options, value));
  }
  return std::nullopt;
}

void checkFields(const Message& message, const std::string& prefix, std::vector<FieldIssue>& issues) {
  forEachField(message, prefix, [&](const Message& part, const FieldDescriptor& field, const std::string& path) {
    const Reflection& reflection = *part.GetReflection();
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM && !field.is_repeated()) {
      const int number = reflection.GetEnumValue(part, &field);
      if (field.enum_type()->FindValueByNumber(number) != nullptr) return;
      issues.push_back({v1::REJECT_REASON_OUT_OF_RANGE, path,
                        std::to_string(number) + " is not of type " + field.enum_type()->name() + "; choose 1 to " +
                            std::to_string(field.enum_type()->value_count() - 1)});
    } else if (parameterOptions(field) != nullptr && !(field.has_presence() && !reflection.HasField(part, &field))) {
      if (auto issue = checkNumber(field, numberOf(part, field))) {
        issue->path = path;
        issues.push_back(std::move(*issue));
      }
    }
  });
}

void fillMessageDefaults(Message& message) {
  forEachField(message, "", [](const Message& visited, const FieldDescriptor& field, const std::string&) {
    auto& part = const_cast<Message&>(visited);  // of `message`, which may be modified
    const Reflection& reflection = *part.GetReflection();
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM && !field.is_repeated()) {
      // An `optional` one may be left out: then it says nothing.
      if (!field.has_presence() && reflection.GetEnumValue(part, &field) == 0)
        reflection.SetEnumValue(&part, &field, 1);
    } else if (const v1::ParameterOptions* options = parameterOptions(field)) {
      if (field.has_presence() && !reflection.HasField(part, &field)) setNumber(part, field, options->default_());
    }
  });
}

}  // namespace spindrift::scene
