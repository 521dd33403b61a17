#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include <fmt/format.h>

#include <spindrift/core/fourier.h>
#include <spindrift/core/random.h>
#include <spindrift/sim_setup/ground.h>
#include <spindrift/sim_setup/incident_waves.h>
#include <spindrift/sim_setup/pulse.h>
#include <spindrift/sim_setup/scene_parts.h>
#include <spindrift/sim_setup/sea_state.h>

#include "side_response.h"

namespace spindrift::sim {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;
using Component = IncidentWaves::Component;

/// The spectrum is taken between these shares of its peak's frequency: more than 99 % of its energy.
constexpr double kLowestShare = 0.6;
constexpr double kHighestShare = 3.5;
/// A solitary wave begins where it is this small: sech^2(x) = 2e-4.
constexpr double kSolitaryReach = 5.0;
/// A side's answer reaches so many depths over c before and after the level that it answers.
constexpr double kAnswerReach_depths = 30.0;
constexpr std::size_t kTableMaxCount = std::size_t{1} << 19;
/// Frequencies at which a side's answer is computed; between, it is linear.
constexpr int kAnswerCount = 400;
/// From this share of the highest frequency on, series lose what they have.
constexpr double kTaperShare = 0.75;
/// Height of the steepest waves: 0.142 L tanh(k d) (Miche 1944); significant heights are at most this share of it.
constexpr double kMicheRatio = 0.142;
constexpr double kSignificantShare = 0.6;

/// Factors from the level of a wave to its flow and to the level at the side.
struct Gain {
  double flow_mps;
  double phase_mps;  ///< speed of the wave's crests
  Complex edge;
};

/// The answers of a side over frequencies, for series.
class Answers {
 public:
  explicit Answers(const SideResponse& side) : long_mps_(side.longWave_mps()), highest_radps_(side.highest_radps()) {
    gains_.push_back({long_mps_, long_mps_, side.longEdge()});
    for (int k = 1; k <= kAnswerCount; ++k) {
      const double omega = highest_radps_ * k / kAnswerCount * (1 - 1e-12);
      const auto answer = side.at(omega);
      gains_.push_back(answer ? Gain{answer->flow_mps, omega / answer->wavenumber_radpm, answer->edge} : gains_.back());
    }
  }
  [[nodiscard]] Gain at(double omega_radps) const {
    const double share = std::min(omega_radps / highest_radps_, 1.0);
    const double place = share * kAnswerCount;
    const auto k = static_cast<std::size_t>(std::min(place, kAnswerCount - 1.0));
    const double rest = place - static_cast<double>(k);
    const double kept = 1 - pulse((share - kTaperShare) / (1 - kTaperShare));
    return {kept * std::lerp(gains_[k].flow_mps, gains_[k + 1].flow_mps, rest),
            std::lerp(gains_[k].phase_mps, gains_[k + 1].phase_mps, rest),
            kept * (gains_[k].edge * (1 - rest) + gains_[k + 1].edge * rest)};
  }

 private:
  double long_mps_, highest_radps_;
  std::vector<Gain> gains_;
};

/// A level over time that is 0 outside of 0 to end_s.
struct Level {
  double end_s = 0.0;
  std::function<double(double)> at;
};

/// The solitary wave of Serre's equations (Serre 1953).
Level solitaryLevel(double height_m, double depth_m, double speed_mps) {
  const double rate_per_s = std::sqrt(0.75 * height_m / (depth_m + height_m)) / depth_m * speed_mps;
  const double reach_s = kSolitaryReach / rate_per_s;
  return {2 * reach_s, [=](double t) {
            const double c = std::cosh(rate_per_s * (t - reach_s));
            return height_m / (c * c);
          }};
}

Level seriesLevel(const core::ElevationSeries& series) {
  const double last_s = series.time_s.empty() ? 0.0 : series.time_s.back();
  return {last_s, [&series](double t) {
            const auto after = std::ranges::upper_bound(series.time_s, t);
            if (after == series.time_s.begin() || after == series.time_s.end()) return 0.0;
            const auto k = static_cast<std::size_t>(after - series.time_s.begin());
            const double share = (t - series.time_s[k - 1]) / (series.time_s[k] - series.time_s[k - 1]);
            return std::lerp(series.elevation_m[k - 1], series.elevation_m[k], share);
          }};
}

/// The level at equal steps, from `before_s` before its begin to as long after its end.
IncidentWaves::Table sampled(const Level& level, double dt_s, double before_s) {
  IncidentWaves::Table out;
  const double span_s = level.end_s + 2 * before_s;
  out.begin_s = -before_s;
  out.step_s = std::max(dt_s, span_s / static_cast<double>(kTableMaxCount - 2));
  const auto count = static_cast<std::size_t>(std::ceil(span_s / out.step_s)) + 1;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = out.begin_s + static_cast<double>(k) * out.step_s;
    out.values.push_back({.elevation_m = t < 0 || t > level.end_s ? 0.0 : level.at(t), .flow_m2ps = 0.0});
  }
  return out;
}

