#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include <spindrift/cluster/node.h>
#include <spindrift/core/files.h>
#include <spindrift/core/room_name.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/service/water_server.h>
#include <spindrift/state/posix_file.h>

#include "access_options.h"
#include "front.h"
#include "inherited_socket.h"

namespace spindrift::cli {
namespace {

using core::Error;

/// Lists the scene's file in `catalog`, so that the room can return to it and change its fidelity.
core::Result<rooms::RoomSetup> loadRoom(const std::string& name, const std::string& scene, const std::string& fidelity,
                                        water::SceneCatalog& catalog) {
  if (!core::isRoomName(name)) {
    return core::invalid("room '" + name + "': names have " + std::string(core::kRoomNameRule));
  }
  auto file = core::findScene(scene);
  if (!file) return file.error();
  auto loaded = scene::loadSceneFile(*file, scene::parseFidelity(fidelity));
  if (!loaded) return loaded.error();
  catalog.add(loaded->name(), *file);
  return rooms::RoomSetup{name, *std::move(loaded)};
}

core::Result<std::vector<rooms::RoomSetup>> loadRooms(const ServeOptions& options, water::SceneCatalog& catalog) {
  std::vector<rooms::RoomSetup> rooms;
  auto first = loadRoom(core::kDefaultRoom, options.scene, options.fidelity, catalog);
  if (!first) return first.error();
  rooms.push_back(*std::move(first));
  for (const std::string& text : options.rooms) {
    const auto equals = text.find('=');
    auto room = loadRoom(text.substr(0, equals), text.substr(equals + 1), options.fidelity, catalog);
    if (!room) return room.error();
    for (const rooms::RoomSetup& known : rooms) {
      if (known.name == room->name)
        return core::invalid("--room '" + text +
                             "': there is a room of this name already; 'main' is the one of --scene");
    }
    rooms.push_back(*std::move(room));
  }
  return rooms;
}

history::StateOptions stateOptions(const ServeOptions& options) {
  return {.folder = options.state_folder,
          .sync = options.sync == "never"    ? state::Sync::kNever
                  : options.sync == "always" ? state::Sync::kAlways
                                             : state::Sync::kSnapshots,
          .snapshot_interval =
              std::chrono::milliseconds(static_cast<std::chrono::milliseconds::rep>(options.snapshot_interval_s * 1e3)),
          .is_shared = !options.nats_url.empty()};
}

core::Result<service::WaterServerOptions> serverOptions(const ServeOptions& options, cluster::Node* node) {
  service::WaterServerOptions out;
  auto device = gpu::parseDeviceChoice(options.device);
  if (!device) return device.error();
  out.device = *device;
  out.device.shader_folder = options.shader_folder;
  if (!options.state_folder.empty()) {
    auto states = history::StateStore::open(stateOptions(options));
    if (!states) {
      return Error{states.error().code, "--state-dir " + options.state_folder + ": " + states.error().message};
    }
    out.rules.states = *std::move(states);
  }
  if (!options.recordings_folder.empty()) {
    if (auto made = state::makeFolder(options.recordings_folder); !made)
      return Error{made.error().code, "--recordings " + options.recordings_folder + ": " + made.error().message};
  }
  out.recordings = {.folder = options.recordings_folder, .folder_max_bytes = options.recordings_max_mib << 20};
  water::SceneCatalog catalog(core::findSceneFolder(), scene::parseFidelity(options.fidelity));
  auto rooms = loadRooms(options, catalog);
  if (rooms && node) rooms = node->claim(*std::move(rooms));  // those that no other server of the cluster runs
  if (!rooms) return rooms.error();
  out.rooms = *std::move(rooms);
  auto access = accessOptions(options);
  if (!access) return access.error();
  out.access = *std::move(access);
  out.rules.scenes = std::move(catalog);
  out.rules.adapts = options.adapts;
  out.rules.opens_kept_rooms = !node;
  out.rules.grace = std::chrono::milliseconds(static_cast<std::chrono::milliseconds::rep>(options.grace_s * 1e3));
  out.rules.record_folder = options.record_folder;
  out.rules.hash_interval_ticks = options.hash_interval_ticks;
  out.max_room_count = options.max_room_count;
  out.network = networkOptions(options);
  if (node) out.cluster = node->hooks();
  out.on_drain = endThisProcess;
  out.public_url = options.public_url;
  return out;
}

/// Ends the program if a room's water is still being built a while after the end of everything else. A build cannot be
/// interrupted, and at its low priority it takes minutes on a busy machine; nothing of it is kept anyway.
void leaveBuilds(service::WaterServer& server) {
  constexpr std::chrono::seconds kPatience{2};
  constexpr std::chrono::milliseconds kLook{10};
  for (const auto end = std::chrono::steady_clock::now() + kPatience; server.simulation().isBuilding();) {
    if (std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(kLook);
      continue;
    }
    spdlog::warn("the water of a room was still being built: the program ends without it");
    if (access::AuditFile* const audit = server.gateway().access().audit().file()) audit->finish();
    spdlog::shutdown();
    std::fflush(nullptr);
    std::_Exit(0);  // the thread that builds still uses what exit() would destroy
  }
}

int serve(ServeOptions options) {
  gpu::chooseRasterThreads(std::thread::hardware_concurrency());
  StopSignals signals;
  auto inherited = takeInheritedSocket();
  if (!inherited) return fail(inherited.error());
  if (*inherited) {
    options.address = (*inherited)->address;
    options.port = (*inherited)->port;
    spdlog::info("a listening socket was passed on: {} port {}; --address and --port have no effect", options.address,
                 options.port);
  }
  makeOperatorToken(options);
  std::unique_ptr<cluster::Node> node;
  if (!options.nats_url.empty()) {
    cluster::NodeOptions node_options = nodeOptions(options, true);
    node_options.room_max_count = options.max_room_count;
    auto connected = cluster::Node::connect(node_options);
    if (!connected) return fail(connected.error());
    node = *std::move(connected);
  }
  auto server_options = serverOptions(options, node.get());
  if (!server_options) return fail(server_options.error());
  if (*inherited) server_options->network.listening_socket = (*inherited)->descriptor;
  auto server = service::WaterServer::start(*std::move(server_options));
  if (!server) return fail(server.error());
  if (node) {
    service::Gateway& gateway = (*server)->gateway();
    node->serve(gateway.sessions(), {.simulation = &(*server)->simulation(),
                                     .outlets = &gateway,
                                     .answer = [&gateway](const net::HttpRequest& request, net::HttpResponder respond,
                                                          const std::optional<access::Grant>& decided) {
                                       gateway.rest().answer(request, std::move(respond), decided);
                                     }});
  }

  if (const std::string device = (*server)->simulation().deviceLine(); !device.empty())
    spdlog::info("simulation runs on {}", device);
  runUntilSignal(options, signals,
                 {.network = (*server)->network(),
                  .access = (*server)->gateway().access(),
                  .drain = [&](std::chrono::milliseconds closes_in) { (*server)->drain(closes_in, options.drain_to); },
                  .leave =
                      [&] {
                        if (node) node->leave();
                      }});
  (*server)->stop();
  if (node) node->release();
  node.reset();  // it uses the server
  for (const std::string& line : (*server)->simulation().summary()) spdlog::info("{}", line);
  logNetwork((*server)->networkStats());
  leaveBuilds(**server);
  return 0;
}

}  // namespace

ProgramCommand addServe(CLI::App& program) {
  const auto options = std::make_shared<ServeOptions>();
  CLI::App* command = program.add_subcommand("serve", "Simulate and serve rooms until interrupted");
  addServeOptions(*command, *options);
  return frontCommand(program, *command, options, [options] { return serve(*options); });
}

}  // namespace spindrift::cli
