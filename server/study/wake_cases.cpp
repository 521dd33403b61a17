// Wakes of boats beside the exact linear solution for the same pressure on the recorded track.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "boat_track.h"
#include "cases.h"
#include "exact_linear_waves.h"
#include "ticks.h"
#include "wave_modes.h"

namespace spindrift::study {
namespace {

using std::numbers::pi;

/// A boat that travels along +x through the middle of a square with periodic sides.
struct Passage {
  double speed_mps;
  double depth_m;
  double cell_m;
  double length_m, beam_m;
  double start_m, distance_m;  ///< from the side at -x
  double most_height_percent = 2.0;
};

constexpr std::uint32_t kSide = 256;

/// Both surfaces at the end of a passage [m], n x n.
struct Wake {
  std::vector<double> measured_m, exact_m;
  HullState hull;  ///< at the end
  double cell_m = 0.0;
};

core::Result<Wake> sail(gpu::Context& ctx, const Passage& passage) {
  core::Scene scene = dispersiveScene(kSide, passage.cell_m, passage.depth_m, core::WaveBoundary::kPeriodic);
  const double side_m = scene.wave->side_m;
  scene.boats.emplace();
  scene.boats->boats = {core::Boat{.x_m = passage.start_m - side_m / 2,
                                   .length_m = passage.length_m,
                                   .beam_m = passage.beam_m,
                                   .height_m = 0.3,
                                   .density_ratio = 0.1,
                                   .max_speed_mps = passage.speed_mps,
                                   .throttle_ratio = 1.0}};
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const double dt_s = (*water)->derived().tick_s;
  LinearSea sea({scene.gravity_mps2, passage.depth_m}, kSide, side_m);
  Wake wake;
  wake.cell_m = passage.cell_m;
  const auto ticks = static_cast<int>(passage.distance_m / (passage.speed_mps * dt_s));
  for (int k = 0; k < ticks; ++k) {
    auto state = tickAtSpeed(**water, passage.speed_mps);
    if (!state) return state.error();
    wake.hull = hullOf(*state, side_m);
    sea.advance(hullHead(wake.hull, kSide, side_m), dt_s);
    wake.measured_m = std::move(state->elevation_m);
  }
  wake.exact_m = sea.surface();
  return wake;
}

/// Part of a wake, behind the boat: cells of the columns [first, last).
struct Columns {
  std::size_t first, last;
};

Columns behind(const Wake& wake, double nearest_m, double farthest_m) {
  const auto column = [&](double x_m) { return static_cast<std::size_t>(std::max(x_m / wake.cell_m, 0.0)); };
  return {column(wake.hull.x_m - farthest_m), column(wake.hull.x_m - nearest_m)};
}

double correlation(const Wake& wake, Columns part) {
  double mm = 0.0, ee = 0.0, me = 0.0, m = 0.0, e = 0.0, count = 0.0;
  for (std::size_t z = 0; z < kSide; ++z) {
    for (std::size_t x = part.first; x < part.last; ++x) {
      const double a = wake.measured_m[x + kSide * z];
      const double b = wake.exact_m[x + kSide * z];
      mm += a * a, ee += b * b, me += a * b, m += a, e += b, count += 1;
    }
  }
  return (me - m * e / count) / std::sqrt((mm - m * m / count) * (ee - e * e / count));
}

/// The waves on the track: height from trough to crest, and twice the mean distance of zero crossings.
struct TrackWaves {
  double height_m = 0.0;
  double length_m = 0.0;
};

TrackWaves onTrack(const Wake& wake, std::span<const double> surface_m, Columns part) {
  const auto row = static_cast<std::size_t>(wake.hull.z_m / wake.cell_m);
  const auto eta = surface_m.subspan(kSide * row, kSide);
  const auto [low, high] = std::ranges::minmax(eta.subspan(part.first, part.last - part.first));
  std::vector<double> crossings;
  for (std::size_t x = part.first; x + 1 < part.last; ++x) {
    if (eta[x] * eta[x + 1] < 0)
      crossings.push_back((static_cast<double>(x) + eta[x] / (eta[x] - eta[x + 1])) * wake.cell_m);
  }
  TrackWaves out{.height_m = high - low};
  if (crossings.size() > 1)
    out.length_m = 2 * (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  return out;
}

/// Half angle [deg] of the line through the boat on which the outer ridge lies: least squares over windows behind the
/// boat, each with the outermost place where the waves reach 60 % of the largest off the track.
double ridgeAngle_deg(const Wake& wake, std::span<const double> surface_m, double nearest_m, double farthest_m,
                      double window_m) {
  double product = 0.0;
  double square = 0.0;
  for (double b_m = nearest_m; b_m < farthest_m; b_m += window_m / 2) {
    const Columns part = behind(wake, b_m - window_m / 2, b_m + window_m / 2);
    std::vector<double> envelope(kSide);
    double largest = 0.0;
    const auto offTrack = [&](std::size_t z) {
      return std::abs((static_cast<double>(z) + 0.5) * wake.cell_m - wake.hull.z_m);
    };
    for (std::size_t z = 0; z < kSide; ++z) {
      for (std::size_t x = part.first; x < part.last; ++x)
        envelope[z] = std::max(envelope[z], std::abs(surface_m[x + kSide * z]));
      if (offTrack(z) > 0.1 * b_m) largest = std::max(largest, envelope[z]);
    }
    double ridge_m = 0.0;
    for (std::size_t z = 0; z < kSide; ++z) {
      if (offTrack(z) > 0.1 * b_m && envelope[z] >= 0.6 * largest) ridge_m = std::max(ridge_m, offTrack(z));
    }
    product += b_m * ridge_m;
    square += b_m * b_m;
  }
  return std::atan(product / square) * 180 / pi;
}

}  // namespace

Outcome kelvinWake(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const Passage& passage :
       {Passage{1.5, 2.0, 0.125, 1.0, 0.5, 6.0, 20.0, 5.0}, Passage{2.2, 2.0, 0.125, 2.0, 0.8, 6.0, 20.0, 3.5},
        Passage{3.0, 2.0, 0.17, 3.2, 1.2, 6.0, 31.0}}) {
    if (quick && passage.speed_mps != 2.2) continue;
    auto wake = sail(ctx, passage);
    if (!wake) return wake.error();
    const AiryWater water{9.81, passage.depth_m};
    const double length_m = 2 * pi / water.stationaryWaveNumber_radpm(passage.speed_mps);
    const Columns part = behind(*wake, 0.6 * length_m, std::min(2.7 * length_m, 15.0));
    const TrackWaves measured = onTrack(*wake, wake->measured_m, part);
    const TrackWaves exact = onTrack(*wake, wake->exact_m, part);
    const std::string name = fmt::format("{} m/s in {} m of water: ", passage.speed_mps, passage.depth_m);
    const std::string source = "exact linear solution for the same pressure on the same track";
    rows.push_back({name + "height of the waves behind the boat", "m", measured.height_m, exact.height_m,
                    Tolerance::kRelative, passage.most_height_percent / 100, source});
    rows.push_back({name + "length of the waves behind the boat", "m", measured.length_m, exact.length_m,
                    Tolerance::kRelative, 0.03, source});
    rows.push_back({name + "the same, of steady waves", "m", measured.length_m, length_m, Tolerance::kNone, 0.0,
                    "U^2 = (g/k) tanh(k d)"});
    rows.push_back({name + "correlation of the surfaces, 0.5 to 14 m behind", "",
                    correlation(*wake, behind(*wake, 0.5, 14.0)), 0.97, Tolerance::kAtLeast, 0.0, source});
    const auto angle = [&](std::span<const double> surface_m) {
      return ridgeAngle_deg(*wake, surface_m, 1.5 * length_m, std::min(4.5 * length_m, 16.0), length_m);
    };
    rows.push_back({name + "half angle of the ridge", "deg", angle(wake->measured_m), angle(wake->exact_m),
                    Tolerance::kAbsolute, 2.0, source + "; 19.47 deg is the caustic of deep water"});
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
