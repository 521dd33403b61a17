#include <algorithm>
#include <cmath>
#include <vector>

#include <spindrift/scene/scene_loader.h>
#include <spindrift/service/ground_answers.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/ground.h>
#include <spindrift/v1/api.pb.h>

namespace spindrift::service {
namespace {

constexpr double kFinestQuantum_m = 1e-4;
constexpr double kLargestStep = 32767.0;
/// Rooms whose answers are kept; a server with more computes some anew.
constexpr std::size_t kKeptMaxCount = 64;

/// Returns the ground of a scene with a wave: one height per cell, without obstacles. Errors of rounding: at most half
/// of `quantum_m`, which is a 32,767th of the largest height or depth and at least 0.1 mm.
v1::Ground groundOf(const core::Scene& scene) {
  const core::WaveCells water = core::waveCellsOf(*scene.wave);
  const auto [count_x, count_z] = water.count;
  std::vector<double> rise_m;
  rise_m.reserve(water.count.total());
  double largest_m = 0.0;
  for (std::uint32_t z = 0; z < count_z; ++z) {
    for (std::uint32_t x = 0; x < count_x; ++x) {
      rise_m.push_back(-sim::groundDepth(scene, (x + 0.5) * water.cell_m - water.length_m / 2,
                                         (z + 0.5) * water.cell_m - water.width_m / 2));
      largest_m = std::max(largest_m, std::abs(rise_m.back()));
    }
  }
  v1::Ground out;
  out.set_count_x(count_x);
  out.set_count_z(count_z);
  out.set_length_m(water.length_m);
  out.set_width_m(water.width_m);
  out.set_quantum_m(std::max(kFinestQuantum_m, largest_m / kLargestStep));
  out.mutable_rise()->Reserve(static_cast<int>(rise_m.size()));
  const auto quantized = [&](std::size_t i) {
    return static_cast<std::int32_t>(std::lround(rise_m[i] / out.quantum_m()));
  };
  for (std::size_t i = 0; i < rise_m.size(); ++i) {
    const std::size_t before = i % count_x != 0 ? i - 1 : i - std::min<std::size_t>(i, count_x);
    out.add_rise(quantized(i) - (i > 0 ? quantized(before) : 0));
  }
  return out;
}

}  // namespace

std::shared_ptr<const std::string> GroundAnswers::of(const std::shared_ptr<const rooms::Room>& room) {
  const auto snapshot = room->snapshot();
  if (!snapshot->scene.has_wave()) return nullptr;
  const double depth_m = snapshot->scene.wave().depth_m();
  {
    const std::lock_guard lock(mutex_);
    const auto found = kept_.find(room->name());
    if (found != kept_.end() && found->second.room.lock() == room &&
        found->second.scene_version == snapshot->scene_version && found->second.depth_m == depth_m) {
      found->second.used = ++use_count_;
      return found->second.bytes;
    }
  }
  v1::Ground ground = groundOf(scene::toCore(snapshot->scene));
  ground.set_scene_version(snapshot->scene_version);
  auto bytes = std::make_shared<const std::string>(ground.SerializeAsString());
  const std::lock_guard lock(mutex_);
  if (kept_.size() >= kKeptMaxCount && !kept_.contains(room->name()))
    kept_.erase(std::ranges::min_element(kept_, {}, [](const auto& entry) { return entry.second.used; }));
  kept_[room->name()] = {room, snapshot->scene_version, depth_m, bytes, ++use_count_};
  return bytes;
}

}  // namespace spindrift::service
