#include <algorithm>
#include <chrono>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/bench/rooms.h>
#include <spindrift/codec/stream.h>
#include <spindrift/core/files.h>
#include <spindrift/rooms/encoder_thread.h>
#include <spindrift/rooms/room_host.h>
#include <spindrift/scene/scene_loader.h>

#include "silent_outlets.h"

namespace spindrift::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kRoomMaxCount = 64;
/// Below it, a room does not hold real time.
constexpr double kRealTime = 0.99;
constexpr std::chrono::seconds kSettling{3};

/// Encodes frames and throws them away.
struct Encoded final : test::SilentOutlets, rooms::FrameOutlet {
  rooms::EncoderThread encoder{*this};
  void frameReady(const rooms::Room& room, core::FrameView frame) override {
    encoder.submit(room.name(), room.demand(), std::move(frame));
  }
  void closed(const rooms::Room& room) override { encoder.forget(room.name()); }
  void publish(const std::string&, codec::Stream, const codec::EncodedFrame&, const core::FrameLevels&) override {}
};

struct Case {
  std::string name;
  std::string scene;
  std::optional<v1::Fidelity> fidelity;
};

struct Measured {
  double slowest = 0.0;  ///< real-time factor
  double mean = 0.0;
  double processors = 0.0;  ///< processor time over wall time
};

void watch(rooms::Room& room) {
  room.demand()->addSessions(1);
  for (const codec::Stream& stream : codec::allStreams()) {
    const codec::Stream packed = codec::streamOf(stream.layer, v1::PACKING_PACKED);
    room.demand()->set(codec::indexOf(packed), &room, core::DemandTable::Need{});
  }
}

struct Moment {
  Clock::time_point wall{};
  double time_s = 0.0;
};

/// Waits until the room tells how far it is, which it does four times per second.
Moment momentOf(const rooms::Room& room) {
  const double before_s = room.vitals()->time_s;
  const auto deadline = Clock::now() + std::chrono::seconds(2);
  while (room.vitals()->time_s == before_s && Clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return {Clock::now(), room.vitals()->time_s};
}

core::Result<Measured> measure(const v1::Scene& scene, std::size_t count, bool is_watched,
                               const gpu::DeviceChoice& device, double seconds) {
  std::vector<rooms::RoomSetup> setups;
  for (std::size_t k = 0; k < count; ++k) setups.push_back({.name = fmt::format("room{}", k), .scene = scene});
  Encoded outlets;
  auto started = rooms::RoomHost::start(device, std::move(setups), {}, kRoomMaxCount, outlets);
  if (!started) return started.error();
  rooms::RoomHost& simulation = **started;
  const auto all = simulation.rooms();
  if (is_watched) std::ranges::for_each(all, [](const auto& room) { watch(*room); });
  simulation.run();
  std::this_thread::sleep_for(kSettling);
  std::vector<Moment> begins;
  for (const auto& room : all) begins.push_back(is_watched ? momentOf(*room) : Moment{});
  const auto begin = Clock::now();
  const std::clock_t cpu_begin = std::clock();
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  const double wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  Measured out{.processors = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC / wall_s};
  std::vector<double> factors;
  for (std::size_t k = 0; is_watched && k < count; ++k) {
    const Moment end = momentOf(*all[k]);
    const double room_wall_s = std::chrono::duration<double>(end.wall - begins[k].wall).count();
    factors.push_back((end.time_s - begins[k].time_s) / room_wall_s);
  }
  for (const double factor : factors) out.mean += factor / static_cast<double>(count);
  if (!factors.empty()) out.slowest = std::ranges::min(factors);
  outlets.encoder.stop();
  simulation.stop();
  return out;
}

boost::json::object print(const std::string& name, std::size_t count, const Measured& measured, std::FILE* out) {
  const double each = measured.processors / static_cast<double>(count);
  fmt::print(out, "{:<28} {:>5} {:>8.3f} {:>8.3f} {:>10.3f} {:>9.4f}\n", name, count, measured.slowest, measured.mean,
             measured.processors, each);
  std::fflush(out);
  return {{"case", name},
          {"rooms", count},
          {"slowest", measured.slowest},
          {"mean", measured.mean},
          {"processors", measured.processors},
          {"processors_per_room", each}};
}

}  // namespace

core::Result<boost::json::object> measureRooms(const gpu::DeviceChoice& device, double seconds, std::FILE* out) {
  const std::vector<Case> cases = {{"pool at draft", "pool", v1::FIDELITY_DRAFT},
                                   {"still water", "still_pool", std::nullopt},
                                   {"harbor", "harbor", std::nullopt}};
  fmt::print(out, "rooms in one process, {} processors; real-time factors, processor time over wall time\n",
             std::thread::hardware_concurrency());
  fmt::print(out, "{:<28} {:>5} {:>8} {:>8} {:>10} {:>9}\n", "case", "rooms", "slowest", "mean", "processors", "each");
  boost::json::array rows;
  const auto load = [](const std::string& name, std::optional<v1::Fidelity> fidelity) -> core::Result<v1::Scene> {
    const auto file = core::findScene(name);
    if (!file) return file.error();
    return scene::loadSceneFile(*file, fidelity);
  };
  for (const Case& test : cases) {
    const auto scene = load(test.scene, test.fidelity);
    if (!scene) return scene.error();
    for (std::size_t count = 1; count <= kRoomMaxCount; ++count) {
      const auto measured = measure(*scene, count, true, device, seconds);
      if (!measured) return measured.error();
      rows.push_back(print(test.name, count, *measured, out));
      if (measured->slowest < kRealTime) break;
    }
  }
  auto asleep = load("wave_only", v1::FIDELITY_DRAFT);
  if (!asleep) return asleep.error();
  asleep->set_unwatched(v1::UNWATCHED_SLEEP);
  const auto measured = measure(*asleep, kRoomMaxCount, false, device, seconds);
  if (!measured) return measured.error();
  rows.push_back(print("wave_only, nobody there", kRoomMaxCount, *measured, out));
  return boost::json::object{{"rows", std::move(rows)}};
}

}  // namespace spindrift::bench
