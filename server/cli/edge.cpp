#include <memory>
#include <utility>

#include <spindrift/cluster/edge_server.h>

#include "access_options.h"
#include "front.h"

namespace spindrift::cli {
namespace {

int runEdge(FrontOptions options) {
  StopSignals signals;
  if (options.nats_url.empty()) {
    return fail(
        {core::ErrorCode::kInvalidInput, "an edge needs the NATS server of its cluster: --nats nats://HOST:4222"});
  }
  makeOperatorToken(options);
  auto access = accessOptions(options);
  if (!access) return fail(access.error());
  cluster::EdgeOptions edge_options;
  edge_options.node = nodeOptions(options, false);
  edge_options.network = networkOptions(options);
  edge_options.access = *std::move(access);
  auto edge = cluster::EdgeServer::start(std::move(edge_options));
  if (!edge) return fail(edge.error());
  runUntilSignal(options, signals,
                 {.network = (*edge)->network(),
                  .access = (*edge)->access(),
                  .drain = [&](std::chrono::milliseconds closes_in) { (*edge)->drain(closes_in, options.drain_to); }});
  (*edge)->stop();
  logNetwork((*edge)->networkStats());
  return 0;
}

}  // namespace

ProgramCommand addEdge(CLI::App& program) {
  const auto options = std::make_shared<FrontOptions>();
  CLI::App* command = program.add_subcommand(
      "edge", "Serve the rooms of a cluster to many clients, without rooms of its own, until interrupted");
  addEdgeOptions(*command, *options);
  return frontCommand(program, *command, options, [options] { return runEdge(*options); });
}

}  // namespace spindrift::cli
