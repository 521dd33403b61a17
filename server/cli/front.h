// What `serve` and `edge` share: access, signals, the network's options, printing the configuration.
#pragma once

#include <csignal>
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

 private:
  sigset_t set_{};
};

/// An address as it stands in a URL.
std::string forUrl(const std::string& address);

/// Options of the network; the address may be that of an inherited socket.
net::ServerOptions networkOptions(const FrontOptions& options);

/// Whether anybody who can reach the address is an operator.
bool isOpenToAll(const FrontOptions& options, const access::Access& access);
void warnOpenToAll(const FrontOptions& options);

/// `runs_rooms`: a server. The name of the node is made if it is not given.
cluster::NodeOptions nodeOptions(const FrontOptions& options, bool runs_rooms);

/// Prints the configuration to standard output; returns the exit code.
int printConfig(const OptionSources& sources);

/// Logs what the network did, at the end.
void logNetwork(const net::ServerStats& stats);

}  // namespace spindrift::cli
