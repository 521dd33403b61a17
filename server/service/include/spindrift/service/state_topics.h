// Topics of a room's state messages: only the newest message of each topic waits for a client.
#pragma once

#include <string>

#include <spindrift/net/server.h>

namespace spindrift::service::topic {

// A greeting includes the content of the topics with Scope::kPart.
inline const net::StateTopic kGreeting{.name = "greeting", .scope = net::StateTopic::Scope::kWhole};
inline const net::StateTopic kRoomState{.name = "room_state", .scope = net::StateTopic::Scope::kPart};
inline const net::StateTopic kBoats{.name = "boats", .scope = net::StateTopic::Scope::kPart};
/// Returns the topic of a live parameter of the scene.
inline net::StateTopic ofParameter(const std::string& path) {
  return {.name = "parameter:" + path, .scope = net::StateTopic::Scope::kPart};
}

inline const net::StateTopic kPeople{.name = "people"};
inline const net::StateTopic kStrokes{.name = "strokes"};
inline const net::StateTopic kLesson{.name = "lesson"};
inline const net::StateTopic kGame{.name = "game"};
inline const net::StateTopic kLevel{.name = "level"};
inline const net::StateTopic kDraining{.name = "draining"};
inline const net::StateTopic kQueries{.name = "queries"};
inline const net::StateTopic kReset{.name = "reset"};
inline const net::StateTopic kRecovered{.name = "recovered"};
inline const net::StateTopic kFidelity{.name = "fidelity"};
inline const net::StateTopic kClock{.name = "clock"};

}  // namespace spindrift::service::topic