/// Turns levels of a wave into its flow and the level at the side. `flowOf` gives the factor of the flow.
template <typename FlowOf>
void answer(IncidentWaves::Table& table, const SideResponse& side, FlowOf flowOf) {
  const Answers answers(side);
  std::size_t n = 1;
  while (n < table.values.size()) n *= 2;
  std::vector<Complex> flow(n);
  for (std::size_t k = 0; k < table.values.size(); ++k) flow[k] = table.values[k].elevation_m;
  core::transform(flow, core::Transform::kForward);
  std::vector<Complex> edge = flow;
  for (std::size_t k = 0; k < n; ++k) {
    const bool is_negative = k > n / 2;
    const auto cycles = static_cast<double>(is_negative ? n - k : k);
    const double omega = 2 * pi * cycles / (static_cast<double>(n) * table.step_s);
    const Gain gain = answers.at(omega);
    flow[k] *= flowOf(gain) / static_cast<double>(n);
    edge[k] *= (is_negative ? std::conj(gain.edge) : gain.edge) / static_cast<double>(n);
  }
  core::transform(flow, core::Transform::kInverse);
  core::transform(edge, core::Transform::kInverse);
  for (std::size_t k = 0; k < table.values.size(); ++k)
    table.values[k] = {.elevation_m = edge[k].real(), .flow_m2ps = flow[k].real()};
}

std::optional<Component> componentOf(const SideResponse& side, double amplitude_m, double omega, double phase_rad) {
  const auto answered = side.at(omega);
  if (!answered) return std::nullopt;
  return Component{.omega_radps = omega,
                   .phase_rad = phase_rad,
                   .flow_m2ps = amplitude_m * answered->flow_mps,
                   .edge_m = amplitude_m * std::abs(answered->edge),
                   .edge_phase_rad = phase_rad + std::arg(answered->edge)};
}

/// The second harmonic that belongs to a regular wave and travels with it (Stokes 1847): without it, the maker sends a
/// free one that cancels it at the side. Longer waves than those for which it is a quarter of the wave have other
/// forms.
std::optional<Component> boundHarmonic(const SideResponse& side, double amplitude_m, double omega, double phase_rad,
                                       double depth_m) {
  constexpr double kMostShare = 0.25;
  const auto wave = side.at(omega);
  const auto free_wave = side.at(2 * omega);
  if (!wave || !free_wave) return std::nullopt;
  const double t = std::tanh(wave->wavenumber_radpm * depth_m);
  const double share = 0.25 * wave->wavenumber_radpm * amplitude_m * (3 - t * t) / (t * t * t);
  const double bound_m = amplitude_m * std::min(share, kMostShare);
  const double flow_mps = side.forcedFlow_mps(2 * omega, 2 * wave->wavenumber_radpm);
  return Component{.omega_radps = 2 * omega,
                   .phase_rad = 2 * phase_rad,
                   .flow_m2ps = bound_m * flow_mps,
                   .edge_m = bound_m * std::abs(free_wave->edge),
                   .edge_phase_rad = 2 * phase_rad + std::arg(free_wave->edge)};
}

/// JONSWAP over the frequency's share of the peak's, without a factor.
double jonswap(double ratio, double enhancement) {
  return std::pow(ratio, -5) * std::exp(-1.25 * std::pow(ratio, -4)) * jonswapPeak(ratio, enhancement);
}

/// Waves of equal energy: the spectrum is cut into as many parts, and a random frequency is chosen from each. They are
/// the same on every grid; what a grid does not resolve is left out, and the others make up for it.
std::vector<Component> irregularComponents(const core::IrregularWaves& waves, std::uint64_t scene_seed,
                                           const SideResponse& side) {
  const double peak = 2 * pi / waves.peak_period_s;
  const Distribution energy(kLowestShare, kHighestShare,
                            [&](double ratio) { return jonswap(ratio, waves.peak_enhancement_ratio); });
  core::SplitMix64 random((waves.seed != 0 ? waves.seed : scene_seed) * 0x9fb21c651e98df25ull + 2);
  const auto count = static_cast<double>(waves.waves_count);
  std::vector<Component> out;
  for (std::uint32_t n = 0; n < waves.waves_count; ++n) {
    const double omega = peak * energy.quantile((n + random.unit()) / count);
    const double phase = 2 * pi * random.unit();
    if (const auto each = componentOf(side, 1.0, omega, phase)) out.push_back(*each);
  }
  const double amplitude_m = waves.significant_height_m / 4 * std::sqrt(2 / static_cast<double>(out.size()));
  for (Component& each : out) {
    each.flow_m2ps *= amplitude_m;
    each.edge_m *= amplitude_m;
  }
  return out;
}

