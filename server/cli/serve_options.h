// The options of `spindrift serve` and `spindrift edge`. The flags are the single list: environment and configuration
// file have the same names and pass the same checks (option_sources.h, config_file.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <spindrift/core/result.h>

#include "option_sources.h"

namespace spindrift::cli {

/// Options of a process that serves clients, with or without rooms of its own.
struct FrontOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;
  std::string web_root;  ///< empty: searched beside the program
  std::size_t thread_count = 1;
  std::size_t max_session_count = 256;
  std::string tls_cert_file;                 ///< empty: no TLS
  std::string tls_key_file;                  ///< empty if and only if tls_cert_file is
  std::vector<std::string> trusted_proxies;  ///< networks, ADDRESS/BITS
  double address_session_share = 0.5;        ///< share of the sessions that one address may hold
  bool is_class = false;                     ///< see applyClass()
  std::string public_url;                    ///< of the page as others reach it; empty: by this machine's addresses
  std::string token_file;                    ///< empty: `tokens`
  std::string tokens;                 ///< text of SPINDRIFT_TOKENS where it applies; ';' may end a line. Never printed.
  std::string operator_token;         ///< see makeOperatorToken(); empty: not made. Never logged.
  std::string guest_role;             ///< "none", or a role; empty: as docs/operations/secure.md#roles-and-tokens says
  std::vector<std::string> jwt_keys;  ///< FILE: a public key; hs256:FILE: a secret
  std::string jwt_key_set;            ///< file of a JWK set; empty: none
  std::string jwt_issuer;             ///< empty: not checked
  std::string jwt_audience;           ///< empty: not checked
  double person_commands_per_s = 200.0;
  std::string audit_file;            ///< empty: no audit log
  bool serves_foxglove = false;      ///< /foxglove
  std::vector<std::string> origins;  ///< additional allowed Origins; "*" = any
  std::vector<std::string> parents;  ///< Origins of pages that may embed the water
  std::string nats_url;              ///< empty: the process is alone
  std::string nats_ca_file;          ///< empty: the system's certificates
  std::string cluster = "spindrift";
  std::string node;      ///< empty: made from the host's name and the port
  double drain_s = 1.0;  ///< from SIGTERM to the end of the sessions
  std::string drain_to;  ///< URL of the server that clients are sent to; empty: here

  std::string config_file;     ///< empty: SPINDRIFT_CONFIG, or no file
  bool prints_config = false;  ///< print the configuration instead of serving
};

struct ServeOptions : FrontOptions {
  std::string scene = "harbor";
  std::vector<std::string> rooms;  ///< NAME=SCENE
  std::string fidelity;            ///< replaces the fidelity of the scenes; empty: theirs
  std::string device = "auto";
  std::string shader_folder;  ///< empty: the embedded shaders
  std::size_t max_room_count = 8;
  double grace_s = 20.0;      ///< how long the boat of a lost connection is kept
  std::string record_folder;  ///< folder for the logs of the rooms; empty: no logs
  std::uint32_t hash_interval_ticks = 60;
  std::string recordings_folder;  ///< for recordings that operators ask for; empty: recordings are refused
  std::uint64_t recordings_max_mib = 16'384;
  std::string state_folder;  ///< folder in which the rooms are kept; empty: nowhere
  double snapshot_interval_s = 10.0;
  std::string sync = "snapshots";  ///< never, snapshots, always
  bool adapts = false;
};

/// Add the flags. `options` outlives the parser.
void addServeOptions(CLI::App& command, ServeOptions& options);
void addEdgeOptions(CLI::App& command, FrontOptions& options);

/// Gives the options of `command` and `program` (--log-level …) that have no flag the values of the environment and of
/// the configuration file. Call after parsing. kInvalidInput and kUnavailable name the variable, or file and line.
core::Result<OptionSources> completeFrontOptions(CLI::App& program, CLI::App& command, FrontOptions& options);

}  // namespace spindrift::cli
