#include "wind_sea.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include <shared/bindings.h>
#include <shared/fixed_point.h>

#include <spindrift/sim_setup/pulse.h>
#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {
namespace {

using Complex = std::complex<double>;

/// A sea fades into the next one in this time: long enough that the change itself makes no waves.
constexpr double kFade_s = 4.0;
/// A block keeps its values for several steps, while the phase of its fastest wave turns by at most this angle. What
/// the steps in its surface excite lies far above the highest frequency of the grid.
constexpr double kHeld_rad = 0.5;
constexpr std::uint32_t kHeldMaxSteps = 8;

static_assert(MAX_SEA_WAVES == 2 * kSeaWaveCount, "two seas while one fades into the next");

std::array<float, 2> texelOf(const Complex& value) {
  return {static_cast<float>(value.real()), static_cast<float>(value.imag())};
}

/// exp(i k p), lowered by the damping on the way from the side where the wave enters. `share`: of the direction of
/// travel along this axis.
Complex factorAt(double k_radpm, double decay_pm, double share, double place_m, double side_m) {
  const double way_m = share * place_m + std::abs(share) * side_m / 2;
  return std::polar(std::exp(-decay_pm * way_m), k_radpm * place_m);
}

/// Blocks with cells of a layer: first column, first row, the layers' sides, 0.
std::vector<std::array<std::uint32_t, 4>> layerBlocks(const core::WaveScene& wave, const WaveLayout& layout) {
  std::vector<std::array<std::uint32_t, 4>> out;
  const auto water_sides = sidesOf(wave);
  // The last block of a row may reach beyond the water.
  const auto behind = [](std::uint32_t count, std::uint32_t first) {
    return count > first + SEA_BLOCK ? count - first - SEA_BLOCK : 0;
  };
  for (std::uint32_t z = 0; z < layout.count_z; z += SEA_BLOCK) {
    for (std::uint32_t x = 0; x < layout.count_x; x += SEA_BLOCK) {
      const std::array cells_before{x, behind(layout.count_x, x), z, behind(layout.count_z, z)};
      std::uint32_t sides = 0;
      for (std::size_t k = 0; k < water_sides.size(); ++k) {
        if (water_sides[k].boundary == core::WaveBoundary::kAbsorb &&
            (cells_before[k] + 0.5) * layout.cell_m < wave.sponge_width_m)
          sides |= water_sides[k].bit;
      }
      if (sides != 0) out.push_back({x, z, sides, 0});
    }
  }
  return out;
}

}  // namespace

WindSea::WindSea(Creation& create, const core::Scene& scene, const WaveLayout& layout)
    : layout_(layout),
      columns_(create.texels("sea columns", std::size_t{layout.count_x} * MAX_SEA_WAVES, gpu::TexelFormat::kRG32F)),
      rows_(create.texels("sea rows", std::size_t{(layout.count_z + SEA_STRIP - 1) / SEA_STRIP} * MAX_SEA_WAVES,
                          gpu::TexelFormat::kRG32F)),
      incident_(create.texels("incident sea", layout.counts().total(), gpu::TexelFormat::kRGBA32F)),
      uniforms_(create.uniforms<shared::SeaUniforms>("sea uniforms")),
      compute_(create.pass("wave/incident_sea.comp")) {
  const auto blocks = layerBlocks(*scene.wave, layout);
  block_count_ = static_cast<std::uint32_t>(blocks.size());
  blocks_ = create.texels("sea blocks", blocks.size(), gpu::TexelFormat::kRGBA32UI);
  if (!create.error()) blocks_.upload(blocks);
}

void WindSea::clear() {
  shown_ = {};
  next_ = {};
  fade_begin_s_.reset();
  step_count_ = 0;
  incident_.clear();
}

void WindSea::fadeTo(SeaState sea) {
  std::erase_if(sea.waves, [](const PlaneWave& each) { return each.sides == 0; });
  wanted_ = std::move(sea);
}

void WindSea::continueIn(const core::Scene& scene, double time_s) {
  shown_ = continued(std::move(shown_), scene, time_s);
  next_ = continued(std::move(next_), scene, time_s);
  if (shown_.waves.empty() && next_.waves.empty()) incident_.clear();
  uploadTables();
}

CarriedSea WindSea::carried() const {
  return {.shown = shown_, .next = next_, .fade_begin_s = fade_begin_s_, .step_count = step_count_};
}

void WindSea::takeOver(const CarriedSea& carried) {
  // Each grid resolves other waves. Those of the other one come in until they have faded into this grid's.
  shown_ = carried.shown;
  next_ = carried.next;
  fade_begin_s_ = carried.fade_begin_s;
  uploadTables();
}

const gpu::TexelBuffer* WindSea::advance(double begin_s, double dt_s) {
  if (!fade_begin_s_ && wanted_.waves != shown_.waves) {
    next_ = wanted_;
    fade_begin_s_ = begin_s;
    uploadTables();
  }
  const double faded_ratio = fade_begin_s_ ? pulse((begin_s - *fade_begin_s_) / kFade_s) : 0.0;
  if (faded_ratio >= 1.0) {
    shown_ = std::move(next_);
    next_ = {};
    fade_begin_s_.reset();
    if (shown_.waves.empty()) incident_.clear();
    uploadTables();
    return advance(begin_s, dt_s);
  }
  if (shown_.waves.empty() && !fade_begin_s_) return nullptr;
  const shared::SeaUniforms uniforms = uniformsAt(begin_s, dt_s, faded_ratio);
  ++step_count_;
  uniforms_.uploadValue(uniforms);
  uniforms_.bindUniform(SEA_UNIFORMS);
  blocks_.bindTexel(SEA_BLOCKS);
  columns_.bindTexel(SEA_COLUMNS);
  rows_.bindTexel(SEA_ROWS);
  incident_.bindStorage(INCIDENT_SEA);
  compute_.run(SEA_BLOCK, (block_count_ + uniforms.block_stride - 1) / uniforms.block_stride);
  return &incident_;
}

