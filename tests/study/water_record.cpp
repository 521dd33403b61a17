#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <numeric>

#include <time.h>

#include <spindrift/sim/water_sim.h>
#include <spindrift/study/water_record.h>

#include "shallow_water.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

/// Share of a dam's water that counts as ahead of its front.
constexpr double kAheadShare = 0.01;

/// Part of a cell that belongs to a cell of another number of cells over the same length.
struct Share {
  std::size_t from, to;
  double weight;
};

/// Averages n cells to m <= n cells, by the share of each cell in each of the m.
std::vector<Share> averages(std::size_t n, std::size_t m) {
  std::vector<Share> shares;
  const double ratio = static_cast<double>(m) / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double low = static_cast<double>(i) * ratio;
    const double high = low + ratio;
    for (auto k = static_cast<std::size_t>(low); k < m && static_cast<double>(k) < high - 1e-12; ++k) {
      const double overlap = std::min(high, static_cast<double>(k + 1)) - std::max(low, static_cast<double>(k));
      shares.push_back({i, k, overlap});
    }
  }
  return shares;
}

/// Interpolates n >= 2 cells linearly between the centres of m > n.
std::vector<Share> interpolations(std::size_t n, std::size_t m) {
  std::vector<Share> shares;
  for (std::size_t k = 0; k < m; ++k) {
    const double u = (static_cast<double>(k) + 0.5) * static_cast<double>(n) / static_cast<double>(m) - 0.5;
    const double at = std::clamp(u, 0.0, static_cast<double>(n - 1));
    const auto low = std::min(static_cast<std::size_t>(at), n - 2);
    const double share = at - static_cast<double>(low);
    shares.push_back({low, k, 1 - share});
    shares.push_back({low + 1, k, share});
  }
  return shares;
}

/// A field on nx x nz cells, on mx x mz cells over the same area; x fastest.
std::vector<double> resampled(const std::vector<double>& field, std::size_t nx, std::size_t nz, std::size_t mx,
                              std::size_t mz) {
  const std::vector<Share> across_x = (nx >= mx ? averages : interpolations)(nx, mx);
  const std::vector<Share> across_z = (nz >= mz ? averages : interpolations)(nz, mz);
  std::vector<double> along_x(mx * nz, 0.0);
  for (std::size_t z = 0; z < nz; ++z)
    for (const Share& s : across_x) along_x[s.to + mx * z] += s.weight * field[s.from + nx * z];
  std::vector<double> out(mx * mz, 0.0);
  for (const Share& s : across_z)
    for (std::size_t x = 0; x < mx; ++x) out[x + mx * s.to] += s.weight * along_x[x + mx * s.from];
  return out;
}

/// Volume of the particles per ground area of columns, over the mean. Each particle is shared among the four nearest
/// columns: a band on a wave is thinner when it has more particles.
std::vector<double> columns(const sim::WaterSim& water, const sim::StateCopy& state) {
  const sim::ParticleLayout& l = *water.derived().particles;
  const double side_x_m = l.max_m[0] - l.min_m[0];
  const double side_z_m = l.max_m[2] - l.min_m[2];
  const std::size_t nx = kColumnsAlong;
  const auto nz = static_cast<std::size_t>(std::max(std::lround(nx * side_z_m / side_x_m), 1L));
  const std::size_t count = std::min<std::size_t>(water.particleCount(), state.position.size() / 4);
  const double share = static_cast<double>(nx * nz) / static_cast<double>(count);
  std::vector<double> out(nx * nz, 0.0);
  const auto spread = [](double at, std::size_t n) {
    const double u = std::clamp(at * static_cast<double>(n) - 0.5, 0.0, static_cast<double>(n - 1));
    const auto low = std::min(static_cast<std::size_t>(u), n >= 2 ? n - 2 : 0);
    return std::pair{low, n >= 2 ? u - static_cast<double>(low) : 0.0};
  };
  for (std::size_t i = 0; i < count; ++i) {
    const auto [x, tx] = spread((state.position[4 * i] - l.min_m[0]) / side_x_m, nx);
    const auto [z, tz] = spread((state.position[4 * i + 2] - l.min_m[2]) / side_z_m, nz);
    for (const std::size_t dz : {0u, 1u}) {
      for (const std::size_t dx : {0u, 1u}) {
        const double weight = (dx != 0 ? tx : 1 - tx) * (dz != 0 ? tz : 1 - tz);
        if (weight > 0) out[x + dx + nx * (z + dz)] += weight * share;
      }
    }
  }
  return out;
}

