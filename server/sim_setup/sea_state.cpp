#include <algorithm>
#include <cmath>
#include <numbers>

#include <spindrift/core/random.h>
#include <spindrift/sim_setup/scene_parts.h>
#include <spindrift/sim_setup/sea_state.h>

namespace spindrift::sim {
namespace {

using std::numbers::pi;

/// Longest wave, as a share of the water's longer side.
constexpr double kLongestWaveShare = 0.5;
/// Significant height over depth, at most. Waves of the sea break beyond it.
constexpr double kLargestHeightShare = 0.5;
/// Directions are spread like cos^(2s)(angle/2) about the wind. s of waves at the peak of a young sea (Mitsuyasu et al.
/// 1975).
constexpr double kSpreadExponent = 10.0;
/// Of a mean JONSWAP spectrum.
constexpr double kPeakEnhancement = 3.3;
/// Dimensionless fetch g F/U^2 at which the peak reaches the frequency of a fully developed sea, 0.88 g/U.
constexpr double kDevelopedFetch = 15625.0;
constexpr double kSmallestVariance_m2 = 1e-12;

/// Returns the sides in whose layers a wave of this direction is present. It enters at the sides that it comes from. If
/// all of those are open it fills the whole water, so the layers of the other sides let it pass, too.
std::uint32_t sidesOfWave(const core::WaveScene& water, double direction_x, double direction_z) {
  const std::uint32_t absorbing = sidesWith(water, core::WaveBoundary::kAbsorb);
  const std::uint32_t closed = sidesWith(water, core::WaveBoundary::kReflect);
  std::uint32_t from = 0;
  if (direction_x != 0.0) from |= direction_x > 0 ? MINUS_X_BIT : PLUS_X_BIT;
  if (direction_z != 0.0) from |= direction_z > 0 ? MINUS_Z_BIT : PLUS_Z_BIT;
  if ((from & absorbing) == 0) return 0;
  return (from & closed) == 0 ? absorbing : from & absorbing;
}

/// Returns the numbers below kSeaWaveCount in the order of the multiples of the golden ratio (modulo 1, from `begin`):
/// numbers that follow each other are far apart, and every part of the order has small and large ones.
std::vector<int> mixedOrder(double begin) {
  std::vector<double> multiples;
  for (int n = 0; n < kSeaWaveCount; ++n) multiples.push_back(std::fmod(begin + n / std::numbers::phi, 1.0));
  std::vector<int> out;
  for (const double each : multiples)
    out.push_back(static_cast<int>(std::ranges::count_if(multiples, [&](double other) { return other < each; })));
  return out;
}

/// Returns false for waves that the scene's damping ends within a turn: they creep back to the level instead of
/// travelling.
bool oscillates(double omega_radps, const core::WaveScene& wave) {
  return 2 * omega_radps > wave.damping_per_s;
}

double groupSpeed(double k_radpm, double gravity_mps2, double depth_m) {
  const double kd = k_radpm * depth_m;
  const double ratio = kd > 300 ? 0.0 : 2 * kd / std::sinh(2 * kd);
  return 0.5 * waveFrequency(k_radpm, gravity_mps2, depth_m) / k_radpm * (1 + ratio);
}

}  // namespace

double waveFrequency(double k_radpm, double gravity_mps2, double depth_m) {
  return std::sqrt(gravity_mps2 * k_radpm * std::tanh(k_radpm * depth_m));
}

double waveNumber(double omega_radps, double gravity_mps2, double depth_m) {
  // Newton's method for x tanh x = y, x = k d. From above the root it falls onto it, because the function is convex.
  const double y = omega_radps * omega_radps * depth_m / gravity_mps2;
  double x = std::sqrt(y) * std::max(1.0, std::sqrt(y)) + 1e-12;
  for (int k = 0; k < 60; ++k) {
    const double t = std::tanh(x);
    const double next = x - (x * t - y) / (t + x * (1 - t * t));
    const bool is_done = std::abs(next - x) <= 1e-14 * x;
    x = next;
    if (is_done) break;
  }
  return x / depth_m;
}

double jonswapPeak(double ratio, double enhancement) {
  const double width = ratio <= 1 ? 0.07 : 0.09;
  return std::pow(enhancement, std::exp(-0.5 * std::pow((ratio - 1) / width, 2)));
}

Distribution::Distribution(double from, double to, const std::function<double(double)>& density) : from_(from) {
  constexpr int kSteps = 4000;
  step_ = (to - from) / kSteps;
  sums_.push_back(0.0);
  for (int k = 0; k < kSteps; ++k) sums_.push_back(sums_.back() + density(from + (k + 0.5) * step_) * step_);
}

double Distribution::quantile(double share) const {
  const double wanted = std::clamp(share, 0.0, 1.0) * integral();
  const auto above = std::ranges::upper_bound(sums_, wanted);
  if (above == sums_.end()) return from_ + static_cast<double>(sums_.size() - 1) * step_;
  const auto k = above - sums_.begin() - 1;
  const double low = sums_[static_cast<std::size_t>(k)];
  return from_ + (static_cast<double>(k) + (wanted - low) / (*above - low)) * step_;
}

WindSeaSpectrum WindSeaSpectrum::of(double wind_speed_mps, double fetch_m, double gravity_mps2, double depth_m) {
  const double square = wind_speed_mps * wind_speed_mps;
  const double fetch = std::min(gravity_mps2 * fetch_m / square, kDevelopedFetch);
  WindSeaSpectrum out;
  out.gravity_mps2 = gravity_mps2;
  out.depth_m = depth_m;
  out.alpha = 0.076 * std::pow(fetch, -0.22);
  out.peak_radps = 22.0 * gravity_mps2 / wind_speed_mps * std::cbrt(1.0 / fetch);
  return out;
}

double WindSeaSpectrum::density(double omega_radps) const {
  const double ratio = omega_radps / peak_radps;
  const double peak = jonswapPeak(ratio, kPeakEnhancement);
  const double deep =
      alpha * gravity_mps2 * gravity_mps2 * std::pow(omega_radps, -5) * std::exp(-1.25 * std::pow(ratio, -4)) * peak;
  const double kd = waveNumber(omega_radps, gravity_mps2, depth_m) * depth_m;
  const double t = std::tanh(kd);
  return deep * t * t / (kd > 300 ? 1.0 : 1 + 2 * kd / std::sinh(2 * kd));
}

SeaState continued(SeaState sea, const core::Scene& scene, double time_s) {
  const double d = scene.wave->depth_m;
  const double share = std::min(1.0, kLargestHeightShare * d / std::max(sea.significant_height_m, 1e-9));
  sea.significant_height_m *= share;
  for (PlaneWave& wave : sea.waves) {
    const double omega = waveFrequency(std::hypot(wave.kx_radpm, wave.kz_radpm), scene.gravity_mps2, d);
    wave.phase_rad = std::fmod(wave.phase_rad + (omega - wave.omega_radps) * time_s, 2 * pi);
    wave.omega_radps = omega;
    wave.amplitude_m *= share;
  }
  std::erase_if(sea.waves, [&](const PlaneWave& wave) { return !oscillates(wave.omega_radps, *scene.wave); });
  return sea;
}

std::uint64_t windSeaBytes(core::CellCounts cells) {
  const auto over = [](std::uint64_t count, std::uint64_t per) { return (count + per - 1) / per; };
  const std::uint64_t tables = MAX_SEA_WAVES * 8 * (cells.x + over(cells.z, SEA_STRIP));
  const std::uint64_t blocks = 16 * over(cells.x, SEA_BLOCK) * over(cells.z, SEA_BLOCK);
  return cells.total() * 16 + tables + blocks + sizeof(shared::SeaUniforms);
}

SeaState seaState(const core::Scene& scene, const WaveLayout& layout) {
  SeaState out;
  if (!hasWindSea(scene)) return out;
  const core::StormScene& storm = *scene.storm;
  const core::WaveScene& wave = *scene.wave;
  const double g = scene.gravity_mps2;
  const double d = wave.depth_m;
  out.wind_speed_mps = storm.level_ratio * storm.wind_speed_mps;
  if (out.wind_speed_mps <= 0 || g <= 0) return out;
  const auto spectrum = WindSeaSpectrum::of(out.wind_speed_mps, storm.fetch_m, g, d);
  out.peak_period_s = 2 * pi / spectrum.peak_radps;
  out.peak_length_m = 2 * pi / waveNumber(spectrum.peak_radps, g, d);
  const double lowest = waveFrequency(2 * pi / (kLongestWaveShare * layout.longerSide_m()), g, d);
  const double highest = waveFrequency(2 * pi / (kShortestWave_cells * layout.cell_m), g, d);
  const Distribution energy(lowest, highest, [&](double omega) { return spectrum.density(omega); });
  const double cap_m = storm.level_ratio * std::min(storm.wave_height_m, kLargestHeightShare * d);
  const double variance_m2 = std::min(energy.integral(), cap_m * cap_m / 16);
  if (!(variance_m2 > kSmallestVariance_m2)) return out;
  out.significant_height_m = 4 * std::sqrt(variance_m2);

  const Distribution spread(-pi / 2, pi / 2,
                            [](double angle) { return std::pow(std::cos(angle / 2), 2 * kSpreadExponent); });
  core::SplitMix64 random(scene.seed * 0x9fb21c651e98df25ull + 1);
  const std::vector<int> place = mixedOrder(random.unit());
  for (int n = 0; n < kSeaWaveCount; ++n) {
    PlaneWave each;
    each.amplitude_m = std::sqrt(2 * variance_m2 / kSeaWaveCount);
    each.omega_radps = energy.quantile((n + random.unit()) / kSeaWaveCount);
    const double share = (place[static_cast<std::size_t>(n)] + 0.5) / kSeaWaveCount;
    const double angle = storm.wind_direction_deg * pi / 180 + spread.quantile(share);
    double k = waveNumber(each.omega_radps, g, d);
    each.kx_radpm = k * std::cos(angle);
    each.kz_radpm = k * std::sin(angle);
    // A whole number of waves between periodic sides.
    const auto wholeWaves = [](double k_radpm, double side_m) {
      const double whole = 2 * pi / side_m;
      return whole * std::round(k_radpm / whole);
    };
    if (isPeriodicX(wave)) each.kx_radpm = wholeWaves(each.kx_radpm, layout.length_m);
    if (isPeriodicZ(wave)) each.kz_radpm = wholeWaves(each.kz_radpm, layout.width_m);
    k = std::hypot(each.kx_radpm, each.kz_radpm);
    each.phase_rad = 2 * pi * random.unit();
    if (k <= 0) continue;
    each.omega_radps = waveFrequency(k, g, d);
    if (!oscillates(each.omega_radps, wave)) continue;
    each.decay_pm = 0.5 * wave.damping_per_s / groupSpeed(k, g, d);
    each.sides = sidesOfWave(wave, each.kx_radpm, each.kz_radpm);
    out.waves.push_back(each);
  }
  return out;
}

}  // namespace spindrift::sim
