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
  std::uint32_t side_count = 256;
  double tick_rate_hz = 60.0;
  std::uint32_t substeps_count = 1;  ///< 0: as a room runs it
};

/// Both surfaces at the end of a passage [m], n x n.
struct Wake {
  std::vector<double> measured_m, exact_m;
  HullState hull;  ///< at the end
  double cell_m = 0.0;
  std::size_t side_count = 0;
};

core::Result<Wake> sail(gpu::Context& ctx, const Passage& passage) {
  core::Scene scene = dispersiveScene(passage.side_count, passage.cell_m, passage.depth_m,
                                      core::WaveBoundary::kPeriodic, passage.tick_rate_hz);
  scene.wave->fixed_substeps_count = passage.substeps_count;
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
  LinearSea sea({scene.gravity_mps2, passage.depth_m}, passage.side_count, side_m);
  Wake wake;
  wake.cell_m = passage.cell_m;
  wake.side_count = passage.side_count;
  const auto ticks = static_cast<int>(passage.distance_m / (passage.speed_mps * dt_s));
  for (int k = 0; k < ticks; ++k) {
    auto state = tickAtSpeed(**water, passage.speed_mps);
    if (!state) return state.error();
    wake.hull = hullOf(*state, side_m);
    sea.advance(hullHead(wake.hull, passage.side_count, side_m), dt_s);
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
  for (std::size_t z = 0; z < wake.side_count; ++z) {
    for (std::size_t x = part.first; x < part.last; ++x) {
      const double a = wake.measured_m[x + wake.side_count * z];
      const double b = wake.exact_m[x + wake.side_count * z];
      mm += a * a, ee += b * b, me += a * b, m += a, e += b, count += 1;
    }
  }
  return (me - m * e / count) / std::sqrt((mm - m * m / count) * (ee - e * e / count));
}

/// Root mean square of the difference of the surfaces over that of the exact one.
double relativeDifference(const Wake& wake, Columns part) {
  double squares = 0.0, exact_squares = 0.0;
  for (std::size_t z = 0; z < wake.side_count; ++z) {
    for (std::size_t x = part.first; x < part.last; ++x) {
      const std::size_t i = x + wake.side_count * z;
      squares += std::pow(wake.measured_m[i] - wake.exact_m[i], 2);
      exact_squares += std::pow(wake.exact_m[i], 2);
    }
  }
  return std::sqrt(squares / exact_squares);
}

/// The waves on the track: height from trough to crest, and twice the mean distance of zero crossings.
struct TrackWaves {
  double height_m = 0.0;
  double length_m = 0.0;
};

TrackWaves onTrack(const Wake& wake, std::span<const double> surface_m, Columns part) {
  const auto row = static_cast<std::size_t>(wake.hull.z_m / wake.cell_m);
  const auto eta = surface_m.subspan(wake.side_count * row, wake.side_count);
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
/// boat, each with the outermost point where the waves reach 60 % of the largest off the track.
double ridgeAngle_deg(const Wake& wake, std::span<const double> surface_m, double nearest_m, double farthest_m,
                      double window_m) {
  double product = 0.0;
  double square = 0.0;
  for (int i = 0; nearest_m + 0.5 * i * window_m < farthest_m; ++i) {
    const double b_m = nearest_m + 0.5 * i * window_m;
    const Columns part = behind(wake, b_m - window_m / 2, b_m + window_m / 2);
    std::vector<double> envelope(wake.side_count);
    double largest = 0.0;
    const auto offTrack = [&](std::size_t z) {
      return std::abs((static_cast<double>(z) + 0.5) * wake.cell_m - wake.hull.z_m);
    };
    for (std::size_t z = 0; z < wake.side_count; ++z) {
      for (std::size_t x = part.first; x < part.last; ++x)
        envelope[z] = std::max(envelope[z], std::abs(surface_m[x + wake.side_count * z]));
      if (offTrack(z) > 0.1 * b_m) largest = std::max(largest, envelope[z]);
    }
    double ridge_m = 0.0;
    for (std::size_t z = 0; z < wake.side_count; ++z) {
      if (offTrack(z) > 0.1 * b_m && envelope[z] >= 0.6 * largest) ridge_m = std::max(ridge_m, offTrack(z));
    }
    product += b_m * ridge_m;
    square += b_m * b_m;
  }
  return std::atan(product / square) * 180 / pi;
}

}  // namespace

namespace {

/// Every other cell around the wake: what the simulation and the exact solution show.
FieldFigure pictureOf(const Wake& wake, const std::string& name, const std::string& title) {
  constexpr std::size_t kEvery = 2;
  const Columns part = behind(wake, -2.5, 18.0);
  const auto middle = static_cast<std::size_t>(wake.hull.z_m / wake.cell_m);
  const std::size_t half = wake.side_count / 4;
  FieldFigure out{.name = name,
                  .title = title,
                  .unit = "mm",
                  .cell_m = kEvery * wake.cell_m,
                  .first_x_m = static_cast<double>(part.first) * wake.cell_m,
                  .first_z_m = static_cast<double>(middle - half) * wake.cell_m,
                  .panels = {{"simulation", {}}, {"exact linear waves", {}}}};
  for (std::size_t z = middle - half; z < middle + half; z += kEvery) {
    for (std::size_t x = part.first; x < part.last; x += kEvery) {
      out.panels[0].values.push_back(1000 * wake.measured_m[x + wake.side_count * z]);
      out.panels[1].values.push_back(1000 * wake.exact_m[x + wake.side_count * z]);
    }
  }
  out.columns_count = out.panels[0].values.size() / ((2 * half) / kEvery);
  return out;
}

double rootMeanSquare(const Wake& wake, std::span<const double> surface_m, Columns part) {
  double sum = 0.0;
  for (std::size_t z = 0; z < wake.side_count; ++z) {
    for (std::size_t x = part.first; x < part.last; ++x)
      sum += surface_m[x + wake.side_count * z] * surface_m[x + wake.side_count * z];
  }
  return std::sqrt(sum / static_cast<double>(wake.side_count * (part.last - part.first)));
}

/// Half angle [deg] between the track and the crest of the wedge: least squares through its highest points, 2 to 5 m
/// to the side.
double wedgeAngle_deg(const Wake& wake, std::span<const double> surface_m) {
  double s = 0.0, b = 0.0, ss = 0.0, sb = 0.0, count = 0.0;
  const auto middle = static_cast<std::size_t>(wake.hull.z_m / wake.cell_m);
  const Columns part = behind(wake, -4.0, 8.0);
  for (auto side = static_cast<std::size_t>(2.0 / wake.cell_m); static_cast<double>(side) * wake.cell_m < 5.0; ++side) {
    const auto row = surface_m.subspan(wake.side_count * (middle + side), wake.side_count);
    const auto crest = std::ranges::max_element(row.subspan(part.first, part.last - part.first));
    const auto x =
        part.first + static_cast<std::size_t>(crest - row.subspan(part.first, part.last - part.first).begin());
    const double behind_m = wake.hull.x_m - (static_cast<double>(x) + 0.5) * wake.cell_m;
    const double side_m = static_cast<double>(side) * wake.cell_m;
    s += side_m, b += behind_m, ss += side_m * side_m, sb += side_m * behind_m, count += 1;
  }
  const double lag = (count * sb - s * b) / (count * ss - s * s);
  return std::atan2(1.0, lag) * 180 / pi;
}

constexpr const char* kSameLoad = "exact linear solution for the same pressure on the same track";

}  // namespace

Outcome kelvinWake(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  std::vector<FieldFigure> fields;
  for (const Passage& passage :
       {Passage{1.5, 2.0, 0.125, 1.0, 0.8, 6.0, 20.0}, Passage{2.2, 2.0, 0.125, 2.0, 0.8, 6.0, 20.0},
        Passage{3.0, 2.0, 0.17, 3.2, 1.2, 6.0, 31.0}}) {
    if (quick && passage.speed_mps != 2.2) continue;
    Passage sailed = passage;
    if (quick) sailed.distance_m = 15.0;
    auto wake = sail(ctx, sailed);
    if (!wake) return wake.error();
    const AiryWater water{9.81, passage.depth_m};
    const double length_m = 2 * pi / water.stationaryWaveNumber_radpm(passage.speed_mps);
    const Columns part = behind(*wake, 0.6 * length_m, std::min(2.7 * length_m, 15.0));
    const TrackWaves measured = onTrack(*wake, wake->measured_m, part);
    const TrackWaves exact = onTrack(*wake, wake->exact_m, part);
    const std::string name = fmt::format("{} m/s in {} m of water: ", passage.speed_mps, passage.depth_m);
    rows.push_back({name + "height of the waves behind the boat", "m", measured.height_m, exact.height_m,
                    Tolerance::kRelative, 0.02, kSameLoad});
    rows.push_back({name + "length of the waves behind the boat", "m", measured.length_m, exact.length_m,
                    Tolerance::kRelative, 0.03, kSameLoad});
    rows.push_back({name + "the same, of steady waves", "m", measured.length_m, length_m, Tolerance::kNone, 0.0,
                    "U^2 = (g/k) tanh(k d)"});
    rows.push_back({name + "correlation of the surfaces, 0.5 to 14 m behind", "",
                    correlation(*wake, behind(*wake, 0.5, 14.0)), 0.97, Tolerance::kAtLeast, 0.0, kSameLoad});
    const auto angle = [&](std::span<const double> surface_m) {
      return ridgeAngle_deg(*wake, surface_m, 1.5 * length_m, std::min(4.5 * length_m, 16.0), length_m);
    };
    rows.push_back({name + "half angle of the ridge", "deg", angle(wake->measured_m), angle(wake->exact_m),
                    Tolerance::kAbsolute, 2.0, std::string(kSameLoad) + "; 19.47 deg is the caustic of deep water"});
    if (passage.speed_mps == 2.2) {
      fields.push_back(pictureOf(*wake, "kelvin-wake",
                                 fmt::format("Wake at {} m/s in {} m of water", passage.speed_mps, passage.depth_m)));
    }
  }
  return CaseResult{std::move(rows), {}, std::move(fields)};
}

Outcome shallowWake(gpu::Context& ctx, bool quick) {
  constexpr double kDepth_m = 0.5;
  std::vector<Row> rows;
  for (const double froude : {0.7, 0.9, 1.0, 1.2}) {
    if (quick && froude != 1.2) continue;
    const double speed_mps = froude * std::sqrt(9.81 * kDepth_m);
    auto wake = sail(ctx, {speed_mps, kDepth_m, 0.125, 2.4, 0.9, 6.0, quick ? 9.0 : 20.0});
    if (!wake) return wake.error();
    const std::string name = fmt::format("{} of sqrt(g d), {} m of water: ", froude, kDepth_m);
    const Columns part = behind(*wake, -4.0, 10.0);
    rows.push_back({name + "correlation of the surfaces, 4 m ahead to 10 m behind", "", correlation(*wake, part), 0.97,
                    Tolerance::kAtLeast, 0.0, kSameLoad});
    rows.push_back({name + "root mean square of the elevation", "m", rootMeanSquare(*wake, wake->measured_m, part),
                    rootMeanSquare(*wake, wake->exact_m, part), Tolerance::kRelative, 0.02, kSameLoad});
    if (froude <= 1.0) continue;
    const double wedge_deg = std::asin(1 / froude) * 180 / pi;
    rows.push_back({name + "half angle of the wedge", "deg", wedgeAngle_deg(*wake, wake->measured_m),
                    wedgeAngle_deg(*wake, wake->exact_m), Tolerance::kAbsolute, 2.0, kSameLoad});
    rows.push_back({name + "the same", "deg", wedgeAngle_deg(*wake, wake->measured_m), wedge_deg, Tolerance::kNone, 0.0,
                    "arcsin(sqrt(g d)/U), of long waves"});
  }
  return CaseResult{std::move(rows), {}};
}

LevelError wakeError(gpu::Context& ctx, const LevelScale& level) {
  // The exact solution takes a power of two: the water is at least as wide as 15 m of track and the wake need.
  const std::uint32_t side_count = level.cells > 1 ? 512 : level.cells < 1 ? 128 : 256;
  const auto wake = sail(ctx, {.speed_mps = 2.2,
                               .depth_m = 2.0,
                               .cell_m = 0.125 / level.cells,
                               .length_m = 2.0,
                               .beam_m = 0.8,
                               .start_m = 6.0,
                               .distance_m = 15.0,
                               .side_count = side_count,
                               .tick_rate_hz = 60.0 * level.ticks,
                               .substeps_count = 0});
  if (!wake) return wake.error();
  return relativeDifference(*wake, behind(*wake, 0.5, 14.0));
}

}  // namespace spindrift::study