/// Flow of a simple wave of shallow water that runs into water at rest (Stoker 1957). [m^2/s]
double simpleFlow(double gravity_mps2, double depth_m, double elevation_m) {
  const double water_m = std::max(depth_m + elevation_m, 0.0);
  return water_m * 2 * (std::sqrt(gravity_mps2 * water_m) - std::sqrt(gravity_mps2 * depth_m));
}

using core::invalid;

core::Result<void> periodFits(const std::string& path, const char* name, double period_s, double height_m,
                              double height_share, const core::Scene& scene, const WaveLayout& layout, double depth_m) {
  const double g = scene.gravity_mps2;
  const double omega = 2 * pi / period_s;
  const double k = disperses(scene) ? waveNumber(omega, g, depth_m) : omega / std::sqrt(g * depth_m);
  const double length_m = 2 * pi / k;
  if (length_m < kShortestWave_cells * layout.cell_m) {
    return invalid(fmt::format(
        "{}.{}: waves of {:.4g} s are {:.4g} m long in {:.4g} m of water, less than {} cells of {:.4g} m: choose a "
        "longer period, or a higher wave.resolution_count",
        path, name, period_s, length_m, depth_m, kShortestWave_cells, layout.cell_m));
  }
  const double limit_m = height_share * kMicheRatio * length_m * std::tanh(k * depth_m);
  if (height_m > limit_m) {
    return invalid(
        fmt::format("{}: waves of {:.4g} s and {:.4g} m break at once; with this period choose at most {:.4g} m", path,
                    period_s, height_m, limit_m));
  }
  return {};
}

}  // namespace

IncidentWaves IncidentWaves::of(const core::WaveMaker& maker, const core::Scene& scene, const WaveLayout& layout,
                                double depth_m) {
  IncidentWaves out;
  out.begin_s_ = maker.begin_s;
  out.duration_s_ = maker.duration_s;
  out.depth_m_ = depth_m;
  out.gravity_mps2_ = scene.gravity_mps2;
  if (scene.gravity_mps2 <= 0 || depth_m <= 0) return out;
  const double g = scene.gravity_mps2;
  out.is_simple_wave_ = isNonlinear(scene) && !disperses(scene);
  const SideResponse side(g, depth_m, layout.cell_m, layout.dt_s, disperses(scene));
  const double long_mps = side.longWave_mps();
  const double before_s = out.is_simple_wave_ ? 0.0 : kAnswerReach_depths * depth_m / long_mps;
  out.absorbing_mps_ = side.longAbsorbing_mps();
  if (out.is_simple_wave_) {
    out.seen_later_s_ = 0.5 * layout.dt_s - 0.5 * layout.cell_m / long_mps;
    out.own_part_spm_ = 0.5 * layout.dt_s / layout.cell_m;
  }
  if (const auto* regular = std::get_if<core::RegularWaves>(&maker.waves)) {
    const double omega = 2 * pi / regular->period_s;
    out.ramp_s_ = regular->period_s;
    const double amplitude_m = regular->height_m / 2;
    if (const auto each = componentOf(side, amplitude_m, omega, -pi / 2); each && amplitude_m > 0)
      out.components_ = {*each};
    if (isNonlinear(scene) && disperses(scene) && !out.components_.empty()) {
      if (const auto bound = boundHarmonic(side, amplitude_m, omega, -pi / 2, depth_m))
        out.components_.push_back(*bound);
    }
    if (const auto answered = side.at(omega)) out.absorbing_mps_ = answered->absorbing_mps;
  } else if (const auto* irregular = std::get_if<core::IrregularWaves>(&maker.waves)) {
    out.ramp_s_ = irregular->peak_period_s;
    if (irregular->significant_height_m > 0) out.components_ = irregularComponents(*irregular, scene.seed, side);
    if (const auto answered = side.at(2 * pi / irregular->peak_period_s)) out.absorbing_mps_ = answered->absorbing_mps;
  } else if (const auto* solitary = std::get_if<core::SolitaryWave>(&maker.waves)) {
    if (solitary->height_m < 1e-6 * depth_m) return out;
    const double speed_mps = isNonlinear(scene) ? std::sqrt(g * (depth_m + solitary->height_m)) : long_mps;
    out.table_ = sampled(solitaryLevel(solitary->height_m, depth_m, speed_mps), layout.dt_s, before_s);
    if (out.is_simple_wave_) return out;
    // A wave of permanent form moves all of its water with its own speed.
    answer(out.table_, side, [&](const Gain& gain) { return gain.flow_mps * speed_mps / gain.phase_mps; });
  } else {
    const auto& series = std::get<core::ElevationSeries>(maker.waves);
    out.table_ = sampled(seriesLevel(series), layout.dt_s, before_s);
    if (out.is_simple_wave_) return out;
    const Table levels = out.table_;
    answer(out.table_, side, [](const Gain& gain) { return gain.flow_mps; });
    if (!isNonlinear(scene)) return out;
    // Long waves carry more water the higher they are: the second term of their flow.
    for (std::size_t k = 0; k < levels.values.size(); ++k)
      out.table_.values[k].flow_m2ps +=
          0.75 * long_mps / depth_m * levels.values[k].elevation_m * levels.values[k].elevation_m;
  }
  if (!out.is_simple_wave_) return out;
  // The components' levels are those of the wave itself, as of any simple wave, whose flow follows from its level.
  for (Component& each : out.components_) {
    each.edge_m = each.flow_m2ps / long_mps;
    each.edge_phase_rad = each.phase_rad;
  }
  return out;
}