void WindSea::uploadTables() {
  std::vector<std::array<float, 2>> columns, rows;
  columns.reserve(std::size_t{MAX_SEA_WAVES} * layout_.count_x);
  for (const SeaState* sea : {&shown_, &next_}) {
    for (const PlaneWave& wave : sea->waves) {
      const double k = std::hypot(wave.kx_radpm, wave.kz_radpm);
      const auto factor = [&](double k_radpm, std::uint32_t cell, double side_m) {
        return texelOf(
            factorAt(k_radpm, wave.decay_pm, k_radpm / k, (cell + 0.5) * layout_.cell_m - side_m / 2, side_m));
      };
      for (std::uint32_t x = 0; x < layout_.count_x; ++x) columns.push_back(factor(wave.kx_radpm, x, layout_.length_m));
      for (std::uint32_t z = 0; z < layout_.count_z; z += SEA_STRIP)
        rows.push_back(factor(wave.kz_radpm, z, layout_.width_m));
    }
  }
  if (columns.empty()) return;
  columns_.upload(columns);
  rows_.upload(rows);
}

shared::SeaUniforms WindSea::uniformsAt(double begin_s, double dt_s, double faded_ratio) const {
  shared::SeaUniforms out{};
  double fastest_radps = 0.0;
  for (const SeaState* sea : {&shown_, &next_})
    for (const PlaneWave& wave : sea->waves) fastest_radps = std::max(fastest_radps, wave.omega_radps);
  const auto held_steps =
      static_cast<std::uint32_t>(std::clamp(kHeld_rad / (fastest_radps * dt_s), 1.0, double{kHeldMaxSteps}));
  // The energies of the two seas add up, as they have nothing to do with each other.
  const double shares[] = {std::cos(faded_ratio * std::numbers::pi / 2), std::sin(faded_ratio * std::numbers::pi / 2)};
  for (const SeaState* sea : {&shown_, &next_}) {
    const double share = shares[sea == &next_];
    for (const PlaneWave& wave : sea->waves) {
      const double half = 0.5 * wave.omega_radps * dt_s;
      // Values hold for the middle of several steps; the mean of the wave over them is lower by the quotient. The
      // layer compares means of two steps (wave/continuity.comp), which are lower by the cosine.
      const double correction = held_steps * std::sin(half) / std::sin(held_steps * half) * std::cos(half);
      const double middle_s = begin_s + 0.5 * (held_steps - 1) * dt_s;
      const double turn = std::fmod(wave.omega_radps * middle_s, 2 * std::numbers::pi);
      const Complex strength = std::polar(share * wave.amplitude_m * correction, wave.phase_rad - turn);
      const Complex elevation = strength * std::polar(double{ELEVATION_UNITS_PER_M}, -half);
      // From continuity, eta_t = -div q, with the differences of the grid.
      const double sx = 2 / layout_.cell_m * std::sin(0.5 * wave.kx_radpm * layout_.cell_m);
      const double sz = 2 / layout_.cell_m * std::sin(0.5 * wave.kz_radpm * layout_.cell_m);
      const Complex flow = strength * (2 / dt_s * std::sin(half) / (sx * sx + sz * sz));
      const Complex flow_x = flow * std::polar(sx, 0.5 * wave.kx_radpm * layout_.cell_m);
      const Complex flow_z = flow * std::polar(sz, 0.5 * wave.kz_radpm * layout_.cell_m);
      const double k = std::hypot(wave.kx_radpm, wave.kz_radpm);
      const auto step = [&](double k_axis, double cells) {
        return std::polar(std::exp(-wave.decay_pm * k_axis / k * cells * layout_.cell_m),
                          k_axis * cells * layout_.cell_m);
      };
      const Complex next = step(wave.kz_radpm, 1.0);
      const Complex before = step(wave.kx_radpm, -1.0);
      const auto f = [](double v) { return static_cast<float>(v); };
      out.waves[out.wave_count++] = {.elevation_re = f(elevation.real()),
                                     .elevation_im = f(elevation.imag()),
                                     .flow_x_re = f(flow_x.real()),
                                     .flow_x_im = f(flow_x.imag()),
                                     .flow_z_re = f(flow_z.real()),
                                     .flow_z_im = f(flow_z.imag()),
                                     .next_re = f(next.real()),
                                     .next_im = f(next.imag()),
                                     .before_re = f(before.real()),
                                     .before_im = f(before.imag()),
                                     .sides = wave.sides,
                                     .share_of_x = f(sx * sx / (sx * sx + sz * sz))};
    }
  }
  out.first_block = static_cast<std::uint32_t>(step_count_ % held_steps);
  out.block_stride = held_steps;
  out.block_count = block_count_;
  return out;
}

}  // namespace spindrift::sim