double frontOf(const sim::WaterSim& water, const sim::StateCopy& state) {
  std::vector<float> x_m;
  for (std::size_t i = 0; i < state.position.size(); i += 4) x_m.push_back(state.position[i]);
  const auto ahead = std::max<std::ptrdiff_t>(std::lround(kAheadShare * static_cast<double>(x_m.size())), 1);
  std::nth_element(x_m.begin(), x_m.end() - ahead, x_m.end());
  return *(x_m.end() - ahead) - water.derived().particles->min_m[0];
}

double densityError(const sim::WaterSim& water, const sim::StateCopy& state) {
  const std::size_t count = std::min<std::size_t>(water.particleCount(), state.density_kgpm3.size());
  if (count == 0) return 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double error = std::max(state.density_kgpm3[i] / water.scene().particles->rest_density_kgpm3 - 1.0, 0.0);
    squares += error * error;
  }
  return std::sqrt(squares / static_cast<double>(count));
}

/// Energy at given times, from health that arrives some ticks late.
class EnergySeries {
 public:
  void add(const sim::WaterSim& water) {
    const sim::Health& h = water.health();
    if (!points_.empty() && points_.back().tick == h.tick) return;
    // In a one-way scene the mass of the band depends on the number of particles, so only the wave's energy counts.
    const bool carries_band = water.scene().coupling && water.scene().coupling->mode == core::CouplingMode::kOneWay;
    points_.push_back({h.tick, h.wave_energy_j + (carries_band ? 0.0 : h.kinetic_energy_j + h.potential_energy_j)});
  }
  [[nodiscard]] double at(std::uint64_t tick) const {
    const auto next = std::ranges::lower_bound(points_, tick, {}, &Point::tick);
    return next != points_.end() ? next->energy_j : points_.empty() ? 0.0 : points_.back().energy_j;
  }

 private:
  struct Point {
    std::uint64_t tick;
    double energy_j;
  };
  std::vector<Point> points_;
};

WaterRecord::Sample sampleOf(sim::WaterSim& water) {
  WaterRecord::Sample sample;
  const core::Scene& scene = water.scene();
  const sim::StateCopy state = water.copyState();
  if (scene.wave) {
    const sim::WaveLayout& layout = *water.derived().wave;
    std::vector<double> elevation_m = state.elevation_m;
    // The elevation of dry land is that of the ground: only the water on it counts.
    if (scene.wave->bulk == core::Bulk::kNonlinear) {
      const std::vector<double> depth_m = groundDepths(scene, layout);
      for (std::size_t i = 0; i < depth_m.size(); ++i) elevation_m[i] += std::min(depth_m[i], 0.0);
    }
    // As in the stream: whole quanta.
    const double quantum_m = scene.stream.surface_quantum_m;
    for (double& eta_m : elevation_m) eta_m = std::round(eta_m / quantum_m) * quantum_m;
    const double rows = std::round(kSurfaceCells * layout.width_m / layout.length_m);
    sample.surface_m = resampled(elevation_m, layout.count_x, layout.count_z, kSurfaceCells,
                                 static_cast<std::size_t>(std::max(rows, 1.0)));
  }
  if (!scene.particles) return sample;
  sample.density_rms_ratio = densityError(water, state);
  if (scene.coupling && scene.coupling->mode == core::CouplingMode::kTwoWay)
    return sample;  // the position of spray is random
  sample.column_m = columns(water, state);
  if (scene.particles->fill_x_ratio < 1) sample.front_m = frontOf(water, state);
  return sample;
}

/// Power of the surface in rings of wave numbers.
std::vector<double> spectrum(const std::vector<double>& field, std::size_t n) {
  using Complex = std::complex<double>;
  std::vector<Complex> turn(n);
  for (std::size_t i = 0; i < n; ++i)
    turn[i] = std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
  const std::size_t half = n / 2;
  std::vector<Complex> rows(half * n);
  for (std::size_t z = 0; z < n; ++z)
    for (std::size_t k = 0; k < half; ++k)
      for (std::size_t x = 0; x < n; ++x) rows[k + half * z] += field[x + n * z] * turn[k * x % n];
  std::vector<double> rings(half, 0.0);
  for (std::size_t k = 0; k < half; ++k) {
    for (std::size_t l = 0; l < n; ++l) {
      Complex sum = 0.0;
      for (std::size_t z = 0; z < n; ++z) sum += rows[k + half * z] * turn[l * z % n];
      const double across = static_cast<double>(std::min(l, n - l));
      const auto ring = static_cast<std::size_t>(std::lround(std::hypot(static_cast<double>(k), across)));
      if (ring > 0 && ring < half) rings[ring] += std::norm(sum);
    }
  }
  return rings;
}

