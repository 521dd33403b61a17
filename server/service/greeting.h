// What a session is told first: the room, its scene, and the limits of the server.
#pragma once

#include <spindrift/service/sessions.h>

namespace spindrift::service {

/// The most that a subscription gets.
constexpr double kFrameRateMax_hz = 60.0;

/// Returns the greeting of a room as it is in `view`. `session`: 0 in a recording.
core::SharedBytes greetingOf(const Venue& venue, const VenueView& view, net::SessionId session,
                             const SessionRules& rules);

}  // namespace spindrift::service
