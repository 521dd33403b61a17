// How clients in C++ join a room and follow a server that is about to end.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <spindrift/net/client.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::client {

/// The person that joins. `program` is for the server's log.
struct Identity {
  std::string program;
  std::string name;
  std::string token;
  std::string resume_key;
};

/// Returns Hello with the version of the wire of this build.
v1::ClientMessage hello(const Identity& identity);

/// Address and time of the next connection.
struct Move {
  net::ClientUrl url;
  std::chrono::steady_clock::time_point at;
};

/// Returns the move that a Draining message asks for: within its range of times, at most 60 s from now. The path of
/// `url`, which names the room, stays. Empty for an address that is invalid.
std::optional<Move> planMove(const v1::Draining& draining, const net::ClientUrl& url);

/// Returns whether connecting again does not help, after a session that ended with this code and reason of
/// ClientEvents::closed.
bool isFinal(std::uint16_t code, const std::string& reason);

}  // namespace spindrift::client