/// Mean square and largest difference of fields over samples, and the mean square of the reference.
struct FieldDifference {
  double squares = 0.0;
  double reference_squares = 0.0;
  double largest = 0.0;

  void add(const std::vector<double>& a, const std::vector<double>& reference) {
    for (std::size_t i = 0; i < std::min(a.size(), reference.size()); ++i) {
      const double d = a[i] - reference[i];
      squares += d * d;
      reference_squares += reference[i] * reference[i];
      largest = std::max(largest, std::abs(d));
    }
    count_ += reference.size();
  }
  [[nodiscard]] double rmsRatio() const { return std::sqrt(squares / reference_squares); }
  [[nodiscard]] double maxRatio() const { return largest / std::sqrt(reference_squares / static_cast<double>(count_)); }

 private:
  std::size_t count_ = 0;
};

constexpr int kTimedRuns = 3;

/// Cost of the intervals of a run, without the time between them: on a rasteriser in software the processor time of all
/// threads, which other programs hardly change, otherwise wall time. [s]
class IntervalTimes {
 public:
  explicit IntervalTimes(const gpu::Context& ctx) : is_software_(ctx.device().is_software) {}
  void begin() { begin_s_ = now_s(); }
  void end() { seconds_.push_back(now_s() - begin_s_); }
  [[nodiscard]] double sum() const { return std::accumulate(seconds_.begin(), seconds_.end(), 0.0); }
  /// Keeps the shorter time of each interval.
  void keepFastest(const IntervalTimes& other) {
    for (std::size_t i = 0; i < std::min(seconds_.size(), other.seconds_.size()); ++i)
      seconds_[i] = std::min(seconds_[i], other.seconds_[i]);
  }

 private:
  [[nodiscard]] double now_s() const {
    if (is_software_) {
      timespec spent{};
      clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &spent);
      return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  bool is_software_;
  double begin_s_ = 0.0;
  std::vector<double> seconds_;
};

/// Advances to `time_s` as one interval.
template <typename EachTick>
core::Result<void> advance(gpu::Context& ctx, sim::WaterSim& water, double time_s, IntervalTimes& times,
                           EachTick each_tick) {
  times.begin();
  if (auto done = runTo(water, time_s, each_tick); !done) return done;
  ctx.finish();
  times.end();
  return {};
}

/// Returns the scene after its first tick, because some drivers compile shaders then.
core::Result<std::unique_ptr<sim::WaterSim>> warm(gpu::Context& ctx, const core::Scene& scene) {
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  if (auto done = tick(**water); !done) return done.error();
  ctx.finish();
  (void)(*water)->takePassCosts();
  return water;
}

}  // namespace

core::Result<std::uint64_t> stateHashAfter(gpu::Context& ctx, const core::Scene& scene, int tick_count) {
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  if (auto done = run(**water, tick_count); !done) return done.error();
  return (*water)->stateHash();
}

core::Result<WaterRecord> record(gpu::Context& ctx, const core::Scene& scene, const RecordOptions& options) {
  auto made = warm(ctx, scene);
  if (!made) return made.error();
  sim::WaterSim& water = **made;
  const sim::Derived& d = water.derived();
  WaterRecord out;
  out.device_bytes = d.device_bytes;
  out.substeps_per_s_count = static_cast<std::uint32_t>(std::lround(d.substeps_count / d.tick_s));
  if (d.particles) out.particle_count = d.particles->count;
  if (d.wave) out.wave_cells_count = static_cast<std::uint32_t>(d.wave->counts().total());

  EnergySeries energy;
  std::vector<std::uint64_t> sample_ticks;
  double frame_bytes = 0.0;
  std::size_t frame_count = 0;
  IntervalTimes times(ctx);
  const double begin_s = water.time_s();
  const auto interval_count = static_cast<int>(std::lround(options.seconds / options.sample_interval_s));
  for (int i = 1; i <= interval_count; ++i) {
    const double time_s = i * options.sample_interval_s;
    if (auto done = advance(ctx, water, time_s, times, [&] { energy.add(water); }); !done) return done.error();
    if (!options.has_samples) continue;
    sample_ticks.push_back(water.tick());
    out.samples.push_back(sampleOf(water));
    if (!options.frame_bytes) continue;
    (void)water.requestFrame(sim::FrameRequest::allLayers());
    ctx.finish();
    for (const core::FrameView& frame : water.takeFrames()) {
      frame_bytes += static_cast<double>(options.frame_bytes(frame));
      ++frame_count;
    }
  }
  for (std::size_t i = 0; i < out.samples.size(); ++i) out.samples[i].energy_j = energy.at(sample_ticks[i]);
  out.seconds = water.time_s() - begin_s;
  out.passes = water.takePassCosts();
  out.frame_bytes = frame_count > 0 ? frame_bytes / static_cast<double>(frame_count) : 0.0;
  out.recovered_count = water.recoveredCount();

  const double once_s = times.sum();
  for (int run = 1; run < kTimedRuns && once_s < options.repeat_below_s; ++run) {
    auto again = warm(ctx, scene);
    if (!again) return again.error();
    IntervalTimes again_times(ctx);
    for (int i = 1; i <= interval_count; ++i) {
      const double time_s = i * options.sample_interval_s;
      if (auto done = advance(ctx, **again, time_s, again_times, [] {}); !done) return done.error();
    }
    times.keepFastest(again_times);
  }
  out.cost_ms_per_s = 1e3 * times.sum() / out.seconds;
  for (gpu::PassCost& pass : out.passes) pass.total_ms *= times.sum() / once_s;
  return out;
}

