#include "serve_options.h"

#include <cstdlib>

#include "commands.h"
#include "config_file.h"
#include "forms.h"

namespace spindrift::cli {
namespace {

constexpr const char* kTokensVariable = "SPINDRIFT_TOKENS";

std::string variableOr(const char* name, const std::string& otherwise) {
  const char* const text = std::getenv(name);
  return text != nullptr && *text != '\0' ? text : otherwise;
}

/// Those of everything that serves clients.
void addFrontOptions(CLI::App& command, FrontOptions& options) {
  command.add_option("--address", options.address, "Address to listen on")
      ->check(isListenAddress())
      ->capture_default_str();
  command.add_option("--port", options.port, "Port to listen on; 0 = any free one")
      ->check(integerIn(0, 65535))
      ->capture_default_str();
  command.add_option("--web-root", options.web_root, "Folder of the built web client (default: next to the program)")
      ->check(CLI::ExistingDirectory);
  command.add_option("--threads", options.thread_count, "I/O threads")->check(integerIn(1, 64))->capture_default_str();
  command
      .add_option("--tls-cert", options.tls_cert_file,
                  "Serve over TLS with this certificate: PEM file with the server's certificate and its chain")
      ->check(isNotEmpty());
  command.add_option("--tls-key", options.tls_key_file, "PEM file with the private key of --tls-cert")
      ->check(isNotEmpty());
  command
      .add_option(
          "--trust-proxy", options.trusted_proxies,
          "Network of a trusted proxy, ADDRESS/BITS: its X-Forwarded-For gives the client's address; may be repeated")
      ->transform(isNetwork())
      ->delimiter(',');
  command.add_option("--max-sessions", options.max_session_count, "Maximum number of sessions at a time")
      ->check(integerIn(1, 65536))
      ->capture_default_str();
  command
      .add_option("--address-share", options.address_session_share,
                  "Share of --max-sessions that one address may use; 1 behind a proxy that is not in --trust-proxy")
      ->check(numberIn(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option("--tokens-file,--tokens", options.token_file,
                  "File with lines ROLE TOKEN (default: the environment variable SPINDRIFT_TOKENS)")
      ->check(isNotEmpty());
  command
      .add_option(
          "--guests", options.guest_role,
          "Role of clients without a token (default: viewer where tokens or keys are given; otherwise operator on the "
          "loopback, and player where other machines can reach the server)")
      ->check(CLI::IsMember({"none", "viewer", "player", "operator"}));
  command
      .add_option("--jwt-key", options.jwt_keys,
                  "Accept JSON Web Tokens of this key: FILE with a public key (RS256, EdDSA), or hs256:FILE with a "
                  "secret; may be repeated")
      ->check(isNotEmpty());
  command.add_option("--jwt-keys", options.jwt_key_set, "Accept JSON Web Tokens of the keys in this JWK set (JSON)")
      ->check(isNotEmpty());
  command
      .add_option("--jwt-issuer", options.jwt_issuer, "Required issuer (claim iss) of a JSON Web Token (default: any)")
      ->check(isText());
  command
      .add_option("--jwt-audience", options.jwt_audience,
                  "Required audience (claim aud) of a JSON Web Token (default: any)")
      ->check(isText());
  command
      .add_option("--person-commands-per-s", options.person_commands_per_s,
                  "Commands per second of one person over all sessions and rooms; bursts of twice as many")
      ->check(numberIn(1.0, 10'000.0))
      ->capture_default_str();
  command
      .add_option("--audit-log", options.audit_file,
                  "Append the commands of operators and every refused client to this file: one JSON object per line")
      ->check(isNotEmpty());
  command
      .add_option(
          "--origin", options.origins,
          "Additional allowed Origin of pages, https://HOST; null = pages opened as files; * = any; several with "
          "',', or repeated")
      ->transform(isOrigin())
      ->delimiter(',');
  command.add_flag("--foxglove", options.serves_foxglove,
                   "Serve the rooms to Foxglove as well, at ws://…/foxglove or /foxglove/ROOM");
  command
      .add_option("--embed", options.parents,
                  "Origin of pages that may show the water in a frame, https://HOST; several with ',', or repeated "
                  "(default: none)")
      ->transform(isParentOrigin())
      ->delimiter(',');
}

void addClusterOptions(CLI::App& command, FrontOptions& options, bool is_required) {
  command
      .add_option("--nats", options.nats_url,
                  is_required
                      ? "NATS server of the cluster, nats://[USER:PASSWORD@]HOST:PORT or tls://…; several with ','"
                      : "Join a cluster over this NATS server, nats://[USER:PASSWORD@]HOST:PORT or tls://…; several "
                        "with ','")
      ->check(isNatsServers());
  command
      .add_option("--nats-ca", options.nats_ca_file,
                  "PEM file with the authorities that sign the NATS server's certificate (default: the system's)")
      ->check(isNotEmpty());
  command
      .add_option("--node", options.node, "Name of this process in the cluster (default: the host's name and the port)")
      ->check(isText());
  command.add_option("--cluster", options.cluster, "Name of the cluster; several can share a NATS server")
      ->check(isText())
      ->capture_default_str();
}

/// Added last: the end of the process, and where the values come from.
void addLastOptions(CLI::App& command, FrontOptions& options) {
  command
      .add_option("--drain-s,--drain", options.drain_s,
                  "Seconds from SIGTERM until sessions are closed; clients are told where to reconnect")
      ->check(numberIn(0.0, 4.0))
      ->capture_default_str();
  command
      .add_option("--drain-to", options.drain_to,
                  "Server to which clients reconnect during --drain-s, ws://HOST[:PORT] or wss://HOST[:PORT] (default: "
                  "this one)")
      ->check(isServer());
  command
      .add_option(
          "--config", options.config_file,
          "File with options, as --print-config writes them (default: the environment variable SPINDRIFT_CONFIG)")
      ->check(isNotEmpty())
      ->configurable(false);
  command
      .add_flag("--print-config", options.prints_config,
                "Print the configuration, with the source of each value, and exit")
      ->configurable(false);
  command.footer(
      "Each option is also an environment variable, SPINDRIFT_ and its first name in capitals with _ for -\n"
      "(SPINDRIFT_MAX_SESSIONS; ';' between repeated values), and a field of --config (max_sessions: 8).\n"
      "A flag replaces the variable, and the variable replaces the file.");
}

}  // namespace

void addServeOptions(CLI::App& command, ServeOptions& options) {
  command
      .add_option("--scene", options.scene,
                  "Scene of the room 'main': a .textproto file or the name of a shipped scene")
      ->check(isNotEmpty())
      ->capture_default_str();
  command.add_flag("--class", options.is_class,
                   "For a class with phones and a projector: scene regatta, all addresses, guests who are players, and "
                   "the addresses for both; other options replace each of these");
  command
      .add_option("--public-url", options.public_url,
                  "Address of the page for phones, http[s]://HOST[:PORT][/PATH], where it is not one of this machine's "
                  "(a proxy, a container)")
      ->check(isPageUrl());
  addFidelity(command, options.fidelity);
  command.add_flag("--adapt", options.adapts,
                   "Lower a room's fidelity while this machine cannot keep up, and raise it again when it can");
  command.add_option("--room", options.rooms, "An additional room, NAME=SCENE; may be repeated")->check(isRoom());
  addDevice(command, options.device);
  command
      .add_option("--shader-dir", options.shader_folder,
                  "For shader development: read shaders from this folder (shaders/) and reload changed files")
      ->check(CLI::ExistingDirectory);
  command.add_option("--max-rooms", options.max_room_count, "Maximum number of rooms, including those opened later")
      ->check(integerIn(1, 64))
      ->capture_default_str();
  addFrontOptions(command, options);
  command
      .add_option("--grace-s,--grace", options.grace_s,
                  "Seconds for which a boat keeps its owner after the connection was lost")
      ->check(numberIn(0.0, 3600.0))
      ->capture_default_str();
  command.add_option("--record", options.record_folder, "Write the log of every room into this folder")
      ->check(isNotEmpty());
  command
      .add_option("--hash-every-ticks,--hash-every", options.hash_interval_ticks,
                  "Interval of the state hashes in the log, in ticks")
      ->check(integerIn(1, 36000))
      ->capture_default_str();
  command
      .add_option("--recordings", options.recordings_folder,
                  "Let operators record rooms as MCAP files into this folder, which is made (POST "
                  "/api/v1/rooms/ROOM/recording); not the logs of --record")
      ->check(isNotEmpty());
  command.add_option("--recordings-max-mib", options.recordings_max_mib, "MiB of all recordings in that folder")
      ->check(integerIn(1, 1'073'741'824))
      ->capture_default_str();

  command
      .add_option("--state-dir", options.state_folder,
                  "Keep the rooms in this folder, and continue from there after a restart, also after a crash")
      ->check(isNotEmpty());
  command
      .add_option("--snapshot-every-s,--snapshot-every", options.snapshot_interval_s,
                  "Seconds between two snapshots of a room in --state-dir")
      ->check(numberIn(0.5, 86400.0))
      ->capture_default_str();
  command
      .add_option("--sync", options.sync,
                  "When --state-dir is flushed to the disk: never, after each snapshot, or always (before a command is "
                  "answered). A crash of the program loses nothing in any case; a power failure loses what was not "
                  "flushed")
      ->check(CLI::IsMember({"never", "snapshots", "always"}))
      ->capture_default_str();
  addClusterOptions(command, options, false);
  addLastOptions(command, options);
}

void addEdgeOptions(CLI::App& command, FrontOptions& options) {
  addClusterOptions(command, options, true);
  addFrontOptions(command, options);
  addLastOptions(command, options);
}

namespace {

/// Gives the options that were not given the values of a class.
core::Result<void> applyClass(OptionSources& sources) {
  /// A class behind one address: each of forty phones, their reloads, and the projector.
  constexpr std::pair<const char*, const char*> kValues[] = {{"scene", "regatta"},
                                                             {"address", "0.0.0.0"},
                                                             {"guests", "player"},
                                                             {"address_share", "1"},
                                                             {"max_sessions", "512"}};
  for (const auto& [field, value] : kValues) {
    if (auto given = sources.suggest(field, value, "--class"); !given) return given;
  }
  return {};
}

}  // namespace

core::Result<OptionSources> completeFrontOptions(CLI::App& program, CLI::App& command, FrontOptions& options) {
  OptionSources sources{&command, &program};
  if (auto taken = sources.takeEnvironment(); !taken) return taken.error();

  // SPINDRIFT_TOKENS holds the tokens themselves. It stands in for the file, at the rank of the environment.
  if (const std::string tokens = variableOr(kTokensVariable, ""); !tokens.empty()) {
    const OptionSource source = sources.at("tokens_file").source;
    if (source == OptionSource::kEnvironment) {
      return core::invalid("SPINDRIFT_TOKENS and SPINDRIFT_TOKENS_FILE are both set: unset one of them");
    }
    if (source == OptionSource::kDefault) {
      options.tokens = tokens;
      sources.replaceByVariable("tokens_file", kTokensVariable);
    }
  }

  if (options.config_file.empty()) options.config_file = variableOr("SPINDRIFT_CONFIG", "");
  if (!options.config_file.empty()) {
    if (auto taken = takeConfigFile(options.config_file, sources); !taken) return taken.error();
  }
  if (options.tls_cert_file.empty() != options.tls_key_file.empty()) {
    const char* const given = options.tls_cert_file.empty() ? "--tls-key" : "--tls-cert";
    const char* const missing = options.tls_cert_file.empty() ? "--tls-cert" : "--tls-key";
    return core::invalid(std::string(given) + " is given without " + missing + ": TLS needs both files");
  }
  if (options.is_class) {
    if (auto applied = applyClass(sources); !applied) return applied.error();
  }
  return sources;
}

}  // namespace spindrift::cli
