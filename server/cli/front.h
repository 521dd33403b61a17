// What `serve` and `edge` share: access, signals, the network's options, printing the configuration.
#pragma once

#include <chrono>
#include <csignal>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <spindrift/cluster/node.h>
#include <spindrift/core/result.h>
#include <spindrift/net/server.h>
#include <spindrift/service/access_control.h>

#include "serve_options.h"

namespace spindrift::cli {

/// Reads tokens and keys, and opens the audit log.
core::Result<service::AccessOptions> accessOptions(const FrontOptions& options);

/// Reads the files of tokens and keys again, and opens the audit log anew. With a wrong file, everything stays as it
/// was.
void reload(const FrontOptions& options, service::AccessControl& access, access::AuditFile* audit_file);

/// Blocks SIGINT, SIGTERM and SIGHUP in this thread and in those that it starts, so that wait() receives them.
class StopSignals {
 public:
  StopSignals();
  /// Returns the signal that ends the program; calls `reload` for each SIGHUP before it.
  int wait(const std::function<void()>& reload);
  /// Returns 0 if no signal comes in time.
  int waitFor(std::chrono::milliseconds duration);

 private:
  sigset_t set_{};
};

/// Has the effect of SIGTERM; for an operator's request.
void endThisProcess();

/// Gives the clients the time to go: returns when all have gone, the time is over, or another signal asks for the end.
/// `begin` tells them.
void drain(const FrontOptions& options, StopSignals& signals, const std::function<std::uint64_t()>& session_count,
           const std::function<void(std::chrono::milliseconds)>& begin);

/// Prints readyText().
void sayReady(const FrontOptions& options, std::uint16_t port);

/// Options of the network; the address may be that of an inherited socket.
net::ServerOptions networkOptions(const FrontOptions& options);

/// Warns if others can reach the server and every client is an operator.
void warnIfOpenToAll(const FrontOptions& options);

/// `runs_rooms`: a server. The name of the node is made if it is not given.
cluster::NodeOptions nodeOptions(const FrontOptions& options, bool runs_rooms);

/// Prints the configuration to standard output; returns the exit code.
int printConfig(const OptionSources& sources);

/// Logs what the network did, at the end.
void logNetwork(const net::ServerStats& stats);

}  // namespace spindrift::cli