Incident IncidentWaves::linearAt(double since_s) const {
  if (components_.empty()) {
    const double place = (since_s - table_.begin_s) / table_.step_s;
    if (!(place >= 0.0) || !(place < static_cast<double>(table_.values.size()) - 1)) return {};
    const auto k = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(k);
    const Incident& a = table_.values[k];
    const Incident& b = table_.values[k + 1];
    return {.elevation_m = std::lerp(a.elevation_m, b.elevation_m, share),
            .flow_m2ps = std::lerp(a.flow_m2ps, b.flow_m2ps, share)};
  }
  Incident out;
  if (since_s <= 0) return out;
  for (const Component& each : components_) {
    const double turn = std::fmod(each.omega_radps * since_s, 2 * pi);
    out.elevation_m += each.edge_m * std::cos(turn + each.edge_phase_rad);
    out.flow_m2ps += each.flow_m2ps * std::cos(turn + each.phase_rad);
  }
  double share = pulse(since_s / ramp_s_);
  if (duration_s_ > 0) share *= 1 - pulse((since_s - duration_s_) / ramp_s_);
  return {.elevation_m = share * out.elevation_m, .flow_m2ps = share * out.flow_m2ps};
}

Incident IncidentWaves::at(double time_s) const {
  Incident out = linearAt(time_s - begin_s_);
  if (!is_simple_wave_) return out;
  out.flow_m2ps = simpleFlow(gravity_mps2_, depth_m_, out.elevation_m);
  // The centres of the cells are half a cell inside, and a maker sees their level half a step later, less half of its
  // own part (side_response.h).
  const double later_s = time_s - begin_s_ + seen_later_s_;
  const double inside_m = linearAt(later_s).elevation_m;
  out.elevation_m = inside_m - own_part_spm_ * out.flow_m2ps;
  return out;
}

double depthAtSide(const core::Scene& scene, const WaveLayout& layout, core::Side side) {
  const bool along_z = side == core::Side::kMinusX || side == core::Side::kPlusX;
  const bool is_plus = side == core::Side::kPlusX || side == core::Side::kPlusZ;
  const double edge_m = 0.5 * ((along_z ? layout.length_m : layout.width_m) - layout.cell_m) * (is_plus ? 1 : -1);
  const std::uint32_t count = along_z ? layout.count_z : layout.count_x;
  double deepest_m = -1e9;
  for (std::uint32_t k = 0; k < count; ++k) {
    const double along_m = (k + 0.5) * layout.cell_m - 0.5 * (along_z ? layout.width_m : layout.length_m);
    deepest_m =
        std::max(deepest_m, groundDepthWithObstacles(scene, along_z ? edge_m : along_m, along_z ? along_m : edge_m));
  }
  return deepest_m;
}

core::Result<void> makersFit(const core::Scene& scene, const WaveLayout& layout) {
  for (std::size_t k = 0; k < scene.wave_makers.size(); ++k) {
    const core::WaveMaker& maker = scene.wave_makers[k];
    const std::string path = fmt::format("wave_makers[{}]", k);
    const double depth_m = depthAtSide(scene, layout, maker.side);
    if (depth_m <= 0)
      return invalid(path + ".side: all of this side is dry; choose another one, or a bed under water there");
    if (scene.gravity_mps2 <= 0) continue;
    core::Result<void> fits;
    if (const auto* regular = std::get_if<core::RegularWaves>(&maker.waves)) {
      fits =
          periodFits(path + ".regular", "period_s", regular->period_s, regular->height_m, 1.0, scene, layout, depth_m);
    } else if (const auto* irregular = std::get_if<core::IrregularWaves>(&maker.waves)) {
      fits = periodFits(path + ".irregular", "peak_period_s", irregular->peak_period_s, irregular->significant_height_m,
                        kSignificantShare, scene, layout, depth_m);
    }
    if (!fits) return fits;
  }
  return {};
}

}  // namespace spindrift::sim
