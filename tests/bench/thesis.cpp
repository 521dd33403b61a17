#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include <boost/json.hpp>
#include <fmt/format.h>
#include <shared/bindings.h>

#include <spindrift/bench/crowd.h>
#include <spindrift/bench/thesis.h>
#include <spindrift/sim/water_sim.h>
#include <spindrift/sim_setup/scene_parts.h>

#include "neighbor_grid.h"
#include "neighbours.h"
#include "shader_defines.h"
#include "solvers.h"
#include "thesis_particles.h"

namespace spindrift::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kStart_s = 1.25;
constexpr std::size_t kPairsMinCount = 5;
constexpr std::uint32_t kParticlesPerBlock = 65536;  ///< particles times substeps, so that blocks take equally long

core::Result<void> check(const core::Scene& scene) {
  const auto refuse = [&](const char* what) {
    return core::invalid("scene " + scene.name + ": " + what + "; name another one by --scene, for example pool");
  };
  if (!scene.particles || sim::isTwoWay(scene)) return refuse("has no fixed number of particles");
  if (scene.particles->solver != core::PressureSolver::kWeaklyCompressible)
    return refuse("moves particles by positions, but the thesis by pressure");
  if (scene.wave && sim::isVaried(scene)) return refuse("has a bed, obstacles or open sides, which the thesis had not");
  if (sim::hasTension(scene)) return refuse("has surface tension, which the thesis had not");
  if (scene.particles->periodic_y) return refuse("is periodic in y, but the thesis is not");
  return {};
}

/// The surface of the water with its slopes, at rest.
std::vector<WaveTexel> texelsOf(const std::vector<double>& elevation_m, const sim::WaveLayout& wave) {
  const auto at = [&](std::uint32_t x, std::uint32_t z) {
    return elevation_m[x % wave.count_x + std::size_t{wave.count_x} * (z % wave.count_z)];
  };
  std::vector<WaveTexel> out;
  for (std::uint32_t z = 0; z < wave.count_z; ++z) {
    for (std::uint32_t x = 0; x < wave.count_x; ++x) {
      const double slope_x = (at(x + 1, z) - at(x + wave.count_x - 1, z)) / (2 * wave.cell_m);
      const double slope_z = (at(x, z + 1) - at(x, z + wave.count_z - 1)) / (2 * wave.cell_m);
      out.push_back({static_cast<float>(at(x, z)), 0.0F, static_cast<float>(slope_x), static_cast<float>(slope_z)});
    }
  }
  return out;
}

}  // namespace

struct ThesisComparison::State {
  State(gpu::Context& context, const core::Scene& scene, const sim::Derived& derived)
      : ctx(context),
        create(context, sim::shaderDefines(scene)),
        uniforms(create.uniforms<shared::SimUniforms>("uniforms")),
        particles(create, derived.particles->count, false, false),
        grid(create, *derived.particles),
        sph(create),
        population(derived.particles->count, nullptr),
        box(countedBox(scene, derived)),
        spacing_m(derived.particles->spacing_m) {
    if (!create.error()) uniforms.uploadValue(derived.uniforms);
  }

  gpu::Context& ctx;
  sim::Creation create;
  gpu::Buffer uniforms;
  sim::ParticleBuffers particles;
  sim::NeighborGrid grid;
  sim::Sph sph;
  sim::Population population;
  CountedBox box;
  double spacing_m;
  gpu::TexelBuffer surface{}, flow{};
  std::vector<float> position{}, velocity{};
  std::unique_ptr<ThesisParticles> thesis{};
};

ThesisComparison::ThesisComparison(std::unique_ptr<State> state) : state_(std::move(state)) {}
ThesisComparison::~ThesisComparison() = default;

