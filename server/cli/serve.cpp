#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pthread.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <spindrift/core/paths.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/service/water_server.h>

#include "commands.h"
#include "config_file.h"
#include "inherited_socket.h"
#include "serve_options.h"

namespace spindrift::cli {
namespace {

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
    if (!file)
      return Error{ErrorCode::kUnavailable, "--tokens-file " + options.token_file + ": the file cannot be read"};
    text.assign(std::istreambuf_iterator<char>(file), {});
    label = options.token_file;
    has_tokens = true;
  } else if (!options.tokens.empty()) {
    text = options.tokens;
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
    return Error{ErrorCode::kInvalidInput,
                 "--guests none without tokens refuses every client: give --tokens-file FILE"};
  }
  return access;
}

/// Blocks the signals in this thread and in those that it starts, so that wait() receives them.
class StopSignals {
 public:
  /// `takes_hangup`: SIGHUP as well.
  explicit StopSignals(bool takes_hangup) {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    if (takes_hangup) sigaddset(&set_, SIGHUP);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
  }
  int wait() {
    int signal = 0;
    sigwait(&set_, &signal);
    return signal;
  }
  /// Returns 0 if none comes in time.
  int waitFor(std::chrono::milliseconds duration) {
    const timespec time{.tv_sec = duration.count() / 1000, .tv_nsec = duration.count() % 1000 * 1'000'000};
    return std::max(0, sigtimedwait(&set_, nullptr, &time));
  }

 private:
  sigset_t set_{};
};

/// Gives the clients the time to go; returns when all have gone, the time is over, or another signal asks for the end.
void drain(service::WaterServer& server, StopSignals& signals, const ServeOptions& options) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kLook{20};
  const auto duration =
      std::chrono::milliseconds(static_cast<std::chrono::milliseconds::rep>(std::ceil(options.drain_s * 1e3)));
  const std::uint64_t session_count = server.networkStats().open_session_count;
  if (duration.count() == 0 || session_count == 0) return;
  spdlog::info("draining: {} sessions have {:g} s to go{}", session_count, options.drain_s,
               options.drain_to.empty() ? "" : " to " + options.drain_to);
  server.drain(duration, options.drain_to);
  for (const auto end = Clock::now() + duration; Clock::now() < end;) {
    if (server.networkStats().open_session_count == 0) return;
    const int signal = signals.waitFor(kLook);
    if (signal == SIGINT || signal == SIGTERM) return spdlog::info("draining ends: a second signal");
  }
}

std::string forUrl(const std::string& address) {
  return address.find(':') != std::string::npos ? "[" + address + "]" : address;
}

rooms::StateOptions stateOptions(const ServeOptions& options) {
  return {.folder = options.state_folder,
          .sync = options.sync == "never"    ? state::Sync::kNever
                  : options.sync == "always" ? state::Sync::kAlways
                                             : state::Sync::kSnapshots,
          .snapshot_interval = std::chrono::milliseconds(
              static_cast<std::chrono::milliseconds::rep>(options.snapshot_interval_s * 1e3))};
}

int serve(ServeOptions options) {
  const bool is_tls = !options.tls_cert_file.empty();
  StopSignals signals(is_tls);
  auto inherited = takeInheritedSocket();
  if (!inherited) return fail(inherited.error());
  if (*inherited) {
    options.address = (*inherited)->address;
    options.port = (*inherited)->port;
    spdlog::info("a listening socket was passed on: {} port {}; --address and --port have no effect", options.address,
                 options.port);
  }
  auto device = gpu::parseDeviceChoice(options.device);
  if (!device) return fail(device.error());
  rooms::SceneCatalog catalog(core::findSceneFolder(), scene::parseFidelity(options.fidelity));
  auto rooms = loadRooms(options, catalog);
  if (!rooms) return fail(rooms.error());

  auto access = loadAccess(options);
  if (!access) return fail(access.error());
  const bool is_open_to_all =
      access->guest() == core::Role::kOperator && !options.address.starts_with("127.") && options.address != "::1";

  std::shared_ptr<rooms::StateStore> states;
  if (!options.state_folder.empty()) {
    auto opened = rooms::StateStore::open(stateOptions(options));
    if (!opened)
      return fail({opened.error().code, "--state-dir " + options.state_folder + ": " + opened.error().message});
    states = *std::move(opened);
  }

  service::WaterServerOptions server_options;
  server_options.rules.states = std::move(states);
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
  if (*inherited) server_options.network.listening_socket = (*inherited)->descriptor;
  server_options.network.thread_count = options.thread_count;
  if (is_tls) server_options.network.tls = net::TlsFiles{options.tls_cert_file, options.tls_key_file};
  server_options.network.trusted_proxies = options.trusted_proxies;
  server_options.network.address_session_share = options.address_session_share;
  server_options.network.web_root = options.web_root.empty() ? core::findWebRoot().string() : options.web_root;
  // An operator's request has the effect of SIGTERM.
  server_options.on_drain = [] { ::kill(::getpid(), SIGTERM); };
  const bool has_page = !server_options.network.web_root.empty();
  auto server = service::WaterServer::start(std::move(server_options));
  if (!server) return fail(server.error());

  spdlog::info("simulation runs on {}", (*server)->deviceLine());
  if (!has_page) spdlog::warn("the web client is not built: no page is served; run ./dev build, or give --web-root");
  if (is_open_to_all) {
    spdlog::warn(
        "every client that can reach {} is an operator and may even close rooms: give --tokens-file or --guests player "
        "to restrict this",
        options.address);
  }
  std::printf("Spindrift is ready: %s://%s:%u/\n", is_tls ? "https" : "http", forUrl(options.address).c_str(),
              (*server)->port());
  std::fflush(stdout);
  int signal = signals.wait();
  for (; signal == SIGHUP; signal = signals.wait()) (*server)->reloadCertificate();
  spdlog::info("{}: closing", signal == SIGINT ? "interrupted" : "terminated");
  drain(**server, signals, options);
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
  addServeOptions(*command, *options);
  const auto sources = std::make_shared<std::optional<OptionSources>>();
  return {command,
          [options, sources] {
            if (!options->prints_config) return serve(*options);
            const std::string text = configText(**sources);
            if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
              return fail({ErrorCode::kUnavailable,
                           std::string("--print-config: standard output cannot be written: ") + std::strerror(errno)});
            }
            return 0;
          },
          [&program, command, options, sources]() -> core::Result<void> {
            auto completed = completeServeOptions(program, *command, *options);
            if (!completed) return completed.error();
            *sources = *std::move(completed);
            return {};
          }};
}

}  // namespace spindrift::cli
