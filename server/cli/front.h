// What `serve` and `edge` share: access, signals, the network's options, printing the configuration.
#pragma once

#include <csignal>
#include <memory>
#include <optional>
#include <string>

#include <spindrift/cluster/node.h>
#include <spindrift/core/result.h>
#include <spindrift/net/server.h>
#include <spindrift/service/access.h>

#include "serve_options.h"

namespace spindrift::cli {

/// Reads the tokens from the file or from the environment, and the role of clients without a token.
core::Result<service::Access> loadAccess(const FrontOptions& options);

/// Blocks SIGINT and SIGTERM in this thread and in those that it starts, so that wait() receives them.
class StopSignals {
 public:
  StopSignals();
  int wait();

 private:
  sigset_t set_{};
};

/// An address as it stands in a URL.
std::string forUrl(const std::string& address);

/// Options of the network; the address may be that of an inherited socket.
net::ServerOptions networkOptions(const FrontOptions& options);

/// Whether anybody who can reach the address is an operator.
bool isOpenToAll(const FrontOptions& options, const service::Access& access);
void warnOpenToAll(const FrontOptions& options);

/// `runs_rooms`: a server. The name of the node is made if it is not given.
cluster::NodeOptions nodeOptions(const FrontOptions& options, bool runs_rooms);

/// Prints the configuration to standard output; returns the exit code.
int printConfig(const OptionSources& sources);

/// Logs what the network did, at the end.
void logNetwork(const net::ServerStats& stats);

}  // namespace spindrift::cli
