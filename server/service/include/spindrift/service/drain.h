// The end of a process whose clients shall continue elsewhere, or here after a restart.
#pragma once

#include <chrono>
#include <string>

#include <spindrift/net/server.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::service {

/// Refuses new sessions from now on. Returns the message for the clients: when their sessions are closed, where to go
/// (empty: back here), and within which time to come, spread so that they do not come all at once.
v1::Draining beginDrain(net::Server& network, std::chrono::milliseconds closes_in, const std::string& go_to);

}  // namespace spindrift::service
