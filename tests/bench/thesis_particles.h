// The particle simulation in the structure of the thesis, for comparison: particles of 48 bytes that stay where they
// are, 32^3 cells with the indices of their particles, a dispatch per level of the prefix sum, the wave in an RGBA32F
// texture, 27 neighbour cells, groups of 1,024. Its equations and kernels are those of shaders/sph, so that only the
// structure differs. It is more than the thesis had in three things: cells match the support radius where 32 of them
// would be smaller, cells wrap at periodic sides, and the cells' counts need no pass that clears them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <spindrift/core/cell_counts.h>
#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/context.h>
#include <spindrift/gpu/tuning_profile.h>

namespace spindrift::bench {

/// Elevation [m], d eta/dt [m/s], d eta/dx, d eta/dz.
using WaveTexel = std::array<float, 4>;

/// Reads SimUniforms, which the caller binds, with particle_count at most that of create().
class ThesisParticles {
 public:
  /// `defines`: sim::shaderDefines() of a scene without tension, foam of particles, pool, hulls, bed and obstacles.
  /// `wave`: x fastest; empty without coupling. Error kInternal when the device fails.
  static core::Result<std::unique_ptr<ThesisParticles>> create(gpu::Context& ctx, const gpu::Defines& defines,
                                                               std::uint32_t count, core::CellCounts wave_count,
                                                               std::span<const WaveTexel> wave);
  ~ThesisParticles();
  ThesisParticles(const ThesisParticles&) = delete;
  ThesisParticles& operator=(const ThesisParticles&) = delete;

  /// Both: 4 floats per particle, of which the fourth is not used.
  void setState(std::span<const float> position, std::span<const float> velocity);
  /// One substep.
  void step();

  struct Particle {
    std::array<float, 3> position_m;
    float radius_m;
    std::array<float, 3> velocity_mps;
    float pressure_pa;
    std::array<float, 3> acceleration_mps2;
    float density_kgpm3;
  };
  static_assert(sizeof(Particle) == 48);
  [[nodiscard]] std::vector<Particle> download();
  [[nodiscard]] std::uint32_t groupSize() const { return group_; }

 private:
  ThesisParticles(gpu::Context& ctx, std::uint32_t count);
  core::Result<void> compile(std::uint32_t& program, const std::string& path, const gpu::Defines& defines);
  void run(std::uint32_t program, std::uint32_t items);

  gpu::Context& ctx_;
  std::uint32_t count_;
  std::uint32_t group_;
  gpu::Buffer particles_, cell_count_, cell_start_, contents_;
  std::uint32_t wave_ = 0;  ///< the OpenGL name of the texture; 0: none
  std::uint32_t count_pass_ = 0, scan_up_ = 0, scan_down_ = 0, fill_ = 0, density_ = 0, force_ = 0, integrate_ = 0;
};

}  // namespace spindrift::bench
