// What `serve` and `edge` share: options, access, and the time from the start to the end.
#pragma once

#include <chrono>
#include <csignal>
#include <functional>
#include <memory>

#include <spindrift/cluster/node.h>
#include <spindrift/core/result.h>
#include <spindrift/net/server.h>
#include <spindrift/service/access_control.h>

#include "commands.h"
#include "serve_options.h"

namespace spindrift::cli {

/// Reads tokens and keys, and opens the audit log.
core::Result<service::AccessOptions> accessOptions(const FrontOptions& options);

/// Blocks SIGINT, SIGTERM and SIGHUP in this thread and in those that it starts, so that runUntilSignal() receives
/// them.
struct StopSignals {
  StopSignals();
  sigset_t set{};
};

/// Has the effect of SIGTERM; for an operator's request.
void endThisProcess();

/// A server that has started, as runUntilSignal() needs it.
struct RunningServer {
  net::Server& network;
  service::AccessControl& access;
  std::function<void(std::chrono::milliseconds)> drain;  ///< tells the clients
  std::function<void()> leave{};                         ///< before the clients are told to go
};

/// Says that the server is ready and waits for SIGINT or SIGTERM. For each SIGHUP before, reads the certificate and the
/// files of tokens and keys again, and opens the audit log anew; with a wrong file, everything stays as it was. Then
/// gives the clients the time to go: returns when all have gone, the time is over, or another signal asks for the end.
void runUntilSignal(const FrontOptions& options, const StopSignals& signals, const RunningServer& server);

/// Options of the network; the address may be that of an inherited socket.
net::ServerOptions networkOptions(const FrontOptions& options);

/// `runs_rooms`: a server. The name of the node is made if it is not given.
cluster::NodeOptions nodeOptions(const FrontOptions& options, bool runs_rooms);

/// Makes the command of options that may also come from the environment and a file: `run`, or --print-config.
ProgramCommand frontCommand(CLI::App& program, CLI::App& command, const std::shared_ptr<FrontOptions>& options,
                            const std::function<int()>& run);

/// Logs what the network did, at the end.
void logNetwork(const net::ServerStats& stats);

}  // namespace spindrift::cli