core::Result<std::unique_ptr<ThesisComparison>> ThesisComparison::create(gpu::Context& ctx, const core::Scene& scene,
                                                                         std::uint32_t particle_count) {
  core::Scene plain = scene;
  plain.boats.reset();
  plain.floaters.reset();
  plain.storm.reset();
  plain.foam.reset();
  if (auto fits = check(plain); !fits) return fits.error();
  if (sim::followNumber(plain) != 0)
    return core::invalid("scene " + scene.name + ": its patch of particles moves; name another one, for example pool");
  plain.particles->count = particle_count;
  auto water = sim::WaterSim::create(ctx, plain);
  if (!water) return water.error();
  const sim::Derived derived = (*water)->derived();
  while ((*water)->time_s() < kStart_s) (*water)->step();
  sim::StateCopy start = (*water)->copyState();
  water->reset();

  auto state = std::make_unique<State>(ctx, plain, derived);
  std::vector<WaveTexel> wave;
  if (plain.coupling) {
    wave = texelsOf(start.elevation_m, *derived.wave);
    state->surface = state->create.texels("surface", wave.size(), gpu::TexelFormat::kRGBA32F);
    state->flow = state->create.texels("surface flow", wave.size(), gpu::TexelFormat::kRG32F);
  }
  if (state->create.error()) return *state->create.error();
  if (state->surface) state->surface.upload(wave);
  auto thesis = ThesisParticles::create(ctx, sim::shaderDefines(plain), derived.particles->count,
                                        derived.wave ? derived.wave->counts() : core::CellCounts{},
                                        std::span(std::as_const(wave)));
  if (!thesis) return thesis.error();
  state->thesis = *std::move(thesis);
  state->position = std::move(start.position);
  state->velocity = std::move(start.velocity);
  for (std::size_t i = 0; i < state->position.size() / 4; ++i) state->position[4 * i + 3] = static_cast<float>(i);
  return std::unique_ptr<ThesisComparison>(new ThesisComparison(std::move(state)));
}

std::uint32_t ThesisComparison::particleCount() const {
  return static_cast<std::uint32_t>(state_->position.size() / 4);
}

double ThesisComparison::meanNeighbours() const {
  return bench::meanNeighbours(state_->position, state_->box);
}

void ThesisComparison::restart() {
  State& s = *state_;
  s.uniforms.bindUniform(SIM_UNIFORMS);
  s.particles.position.upload(s.position);
  s.particles.velocity.upload(s.velocity);
  s.thesis->setState(s.position, s.velocity);
}

void ThesisComparison::stepOurs() {
  State& s = *state_;
  s.grid.build(s.particles, s.population);
  if (s.surface) {
    s.surface.bindTexel(SURFACE);
    s.flow.bindTexel(SURFACE_FLOW);
  }
  s.sph.density(s.particles, s.population);
  s.sph.forces(s.particles, s.population);
  s.sph.integrate(s.particles, s.population);
}

void ThesisComparison::stepThesis() {
  state_->thesis->step();
}

ThesisDifference ThesisComparison::difference() {
  restart();
  stepOurs();
  stepThesis();
  return differenceNow();
}

ThesisDifference ThesisComparison::differenceNow() const {
  const State& s = *state_;
  s.ctx.barrier(gpu::Barrier::kBufferUpdate);
  const auto position = s.particles.position.downloadVector<float>(s.position.size());
  const auto acceleration = s.particles.acceleration.downloadVector<float>(s.position.size());
  const auto theirs = s.thesis->download();
  ThesisDifference out;
  double density_max = 0.0;
  double acceleration_max = 0.0;
  // A number that is not finite makes a difference that is not, and that is within no tolerance.
  const auto raise = [](double& most, double value) {
    if (!(value <= most)) most = value;
  };
  for (std::size_t at = 0; at < theirs.size(); ++at) {
    const ThesisParticles::Particle& their = theirs[static_cast<std::size_t>(position[4 * at + 3])];
    double squares = 0.0;
    double own_squares = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      squares += std::pow(double{acceleration[4 * at + axis]} - their.acceleration_mps2[axis], 2);
      own_squares += std::pow(double{acceleration[4 * at + axis]}, 2);
      raise(out.position, std::abs(double{position[4 * at + axis]} - their.position_m[axis]) / s.spacing_m);
    }
    raise(out.acceleration, std::sqrt(squares));
    raise(acceleration_max, std::sqrt(own_squares));
    raise(out.density, std::abs(double{acceleration[4 * at + 3]} - their.density_kgpm3));
    raise(density_max, acceleration[4 * at + 3]);
  }
  out.density /= density_max;
  out.acceleration /= acceleration_max;
  return out;
}

