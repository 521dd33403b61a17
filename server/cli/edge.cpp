#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/cluster/edge_server.h>

#include "commands.h"
#include "front.h"
#include "operator_link.h"
#include "serve_options.h"

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
  const auto audit_file = access->audit_file;
  cluster::EdgeOptions edge_options;
  edge_options.node = nodeOptions(options, false);
  edge_options.network = networkOptions(options);
  edge_options.access = *std::move(access);
  const bool has_page = !edge_options.network.web_root.empty();
  auto edge = cluster::EdgeServer::start(std::move(edge_options));
  if (!edge) return fail(edge.error());
  if (!has_page) spdlog::warn("the web client is not built: no page is served; run ./dev build, or give --web-root");
  warnIfOpenToAll(options);
  sayReady(options, (*edge)->port());
  const int signal = signals.wait([&] {
    (*edge)->reloadCertificate();
    reload(options, (*edge)->access(), audit_file.get());
  });
  spdlog::info("{}: closing", signal == SIGINT ? "interrupted" : "terminated");
  drain(
      options, signals, [&] { return (*edge)->networkStats().open_session_count; },
      [&](std::chrono::milliseconds closes_in) { (*edge)->drain(closes_in, options.drain_to); });
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
  const auto sources = std::make_shared<std::optional<OptionSources>>();
  return {command, [options, sources] { return options->prints_config ? printConfig(**sources) : runEdge(*options); },
          [&program, command, options, sources]() -> core::Result<void> {
            auto completed = completeFrontOptions(program, *command, *options);
            if (!completed) return completed.error();
            *sources = *std::move(completed);
            return {};
          }};
}

}  // namespace spindrift::cli
