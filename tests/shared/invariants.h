// Properties of everything that is parsed from hostile bytes: the claims in the headers of wire and codec, as
// predicates.
#pragma once

#include <cmath>
#include <cstdlib>
#include <string>
#include <variant>
#include <vector>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::test {

/// Every number of the action is finite and within its bounds.
inline bool isFinite(const core::Action& action) {
  if (const auto* splash = std::get_if<core::Splash>(&action)) {
    return std::isfinite(splash->x_m + splash->z_m + splash->radius_m + splash->depth_m + splash->duration_s);
  }
  if (const auto* wave = std::get_if<core::BreakingWave>(&action)) {
    return std::isfinite(wave->amplitude_m + wave->length_m + wave->duration_s);
  }
  if (const auto* set = std::get_if<core::SetParameter>(&action)) return std::isfinite(set->value);
  if (const auto* speed = std::get_if<core::SetSpeed>(&action)) return std::isfinite(speed->speed);
  if (const auto* spawn = std::get_if<core::SpawnBoat>(&action)) {
    const core::Boat& boat = spawn->boat;
    return std::isfinite(boat.x_m + boat.z_m + boat.heading_deg + boat.length_m + boat.beam_m + boat.height_m +
                         boat.density_ratio + boat.max_speed_mps + boat.throttle_ratio + boat.rudder_ratio);
  }
  if (const auto* control = std::get_if<core::ControlBoat>(&action)) {
    return std::abs(control->throttle_ratio) <= 1 && std::abs(control->rudder_ratio) <= 1;
  }
  if (const auto* step = std::get_if<core::Step>(&action)) return step->tick_count >= 1 && step->tick_count <= 600;
  if (const auto* change = std::get_if<core::ChangeScene>(&action)) {
    return !change->name.empty() && change->name.size() <= 64 && change->name.find('/') == std::string::npos;
  }
  return true;
}

/// The guarantees of parseClientMessage() for its result.
inline bool isHarmless(const wire::ClientMessage& message) {
  if (const auto* hello = std::get_if<wire::Hello>(&message)) {
    return hello->client.size() <= wire::kClientNameMaxBytes && hello->name.size() <= wire::kPersonNameMaxBytes;
  }
  if (const auto* subscribe = std::get_if<wire::Subscribe>(&message)) {
    return subscribe->max_rate_hz >= 0 && subscribe->max_rate_hz <= 240 && v1::Layer_IsValid(subscribe->layer);
  }
  if (const auto* ping = std::get_if<wire::Ping>(&message)) return std::isfinite(ping->client_time_s);
  if (const auto* command = std::get_if<core::Command>(&message)) return isFinite(command->action);
  if (const auto* rejection = std::get_if<wire::CommandRejection>(&message)) {
    return rejection->reason != v1::REJECT_REASON_UNSPECIFIED && !rejection->message.empty();
  }
  return !std::get<wire::Malformed>(message).message.empty();
}

inline bool allFinite(const std::vector<float>& values) {
  for (const float value : values) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

/// The number of values matches the header, and all are finite.
inline bool isWhole(const codec::SurfaceSamples& surface) {
  return surface.elevation_m.size() == std::size_t{surface.resolution_count} * surface.resolution_count &&
         allFinite(surface.elevation_m);
}
inline bool isWhole(const codec::ParticleSamples& particles) {
  return particles.position_m.size() == std::size_t{3} * particles.count &&
         particles.velocity_mps.size() == std::size_t{3} * particles.count &&
         particles.tint.size() == particles.count && particles.foam.size() == particles.count &&
         allFinite(particles.position_m) && allFinite(particles.velocity_mps);
}
inline bool isWhole(const codec::FoamSamples& foam) {
  return foam.foam.size() == std::size_t{foam.resolution_count} * foam.resolution_count;
}

}  // namespace spindrift::test