namespace {

/// Per substep [ms].
struct Times {
  double cpu_ms = 0.0;
  double wall_ms = 0.0;
};

Times timed(gpu::Context& ctx, ThesisComparison& both, std::uint32_t substeps, void (ThesisComparison::*step)()) {
  both.restart();
  ctx.finish();
  const auto begin = Clock::now();
  const std::clock_t cpu_begin = std::clock();
  for (std::uint32_t k = 0; k < substeps; ++k) (both.*step)();
  ctx.finish();
  return {1e3 * static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC / substeps,
          std::chrono::duration<double, std::milli>(Clock::now() - begin).count() / substeps};
}

/// Prints and returns what the pairs of one kind of time say.
boost::json::object row(std::FILE* out, const std::string& name, const std::vector<double>& ours_ms,
                        const std::vector<double>& thesis_ms) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < ours_ms.size(); ++k) ratios.push_back(thesis_ms[k] / ours_ms[k]);
  const auto quantile = [](std::vector<double> values, double share) {
    std::ranges::sort(values);
    return quantileOf(values, share);
  };
  boost::json::object json{{"pairs", ours_ms.size()},
                           {"ours_median_ms", quantile(ours_ms, 0.5)},
                           {"ours_least_ms", quantile(ours_ms, 0.0)},
                           {"thesis_median_ms", quantile(thesis_ms, 0.5)},
                           {"thesis_least_ms", quantile(thesis_ms, 0.0)},
                           {"ratio_median", quantile(ratios, 0.5)},
                           {"ratio_of_least", quantile(thesis_ms, 0.0) / quantile(ours_ms, 0.0)},
                           {"ratio_quarter", quantile(ratios, 0.25)},
                           {"ratio_three_quarters", quantile(ratios, 0.75)}};
  const auto at = [&](const char* key) { return json[key].as_double(); };
  fmt::print(out, "{:<32} {:>5} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>7.2f} {:>7.2f}   {:.2f} to {:.2f}\n", name,
             ours_ms.size(), at("ours_median_ms"), at("ours_least_ms"), at("thesis_median_ms"), at("thesis_least_ms"),
             at("ratio_median"), at("ratio_of_least"), at("ratio_quarter"), at("ratio_three_quarters"));
  return json;
}

}  // namespace

core::Result<boost::json::array> measureThesis(gpu::Context& ctx, const core::Scene& scene, double seconds,
                                               std::FILE* out) {
  fmt::print(out, "substeps of particles, ours and in the structure of the thesis, in turn; ms per substep\n");
  fmt::print(out, "{:<32} {:>5} {:>17} {:>17} {:>7} {:>7}\n", "", "", "ours", "thesis", "thesis", "of the");
  fmt::print(out, "{:<32} {:>5} {:>8} {:>8} {:>8} {:>8} {:>7} {:>7}   {}\n", "particles, neighbours", "pairs", "median",
             "least", "median", "least", "/ ours", "least", "half of the pairs");
  boost::json::array rows;
  for (const std::uint32_t count : {8192U, 16384U, 32768U, 65536U}) {
    auto both = ThesisComparison::create(ctx, scene, count);
    if (!both) return both.error();
    const ThesisDifference difference = (*both)->difference();
    const ThesisDifference& most = kThesisTolerance;
    if (!(difference.density <= most.density && difference.acceleration <= most.acceleration &&
          difference.position <= most.position)) {
      return core::Error{
          core::ErrorCode::kInternal,
          fmt::format("{} particles: the thesis's structure differs from ours by {:.1e} of the density (at most "
                      "{:.0e}), {:.1e} of the acceleration ({:.0e}) and {:.1e} of the spacing ({:.0e})",
                      (*both)->particleCount(), difference.density, most.density, difference.acceleration,
                      most.acceleration, difference.position, most.position)};
    }
    const double neighbours = (*both)->meanNeighbours();
    const std::uint32_t substeps = std::max(1U, kParticlesPerBlock / count);
    std::vector<double> ours_cpu_ms, ours_wall_ms, thesis_cpu_ms, thesis_wall_ms;
    const auto begin = Clock::now();
    for (std::size_t pair = 0;
         pair <= kPairsMinCount || std::chrono::duration<double>(Clock::now() - begin).count() < seconds; ++pair) {
      const Times ours = timed(ctx, **both, substeps, &ThesisComparison::stepOurs);
      const Times thesis = timed(ctx, **both, substeps, &ThesisComparison::stepThesis);
      if (pair == 0) continue;  // a warm-up
      ours_cpu_ms.push_back(ours.cpu_ms);
      ours_wall_ms.push_back(ours.wall_ms);
      thesis_cpu_ms.push_back(thesis.cpu_ms);
      thesis_wall_ms.push_back(thesis.wall_ms);
    }
    const std::string name = fmt::format("{}, {:.1f} neighbours", (*both)->particleCount(), neighbours);
    boost::json::object json{{"particle_count", (*both)->particleCount()},
                             {"neighbours_count", neighbours},
                             {"density_difference", difference.density},
                             {"acceleration_difference", difference.acceleration},
                             {"position_difference", difference.position}};
    json["cpu"] = row(out, name + ", CPU", ours_cpu_ms, thesis_cpu_ms);
    json["wall"] = row(out, "wall", ours_wall_ms, thesis_wall_ms);
    fmt::print(out, "  largest difference: {:.1e} of the density, {:.1e} of the acceleration, {:.1e} of the spacing\n",
               difference.density, difference.acceleration, difference.position);
    rows.push_back(std::move(json));
  }
  return rows;
}

}  // namespace spindrift::bench
