#include "placement.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include <spindrift/core/room_name.h>

namespace spindrift::cluster {
namespace {

constexpr std::chrono::seconds kForgetAfter{60};
/// What a new room probably adds to the load, until the pulses show it.
constexpr double kRoomLoad = 0.3;

}  // namespace

void Servers::note(v1::ServerPulse pulse, Clock::time_point now) {
  if (!core::isRoomName(pulse.server())) return;
  const auto remove_rooms = [](v1::ServerPulse& from, const auto& which) {
    auto& rooms = *from.mutable_rooms();
    rooms.erase(std::remove_if(rooms.begin(), rooms.end(), which), rooms.end());
  };
  remove_rooms(pulse, [](const std::string& room) { return !core::isRoomName(room); });
  // A room has one server: an earlier one has lost it.
  for (auto& [name, server] : servers_) {
    if (name == pulse.server() || now - server.heard <= kServerPatience) continue;  // alive: it speaks for itself
    remove_rooms(server.pulse, [&](const std::string& room) { return std::ranges::count(pulse.rooms(), room) > 0; });
  }
  const std::string name = pulse.server();
  servers_[name] = {std::move(pulse), now};
}

void Servers::review(Clock::time_point now) {
  std::erase_if(servers_, [&](const auto& entry) { return now - entry.second.heard > kForgetAfter; });
}

bool Servers::isAlive(const std::string& server, Clock::time_point now) const {
  const auto found = servers_.find(server);
  return found != servers_.end() && now - found->second.heard <= kServerPatience;
}

bool Servers::runs(const std::string& server, const std::string& room, Clock::time_point now) const {
  return isAlive(server, now) && std::ranges::count(servers_.at(server).pulse.rooms(), room) > 0;
}

std::vector<std::string> Servers::alive(Clock::time_point now) const {
  std::vector<std::string> out;
  for (const auto& [name, server] : servers_) {
    if (now - server.heard <= kServerPatience) out.push_back(name);
  }
  return out;
}

std::string Servers::serverOf(const std::string& room) const {
  const Server* newest = nullptr;
  for (const auto& [name, server] : servers_) {
    if (std::ranges::count(server.pulse.rooms(), room) > 0 && (!newest || server.heard > newest->heard))
      newest = &server;
  }
  return newest ? newest->pulse.server() : std::string();
}

std::vector<std::string> Servers::rooms() const {
  std::set<std::string> names;
  for (const auto& [name, server] : servers_) names.insert(server.pulse.rooms().begin(), server.pulse.rooms().end());
  return {names.begin(), names.end()};
}

std::string Servers::choose(Clock::time_point now, const std::map<std::string, int>& placed) const {
  std::string best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [name, server] : servers_) {
    if (now - server.heard > kServerPatience || server.pulse.is_leaving()) continue;
    const auto late = placed.find(name);
    const int late_count = late == placed.end() ? 0 : late->second;
    if (server.pulse.rooms_size() + late_count >= static_cast<int>(server.pulse.room_max_count())) continue;
    const double load = server.pulse.load() + kRoomLoad * late_count;
    if (load < least) {
      least = load;
      best = name;
    }
  }
  return best;
}

}  // namespace spindrift::cluster