RecordErrors compare(const WaterRecord& run, const WaterRecord& reference, const core::Scene& scene) {
  FieldDifference surface, column, front, energy;
  std::vector<double> power(kSurfaceCells / 2, 0.0), reference_power(kSurfaceCells / 2, 0.0);
  double density = 0.0;
  double largest_energy_j = 0.0;
  const std::size_t count = std::min(run.samples.size(), reference.samples.size());
  for (std::size_t i = 0; i < count; ++i) {
    const WaterRecord::Sample& a = run.samples[i];
    const WaterRecord::Sample& b = reference.samples[i];
    surface.add(a.surface_m, b.surface_m);
    column.add(a.column_m, b.column_m);
    if (a.front_m && b.front_m) front.add({*a.front_m}, {*b.front_m});
    energy.add({a.energy_j}, {b.energy_j});
    largest_energy_j = std::max(largest_energy_j, std::abs(b.energy_j));
    density += a.density_rms_ratio * a.density_rms_ratio;
    constexpr std::size_t kSquare = kSurfaceCells * kSurfaceCells;
    if (a.surface_m.size() != kSquare || b.surface_m.size() != kSquare) continue;
    const std::vector<double> p = spectrum(a.surface_m, kSurfaceCells);
    const std::vector<double> q = spectrum(b.surface_m, kSurfaceCells);
    for (std::size_t k = 0; k < p.size(); ++k) {
      power[k] += p[k];
      reference_power[k] += q[k];
    }
  }
  RecordErrors out;
  if (scene.wave) {
    out.surface_rms_ratio = surface.rmsRatio();
    out.surface_max_ratio = surface.maxRatio();
    double difference = 0.0;
    double sum = 0.0;
    for (std::size_t k = 0; k < power.size(); ++k) {
      difference += std::abs(power[k] - reference_power[k]);
      sum += reference_power[k];
    }
    if (sum > 0) out.spectrum_ratio = difference / sum;
    out.height_rms_ratio = *out.surface_rms_ratio;
  }
  if (column.reference_squares > 0) {
    out.column_rms_ratio = column.rmsRatio();
    out.height_rms_ratio =
        scene.wave ? std::sqrt((std::pow(*out.surface_rms_ratio, 2) + std::pow(*out.column_rms_ratio, 2)) / 2)
                   : *out.column_rms_ratio;
  }
  if (front.reference_squares > 0) out.front_rms_ratio = front.rmsRatio();
  if (scene.particles && count > 0) out.density_rms_ratio = std::sqrt(density / static_cast<double>(count));
  if (largest_energy_j > 0 && count > 0)
    out.energy_rms_ratio = std::sqrt(energy.squares / static_cast<double>(count)) / largest_energy_j;
  return out;
}

std::vector<bool> paretoFront(const std::vector<CostAndError>& points, const CostAndError& chance) {
  std::vector<bool> front;
  front.reserve(points.size());
  for (const CostAndError& p : points) {
    front.push_back(std::ranges::none_of(points, [&](const CostAndError& q) {
      return q.cost <= p.cost && q.error <= p.error &&
             (q.cost < (1 - chance.cost) * p.cost || q.error < (1 - chance.error) * p.error);
    }));
  }
  return front;
}

}  // namespace spindrift::study
