#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <pthread.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/paths.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/service/water_server.h>

#include "commands.h"

namespace spindrift::cli {
namespace {

struct ServeOptions {
  std::string scene = "harbor";
  std::vector<std::string> rooms;  ///< NAME=SCENE
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;
  std::string fidelity;  ///< replaces the fidelity of the scenes; empty: theirs
  std::string device = "auto";
  std::string web_root;       ///< empty: searched beside the program
  std::string shader_folder;  ///< empty: the embedded shaders
  std::size_t thread_count = 1;
  double address_session_share = 0.5;  ///< share of the sessions that one address may hold
  std::size_t max_room_count = 8;
  std::string token_file;            ///< empty: SPINDRIFT_TOKENS in the environment, if set
  std::string guest_role;            ///< "none", or a role; empty: operator without tokens, viewer with tokens
  std::vector<std::string> origins;  ///< additional allowed Origins; "*" = any
  double grace_s = 20.0;             ///< how long the boat of a lost connection is kept
  std::string record_folder;         ///< folder for the logs of the rooms; empty: no logs
  std::uint32_t hash_interval_ticks = 60;
  bool adapts = false;
};

using core::Error;
using core::ErrorCode;

/// Lists the scene's file in `catalog`, so that the room can return to it and change its fidelity.
core::Result<rooms::RoomSetup> loadRoom(const std::string& name, const std::string& scene, const std::string& fidelity,
                                        rooms::SceneCatalog& catalog) {
  if (!rooms::isRoomName(name)) {
    return Error{ErrorCode::kInvalidInput, "room '" + name + "': names have 1 to 32 letters, digits, '_' or '-'"};
  }
  auto file = core::findScene(scene);
  if (!file) return file.error();
  auto loaded = scene::loadSceneFile(*file, scene::parseFidelity(fidelity));
  if (!loaded) return loaded.error();
  catalog.add(loaded->name(), *file);
  return rooms::RoomSetup{name, *std::move(loaded)};
}

core::Result<std::vector<rooms::RoomSetup>> loadRooms(const ServeOptions& options, rooms::SceneCatalog& catalog) {
  std::vector<rooms::RoomSetup> rooms;
  auto first = loadRoom("main", options.scene, options.fidelity, catalog);
  if (!first) return first.error();
  rooms.push_back(*std::move(first));
  for (const std::string& text : options.rooms) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      return Error{ErrorCode::kInvalidInput, "--room '" + text + "': write NAME=SCENE"};
    auto room = loadRoom(text.substr(0, equals), text.substr(equals + 1), options.fidelity, catalog);
    if (!room) return room.error();
    for (const rooms::RoomSetup& known : rooms) {
      if (known.name == room->name)
        return Error{ErrorCode::kInvalidInput,
                     "--room '" + text + "': there is a room of this name already; 'main' is the one of --scene"};
    }
    rooms.push_back(*std::move(room));
  }
  return rooms;
}

/// Reads the tokens from the file or from the environment, and the role of clients without a token.
core::Result<service::Access> loadAccess(const ServeOptions& options) {
  std::string text;
  std::string label = "SPINDRIFT_TOKENS";
  bool has_tokens = false;
  if (!options.token_file.empty()) {
    std::ifstream file(options.token_file);
    if (!file) return Error{ErrorCode::kUnavailable, "--tokens " + options.token_file + ": the file cannot be read"};
    text.assign(std::istreambuf_iterator<char>(file), {});
    label = options.token_file;
    has_tokens = true;
  } else if (const char* const set = std::getenv("SPINDRIFT_TOKENS"); set && *set) {
    text = set;
    std::ranges::replace(text, ';', '\n');  // environment variables are awkward with several lines
    has_tokens = true;
  }
  std::optional<core::Role> guest = has_tokens ? core::Role::kViewer : core::Role::kOperator;
  if (!options.guest_role.empty()) guest = core::parseRole(options.guest_role);  // "none" is not a role
  auto access = service::Access::parse(text, label, guest);
  if (access && has_tokens && access->tokenCount() == 0) {
    return Error{ErrorCode::kInvalidInput, label + ": there is no token in it: write lines of ROLE TOKEN"};
  }
  if (access && !guest && access->tokenCount() == 0) {
    return Error{ErrorCode::kInvalidInput, "--guests none without tokens refuses every client: give --tokens FILE"};
  }
  return access;
}

/// Blocks SIGINT and SIGTERM in this thread and in those that it starts, so that wait() receives them.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
  }
  int wait() {
    int signal = 0;
    sigwait(&set_, &signal);
    return signal;
  }

 private:
  sigset_t set_{};
};

std::string forUrl(const std::string& address) {
  return address.find(':') != std::string::npos ? "[" + address + "]" : address;
}

