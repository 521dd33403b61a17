// Properties of everything that is parsed from hostile bytes: the claims in the headers of wire and codec, as
// predicates.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <variant>
#include <vector>

#include <google/protobuf/message.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/scene/scene_rules.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::test {

/// Every number of the message is finite.
inline bool isFinite(const google::protobuf::Message& message) {
  using google::protobuf::FieldDescriptor;
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  return std::ranges::all_of(fields, [&](const FieldDescriptor* field) {
    if (field->is_repeated()) {  // of messages and of values of an enum, which are integers
      if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) return true;
      for (int k = 0; k < reflection.FieldSize(message, field); ++k)
        if (!isFinite(reflection.GetRepeatedMessage(message, field, k))) return false;
      return true;
    }
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE)
      return std::isfinite(reflection.GetDouble(message, field));
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) return isFinite(reflection.GetMessage(message, field));
    return true;
  });
}

/// The guarantees of wire::checkCommand() for a command that it accepts.
inline bool isChecked(const v1::Command& command) {
  if (!isFinite(command)) return false;
  switch (command.action_case()) {
    case v1::Command::ACTION_NOT_SET:
      return false;
    case v1::Command::kSplash:
      return scene::toCore(command.splash()).radius_m > 0 && scene::toCore(command.splash()).duration_s > 0;
    case v1::Command::kControlBoat:
      return std::abs(command.control_boat().throttle_ratio()) <= 1 &&
             std::abs(command.control_boat().rudder_ratio()) <= 1;
    case v1::Command::kSpawnBoat:
      return scene::toCore(command.spawn_boat().boat()).length_m > 0;
    case v1::Command::kSpawnFloater:
      return scene::toCore(command.spawn_floater().floater()).size_m > 0;
    case v1::Command::kStep:
      return !command.step().has_tick_count() ||
             (command.step().tick_count() >= 1 && command.step().tick_count() <= 600);
    case v1::Command::kChangeScene: {
      const std::string& name = command.change_scene().name();
      return !name.empty() && name.size() <= 64 && name.find('/') == std::string::npos;
    }
    default:
      return true;
  }
}

/// The guarantees of parseClientMessage() for its result.
inline bool isHarmless(const wire::ClientMessage& message) {
  if (const auto* hello = std::get_if<v1::Hello>(&message)) {
    return hello->client().size() <= wire::kClientNameMaxBytes && hello->name().size() <= wire::kPersonNameMaxBytes;
  }
  if (const auto* subscribe = std::get_if<wire::Subscribe>(&message)) {
    return subscribe->max_rate_hz >= 0 && subscribe->max_rate_hz <= 240 && v1::Layer_IsValid(subscribe->layer);
  }
  if (const auto* ping = std::get_if<v1::Ping>(&message)) return std::isfinite(ping->client_time_s());
  if (const auto* command = std::get_if<v1::Command>(&message)) return isChecked(*command);
  if (const auto* rejection = std::get_if<wire::CommandRejection>(&message)) {
    return rejection->reason() != v1::REJECT_REASON_UNSPECIFIED && !rejection->message().empty();
  }
  return !std::get<core::Error>(message).message.empty();
}

inline bool allFinite(const std::vector<float>& values) {
  for (const float value : values) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

/// The number of values matches the header, and all are finite.
inline bool isWhole(const codec::SurfaceSamples& surface) {
  return surface.elevation_m.size() == surface.count.total() && allFinite(surface.elevation_m);
}
inline bool isWhole(const codec::ParticleSamples& particles) {
  return particles.position_m.size() == std::size_t{3} * particles.count &&
         particles.velocity_mps.size() == std::size_t{3} * particles.count &&
         particles.tint.size() == particles.count && particles.foam.size() == particles.count &&
         allFinite(particles.position_m) && allFinite(particles.velocity_mps);
}
/// Each has an id, a kind, a position in the largest water and a rotation.
inline bool isWhole(const std::vector<codec::FloaterSample>& floaters) {
  return std::ranges::all_of(floaters, [](const codec::FloaterSample& floater) {
    double norm = 0.0;
    for (const double part : floater.rotation) norm += part * part;
    const bool is_near = std::ranges::all_of(floater.position_m, [](double at_m) { return std::abs(at_m) <= 1e6; });
    return is_near && floater.floater_id != 0 && floater.kind != v1::FLOATER_KIND_UNSPECIFIED &&
           std::abs(norm - 1.0) < 0.01;
  });
}
inline bool isWhole(const codec::FoamSamples& foam) {
  return foam.foam.size() == foam.count.total();
}

}  // namespace spindrift::test
