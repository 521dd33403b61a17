// Waves that disperse, over a slope and past breakwaters. A packet crosses the water once; the wave of each frequency
// follows from the Fourier integral over its passage.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include "cases.h"
#include "diffraction.h"
#include "exact_linear_waves.h"
#include "mild_slope.h"
#include "ticks.h"
#include "wave_modes.h"
#include "wave_packet.h"

namespace spindrift::study {
namespace {

using core::WaveBoundary;
using std::numbers::pi;
using Series = std::vector<double>;

std::complex<double> fourier(const Series& series, double omega_radps, double dt_s) {
  std::complex<double> sum;
  for (std::size_t k = 0; k < series.size(); ++k)
    sum += series[k] * std::polar(1.0, -omega_radps * dt_s * static_cast<double>(k));
  return sum * dt_s;
}

/// Elevation of each cell after each of `ticks` ticks.
core::Result<std::vector<Series>> record(sim::WaterSim& water, int ticks, std::span<const std::size_t> cells) {
  std::vector<Series> out(cells.size());
  for (int k = 0; k < ticks; ++k) {
    if (auto done = tick(water); !done) return done.error();
    const std::vector<double> eta_m = water.copyState().elevation_m;
    for (std::size_t i = 0; i < cells.size(); ++i) out[i].push_back(eta_m[cells[i]]);
  }
  return out;
}

struct ShoalingRun {
  double period_s;
  std::uint32_t resolution_count;
  double cell_m;
  double tick_rate_hz;
  bool is_quick = false;
};

/// Frequencies of a packet that carry most of its energy: the middle half of its amplitudes.
std::vector<double> frequenciesOf(const AiryWater& water, double k0_radpm, double width_m) {
  std::vector<double> out;
  for (int i = -4; i <= 4; ++i) out.push_back(water.omega_radps(k0_radpm + 0.3 * i / width_m));
  return out;
}

}  // namespace

Outcome shoaling(gpu::Context& ctx, bool quick) {
  constexpr double kDeep_m = 4.0;
  constexpr double kWall_m = 0.35;
  constexpr double kSlope = 0.1;
  constexpr double kAmplitude_m = 0.01;
  std::vector<Row> rows;
  for (const ShoalingRun& each :
       {ShoalingRun{1.5, 320, 0.2, 20.0}, ShoalingRun{3.0, 192, 0.5, 12.0, true}, ShoalingRun{3.0, 384, 0.25, 20.0},
        ShoalingRun{4.5, 384, 0.375, 16.0}, ShoalingRun{6.0, 384, 0.5, 12.0}}) {
    if (quick != each.is_quick) continue;
    const std::size_t n = each.resolution_count;
    core::Scene scene =
        dispersiveScene(each.resolution_count, each.cell_m, kDeep_m, WaveBoundary::kPeriodic, each.tick_rate_hz);
    scene.wave->boundary_minus_x = scene.wave->boundary_plus_x = WaveBoundary::kReflect;
    const double side_m = scene.wave->side_m;
    const SlopeToWall slope{scene.gravity_mps2, kDeep_m, kWall_m, (kDeep_m - kWall_m) / kSlope};
    scene.beaches = {core::Beach{core::Side::kPlusX, slope.length_m, kWall_m}};
    auto water = sim::WaterSim::create(ctx, scene);
    if (!water) return water.error();
    const AiryWater deep = slope.waterAt(0.0);
    const double k0_radpm = deep.waveNumber_radpm(2 * pi / each.period_s);
    const double wavelength_m = 2 * pi / k0_radpm;
    const double width_m = 0.8 * wavelength_m;
    const double foot_m = side_m - slope.length_m;
    const double middle_m = foot_m - 2.5 * width_m;
    setPacket(**water, WavePacket(deep, 4 * side_m, wavelength_m, width_m), kAmplitude_m, middle_m);
    // The gauge at the foot sees the packet alone until its reflection is back; the others see both. Three cells in a
    // row give elevation and slope.
    const double there_s = 2.5 * width_m / deep.groupSpeed_mps(k0_radpm);
    double across_s = 0.0;
    constexpr int kParts = 200;
    for (int i = 0; i < kParts; ++i) {
      const double x_m = (i + 0.5) * slope.length_m / kParts;
      across_s += slope.length_m / kParts /
                  slope.waterAt(x_m).groupSpeed_mps(slope.waterAt(x_m).waveNumber_radpm(2 * pi / each.period_s));
    }
    std::vector<std::size_t> cells;
    std::vector<double> places_m;
    for (const double depth_m : {kDeep_m, 2.0, 1.0, 0.5}) {
      const double wanted_m = foot_m + (kDeep_m - depth_m) / kSlope;
      const auto x = static_cast<std::size_t>(wanted_m / each.cell_m);
      places_m.push_back((static_cast<double>(x) + 0.5) * each.cell_m - foot_m);
      for (const std::size_t at : {x - 1, x, x + 1}) cells.push_back(at + n * (n / 2));
    }
    const double dt_s = 1.0 / each.tick_rate_hz;
    const auto ticks = static_cast<int>((2.2 * there_s + 2 * across_s) / dt_s);
    auto series = record(**water, ticks, cells);
    if (!series) return series.error();
    Series incident = (*series)[1];
    incident.resize(std::min(incident.size(), static_cast<std::size_t>((there_s + 1.2 * across_s) / dt_s)));
    for (std::size_t g = 1; g < places_m.size(); ++g) {
      const AiryWater here = slope.waterAt(places_m[g]);
      double measured = 0.0, expected = 0.0, flux = 0.0, flux_deep = 0.0;
      for (const double omega : frequenciesOf(deep, k0_radpm, width_m)) {
        const double k_radpm = here.waveNumber_radpm(omega);
        const double kdx = k_radpm * each.cell_m;
        const double incident_2 = std::norm(fourier(incident, omega, dt_s));
        const auto before = fourier((*series)[3 * g], omega, dt_s);
        const auto after = fourier((*series)[3 * g + 2], omega, dt_s);
        const auto response = slope.responseAt(places_m[g], omega);
        // |eta|^2 + |eta_x/k|^2 is twice the sum of the squares of what runs up and down the slope.
        measured +=
            std::norm(fourier((*series)[3 * g + 1], omega, dt_s)) + std::norm((after - before) / (2 * std::sin(kdx)));
        expected += incident_2 * (std::norm(response.elevation) + std::norm(response.slope_pm / k_radpm));
        flux += incident_2 * 4 * deep.groupSpeed_mps(deep.waveNumber_radpm(omega)) / here.groupSpeed_mps(k_radpm);
        flux_deep += 4 * incident_2;
      }
      rows.push_back({fmt::format("period {} s, {} m cells: amplitude at {:.2f} m over that at 4 m (energy flux alone: "
                                  "{:.3f})",
                                  each.period_s, each.cell_m, here.depth_m, std::sqrt(flux / flux_deep)),
                      "", std::sqrt(measured / flux_deep), std::sqrt(expected / flux_deep), Tolerance::kRelative, 0.03,
                      "mild-slope equation, slope 1:10 up to a wall"});
    }
  }
  return CaseResult{std::move(rows), {}};
}

namespace {

/// Waves of 2.4 m and 19 cells that meet breakwaters along z, at normal incidence. Waves of exactly 16 or 32 cells
/// would be sent back in part by the blocks of the coarser grids (README.md, Accuracy).
struct Breakwaters {
  static constexpr std::uint32_t kSide = 192;
  static constexpr double kCell_m = 0.125;
  static constexpr double kWavelength_m = 2.4;
  static constexpr double kDepth_m = 1.0;
  static constexpr double kRate_hz = 16.0;
  static constexpr std::size_t kLine = 102;  ///< column of the breakwaters
  static constexpr double kRadius_m = 4.8;   ///< of the arc behind them
  static constexpr double kWidth_m = 2.4;    ///< of the packet
};

/// A cell on the arc behind the breakwaters: distances from the middle of the water and from their line.
struct Gauge {
  std::size_t cell;
  double along_m, behind_m;
};

std::vector<Gauge> arc() {
  std::vector<Gauge> out;
  for (int angle_deg = 10; angle_deg <= 170; angle_deg += 5) {
    const double along_m = Breakwaters::kRadius_m * std::cos(angle_deg * pi / 180);
    const double behind_m = Breakwaters::kRadius_m * std::sin(angle_deg * pi / 180);
    const auto z = static_cast<std::size_t>(Breakwaters::kSide / 2 + std::floor(along_m / Breakwaters::kCell_m));
    const auto x = static_cast<std::size_t>(Breakwaters::kLine + std::lround(behind_m / Breakwaters::kCell_m));
    out.push_back({x + Breakwaters::kSide * z,
                   (static_cast<double>(z) + 0.5 - Breakwaters::kSide / 2) * Breakwaters::kCell_m,
                   static_cast<double>(x - Breakwaters::kLine) * Breakwaters::kCell_m});
  }
  return out;
}

/// A breakwater one cell thick along the line, over the rows [first, last).
core::Breakwater breakwater(int first, int last) {
  const double half_m = Breakwaters::kSide * Breakwaters::kCell_m / 2;
  return {.x_m = (Breakwaters::kLine + 0.5) * Breakwaters::kCell_m - half_m,
          .z_m = 0.5 * (first + last) * Breakwaters::kCell_m - half_m,
          .length_m = (last - first - 0.1) * Breakwaters::kCell_m,
          .width_m = 0.9 * Breakwaters::kCell_m,
          .heading_deg = 90.0};
}

/// Amplitudes at the gauges and, last, at the line beside the middle row, of the packet's middle frequencies.
core::Result<std::vector<std::vector<std::complex<double>>>> passing(gpu::Context& ctx,
                                                                     const std::vector<core::Obstacle>& walls,
                                                                     const std::vector<Gauge>& gauges) {
  using B = Breakwaters;
  core::Scene scene = dispersiveScene(B::kSide, B::kCell_m, B::kDepth_m, WaveBoundary::kReflect, B::kRate_hz);
  scene.obstacles = walls;
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const AiryWater exact{scene.gravity_mps2, B::kDepth_m};
  const WavePacket packet(exact, 4 * scene.wave->side_m, B::kWavelength_m, B::kWidth_m);
  const double middle_m = B::kLine * B::kCell_m - 2.5 * B::kWidth_m;
  setPacket(**water, packet, 0.01, middle_m);
  std::vector<std::size_t> cells;
  for (const Gauge& gauge : gauges) cells.push_back(gauge.cell);
  cells.push_back(B::kLine + std::size_t{B::kSide} * (B::kSide / 2));
  const auto ticks = static_cast<int>((5 * B::kWidth_m + B::kRadius_m) / packet.groupSpeed_mps() * B::kRate_hz);
  const auto series = record(**water, ticks, cells);
  if (!series) return series.error();
  std::vector<std::vector<std::complex<double>>> out;
  for (const double omega : frequenciesOf(exact, 2 * pi / B::kWavelength_m, B::kWidth_m)) {
    out.emplace_back();
    for (const Series& each : *series) out.back().push_back(fourier(each, omega, 1.0 / B::kRate_hz));
  }
  return out;
}

}  // namespace

Outcome diffraction(gpu::Context& ctx, bool quick) {
  using B = Breakwaters;
  const std::vector<Gauge> gauges = arc();
  const AiryWater water{9.81, B::kDepth_m};
  const auto open = passing(ctx, {}, gauges);
  if (!open) return open.error();
  constexpr int kMiddle = B::kSide / 2;
  constexpr int kSideCells = static_cast<int>(B::kSide);
  struct Form {
    const char* name;
    double gap_m;  ///< 0: one breakwater, beside rows from the middle on
  };
  std::vector<Row> rows;
  std::vector<Figure> figures;
  for (const Form& form : {Form{"end of a breakwater", 0.0}, Form{"gap of 2.5 waves", 6.0}}) {
    if (quick && form.gap_m > 0) continue;
    const int half_gap = static_cast<int>(std::lround(form.gap_m / 2 / B::kCell_m));
    std::vector<core::Obstacle> walls{breakwater(kMiddle + half_gap, kSideCells)};
    if (form.gap_m > 0) walls.emplace_back(breakwater(0, kMiddle - half_gap));
    const auto found = passing(ctx, walls, gauges);
    if (!found) return found.error();
    double squares = 0.0, reference = 0.0;
    Figure::Curve measured_curve{"simulation", {}, true};
    Figure::Curve exact_curve{"theory", {}};
    const auto omegas = frequenciesOf(water, 2 * pi / B::kWavelength_m, B::kWidth_m);
    for (std::size_t g = 0; g < gauges.size(); ++g) {
      for (std::size_t f = 0; f < omegas.size(); ++f) {
        const double k_radpm = water.waveNumber_radpm(omegas[f]);
        const auto& [cell, along_m, behind_m] = gauges[g];
        const double measured = std::abs((*found)[f][g] / (*open)[f].back());
        const double expected = std::abs(form.gap_m > 0 ? behindGap(along_m, behind_m, form.gap_m, k_radpm)
                                                        : pastBreakwaterEnd(along_m, behind_m, k_radpm));
        squares += (measured - expected) * (measured - expected);
        reference += expected * expected;
        if (f != omegas.size() / 2) continue;
        const double angle_deg = std::atan2(behind_m, along_m) * 180 / pi;
        measured_curve.points.emplace_back(angle_deg, measured);
        exact_curve.points.emplace_back(angle_deg, expected);
      }
    }
    rows.push_back(
        {fmt::format("{}: amplitudes two waves behind, 10 to 170 degrees, root mean square error", form.name), "%",
         100 * std::sqrt(squares / reference), 10.0, Tolerance::kAtMost, 0.0,
         form.gap_m > 0 ? "Penney & Price 1952: two half planes" : "Sommerfeld's half plane"});
    figures.push_back({.name = form.gap_m > 0 ? "diffraction-gap" : "diffraction-end",
                       .title = fmt::format("Waves behind the {}", form.name),
                       .x_label = "angle from the breakwater [deg]",
                       .y_label = "amplitude over that of the incident wave [-]",
                       .curves = {std::move(exact_curve), std::move(measured_curve)}});
  }
  return CaseResult{std::move(rows), std::move(figures)};
}

}  // namespace spindrift::study
