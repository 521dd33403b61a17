#include "fits_device.h"

#include <algorithm>

#include <fmt/format.h>

namespace spindrift::sim {
namespace {

/// Of the largest buffer of particles, ParticleBuffers::near_candidates.
constexpr std::uint64_t kParticleTexelCount = 9;
constexpr std::uint64_t kParticleBytes = 8 * kParticleTexelCount;
/// Of the tables of the neighbour grid (NeighborGrid), which have a cell more than the grid.
constexpr std::uint64_t kCellBytes = 4;
constexpr double kBytesPerMiB = 1024.0 * 1024.0;

/// Returns how many items of this size one buffer takes.
std::uint64_t mostOf(const gpu::DeviceLimits& limits, std::uint64_t item_bytes, std::uint64_t item_texels) {
  return std::min(static_cast<std::uint64_t>(limits.max_ssbo_bytes) / item_bytes,
                  static_cast<std::uint64_t>(limits.max_texel_buffer_elements) / item_texels);
}

core::Error tooLarge(const gpu::Context& ctx, const std::string& what, std::uint64_t bytes, std::uint64_t most_bytes,
                     const std::string& advice) {
  return core::invalid(fmt::format("{} need a buffer of {:.1f} MiB, {} takes at most {:.1f} MiB: {}", what,
                                   static_cast<double>(bytes) / kBytesPerMiB, ctx.device().name,
                                   static_cast<double>(most_bytes) / kBytesPerMiB, advice));
}

}  // namespace

core::Result<void> fitsDevice(const gpu::Context& ctx, const core::Scene& scene, const Derived& derived) {
  if (derived.particles) {
    const std::uint64_t count = derived.particles->count, cells = derived.particles->cell_count + std::uint64_t{1};
    const std::uint64_t most = mostOf(ctx.limits(), kParticleBytes, kParticleTexelCount);
    if (count > most) {
      return tooLarge(ctx, fmt::format("particles.count: {} particles", count), count * kParticleBytes,
                      most * kParticleBytes, fmt::format("use at most {}", most));
    }
    const std::uint64_t most_cells = mostOf(ctx.limits(), kCellBytes, 1);
    if (cells > most_cells) {
      return tooLarge(ctx,
                      fmt::format("particles.headroom_m: {} m and {} particles make a grid whose {} cells",
                                  scene.particles->headroom_m, count, cells),
                      cells * kCellBytes, most_cells * kCellBytes, "use less headroom or fewer particles");
    }
  }
  const auto free_bytes = ctx.freeMemory_bytes();
  if (!free_bytes || derived.device_bytes <= *free_bytes) return {};
  return core::unavailable(fmt::format(
      "the device has no memory for it: {:.0f} MB are needed, {:.0f} MB of {} are free; make the scene smaller "
      "({} particles, {} wave cells), or close other rooms and programs that use it",
      static_cast<double>(derived.device_bytes) / 1e6, static_cast<double>(*free_bytes) / 1e6, ctx.device().name,
      derived.particles ? derived.particles->count : 0, derived.wave ? derived.wave->counts().total() : 0));
}

}  // namespace spindrift::sim