int serve(const ServeOptions& options) {
  StopSignals signals;
  auto device = gpu::parseDeviceChoice(options.device);
  if (!device) return fail(device.error());
  rooms::SceneCatalog catalog(core::findSceneFolder(), scene::parseFidelity(options.fidelity));
  auto rooms = loadRooms(options, catalog);
  if (!rooms) return fail(rooms.error());

  auto access = loadAccess(options);
  if (!access) return fail(access.error());
  const bool is_open_to_all =
      access->guest() == core::Role::kOperator && !options.address.starts_with("127.") && options.address != "::1";

  service::WaterServerOptions server_options;
  server_options.device = *device;
  server_options.device.shader_folder = options.shader_folder;
  server_options.rooms = *std::move(rooms);
  server_options.rules.scenes = std::move(catalog);
  server_options.rules.adapts = options.adapts;
  server_options.rules.grace =
      std::chrono::milliseconds(static_cast<std::chrono::milliseconds::rep>(options.grace_s * 1e3));
  server_options.rules.record_folder = options.record_folder;
  server_options.rules.hash_interval_ticks = options.hash_interval_ticks;
  server_options.max_room_count = options.max_room_count;
  server_options.access = *std::move(access);
  server_options.network.allowed_origins = options.origins;
  server_options.network.address = options.address;
  server_options.network.port = options.port;
  server_options.network.thread_count = options.thread_count;
  server_options.network.address_session_share = options.address_session_share;
  server_options.network.web_root = options.web_root.empty() ? core::findWebRoot().string() : options.web_root;
  const bool has_page = !server_options.network.web_root.empty();
  auto server = service::WaterServer::start(std::move(server_options));
  if (!server) return fail(server.error());

  spdlog::info("simulation runs on {}", (*server)->deviceLine());
  if (!has_page) spdlog::warn("the web client is not built: no page is served; run ./dev build, or give --web-root");
  if (is_open_to_all) {
    spdlog::warn(
        "every client that can reach {} is an operator and may even close rooms: give --tokens or --guests player to "
        "restrict this",
        options.address);
  }
  std::printf("Spindrift is ready: http://%s:%u/\n", forUrl(options.address).c_str(), (*server)->port());
  std::fflush(stdout);
  const int signal = signals.wait();
  spdlog::info("{}: closing", signal == SIGINT ? "interrupted" : "terminated");
  (*server)->stop();
  const net::ServerStats stats = (*server)->networkStats();
  for (const std::string& line : (*server)->summary()) spdlog::info("{}", line);
  spdlog::info("{} sessions, {} frames and {:.1f} MB sent, {} frames dropped for slow clients, {} sessions evicted",
               stats.accepted_session_count, stats.sent_frame_count, static_cast<double>(stats.sent_bytes_count) / 1e6,
               stats.dropped_frame_count, stats.evicted_session_count);
  return 0;
}

}  // namespace

ProgramCommand addServe(CLI::App& program) {
  const auto options = std::make_shared<ServeOptions>();
  CLI::App* command = program.add_subcommand("serve", "Simulate and serve rooms until interrupted");
  command
      ->add_option("--scene", options->scene,
                   "Scene of the room 'main': a .textproto file or the name of a shipped scene")
      ->capture_default_str();
  addFidelity(*command, options->fidelity);
  command->add_flag("--adapt", options->adapts,
                    "Lower a room's fidelity while this machine cannot keep up, and raise it again when it can");
  command->add_option("--room", options->rooms, "An additional room, NAME=SCENE; may be repeated");
  command->add_option("--address", options->address, "Address to listen on")->capture_default_str();
  command->add_option("--port", options->port, "Port to listen on; 0 = any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  addDevice(*command, options->device);
  command->add_option("--web-root", options->web_root, "Folder of the built web client (default: next to the program)");
  command
      ->add_option("--shader-dir", options->shader_folder,
                   "For shader development: read shaders from this folder (shaders/) and reload changed files")
      ->check(CLI::ExistingDirectory);
  command->add_option("--threads", options->thread_count, "I/O threads")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();

  command
      ->add_option("--address-share", options->address_session_share,
                   "Share of the sessions that one address may use; 1 behind a proxy")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--max-rooms", options->max_room_count, "Maximum number of rooms, including those opened later")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--tokens", options->token_file,
                      "File with lines ROLE TOKEN (default: the environment variable SPINDRIFT_TOKENS)");
  command
      ->add_option("--guests", options->guest_role,
                   "Role of clients without a token (default: operator without tokens, viewer with tokens)")
      ->check(CLI::IsMember({"none", "viewer", "player", "operator"}));
  command->add_option("--origin", options->origins,
                      "Additional allowed Origin of pages, https://HOST; * = any; may be repeated");
  command
      ->add_option("--grace", options->grace_s,
                   "Seconds for which a boat keeps its owner after the connection was lost")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command->add_option("--record", options->record_folder, "Write the log of every room into this folder");
  command->add_option("--hash-every", options->hash_interval_ticks, "Interval of the state hashes in the log, in ticks")
      ->check(CLI::Range(1, 36000))
      ->capture_default_str();
  return {command, [options] { return serve(*options); }};
}

}  // namespace spindrift::cli
