// A session of Foxglove's WebSocket protocol (subprotocols foxglove.sdk.v1 and foxglove.websocket.v1, which are the
// same: github.com/foxglove/ws-protocol, docs/spec.md) as an ordinary session of the wire: it says hello, subscribes to
// plain layers and sends commands, and gets what other sessions get.
#pragma once

#include <memory>
#include <string>

#include <spindrift/core/level.h>
#include <spindrift/core/translator.h>

namespace spindrift::foxglove {

/// Frames per second of each layer, and their level of detail: at most 256 x 256 samples and 32,768 particles.
inline constexpr double kLiveRate_hz = 15.0;
inline constexpr core::Level kLiveLevel = core::Level::kMedium;

/// Commands of a session whose answers have not come; calls of services and changes of parameters beyond it are
/// refused.
inline constexpr std::size_t kLiveCommandMaxCount = 64;

/// Returns the translator of a new session. `token`: of its person, secret; empty: a guest.
std::unique_ptr<core::Translator> makeLiveSession(std::string token);

}  // namespace spindrift::foxglove
