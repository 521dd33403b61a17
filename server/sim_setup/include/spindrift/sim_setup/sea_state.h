// The sea that wind raises, as a sum of plane waves: spectrum, directions and heights follow from wind speed and fetch.
// Pure functions of the scene; docs/wind_sea.md has the formulas and their sources.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <shared/sea_uniforms.h>
#include <shared/side_bits.h>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// Plane waves of a sea. Each carries the same share of its energy.
inline constexpr int kSeaWaveCount = 32;
/// The shortest of them in cells: the model's phase speeds are within 1 % from this length on (docs/dispersion.md).
inline constexpr double kShortestWave_cells = 8.0;

/// amplitude cos(kx x + kz z - omega t + phase), x and z from the centre of the water.
struct PlaneWave {
  double amplitude_m = 0.0;
  double omega_radps = 0.0;
  double kx_radpm = 0.0;
  double kz_radpm = 0.0;
  double phase_rad = 0.0;
  double decay_pm = 0.0;  ///< the scene's damping lowers the amplitude by this share per metre along its way
  std::uint32_t sides =
      0;  ///< absorbing sides (side_bits.h) in whose layers it is present; 0: it comes from a closed side
  bool operator==(const PlaneWave&) const = default;
};

/// A wind sea. Without waves: calm.
struct SeaState {
  double wind_speed_mps = 0.0;        ///< at the scene's storm level
  double significant_height_m = 0.0;  ///< four standard deviations of the elevation that the waves below add up to
  double peak_period_s = 0.0;
  double peak_length_m = 0.0;
  std::vector<PlaneWave> waves;
  bool operator==(const SeaState&) const = default;
};

/// Returns k > 0 with omega^2 = g k tanh(k d). [rad/m] Precondition: all arguments are positive.
[[nodiscard]] double waveNumber(double omega_radps, double gravity_mps2, double depth_m);
/// Returns omega. [rad/s]
[[nodiscard]] double waveFrequency(double k_radpm, double gravity_mps2, double depth_m);

/// Returns the peak enhancement of JONSWAP (Hasselmann et al. 1973) at a share of the peak's frequency: `enhancement`
/// at 1, 1 far from it.
[[nodiscard]] double jonswapPeak(double ratio, double enhancement);

/// A density over an interval, such as a spectrum or a spread of directions: its integral and its quantiles.
class Distribution {
 public:
  Distribution(double from, double to, const std::function<double(double)>& density);
  [[nodiscard]] double integral() const { return sums_.back(); }
  /// Returns the value below which a share of the integral lies. Precondition: the integral is positive.
  [[nodiscard]] double quantile(double share) const;

 private:
  double from_;
  double step_ = 0.0;
  std::vector<double> sums_;
};

/// JONSWAP spectrum for a wind speed and a fetch (Hasselmann et al. 1973), reduced in shallow water as in the TMA
/// spectrum (Bouws et al. 1985).
struct WindSeaSpectrum {
  double gravity_mps2 = 9.81;
  double depth_m = 0.0;
  double alpha = 0.0;
  double peak_radps = 0.0;

  /// Makes the spectrum. Precondition: all arguments are positive. Beyond the fetch of a fully developed sea (Pierson &
  /// Moskowitz 1964) a longer one changes nothing.
  static WindSeaSpectrum of(double wind_speed_mps, double fetch_m, double gravity_mps2, double depth_m);
  /// Returns the variance of the elevation per unit of frequency. [m^2 s]
  [[nodiscard]] double density(double omega_radps) const;
};

/// Returns the sea of the scene's storm: as much of the spectrum as the grid resolves and the water holds. Calm without
/// a storm, at level 0, and in scenes whose wind waves are gusts (hasWindSea() in scene_parts.h).
[[nodiscard]] SeaState seaState(const core::Scene& scene, const WaveLayout& layout);

/// Returns how a sea continues from `time_s` in water whose depth or gravity has changed: its waves keep their lengths
/// and their levels at that time, and travel as the scene's water lets them. They become lower where they would break;
/// waves that the damping ends within a turn are left out.
[[nodiscard]] SeaState continued(SeaState sea, const core::Scene& scene, double time_s);

/// Bytes of its buffers on the device, at most.
[[nodiscard]] std::uint64_t windSeaBytes(core::CellCounts cells);

}  // namespace spindrift::sim
