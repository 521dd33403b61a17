#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/bench/steps.h>
#include <spindrift/sim/water_sim.h>

#include "neighbours.h"

namespace spindrift::bench {

core::Scene withFloaters(core::Scene scene, std::uint32_t count, double sizes_apart) {
  constexpr double kSize_m = 0.3;
  scene.floaters.emplace().capacity_count = count;
  const int row = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int i = 0; i < static_cast<int>(count); ++i) {
    scene.floaters->floaters.push_back({.kind = static_cast<core::FloaterKind>(i % 7),
                                        .x_m = sizes_apart * kSize_m * (i % row - row / 2),
                                        .y_m = 0.05,
                                        .z_m = sizes_apart * kSize_m * (i / row - row / 2),
                                        .heading_deg = 7.0 * (i % 25),
                                        .size_m = kSize_m});
  }
  return scene;
}

namespace {

using Clock = std::chrono::steady_clock;

double since_s(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// One scene at one particle count.
struct StepCase {
  std::string name;
  core::Scene scene;
  std::uint32_t drawing_count = 0;  ///< people who draw without a pause
};

/// Moves each person's finger by a tick, around a circle. Radius: the default of a stroke; depth: its default in
/// harbor.
core::Result<void> draw(sim::WaterSim& water, std::uint32_t count) {
  if (count == 0) return {};
  const sim::WaveLayout& wave = *water.derived().wave;
  const double side_m = std::min(wave.length_m, wave.width_m);
  const double time_s = water.time_s();
  for (std::uint32_t k = 0; k < count; ++k) {
    const double around = std::numbers::pi * (3.0 * k + 2.0 * time_s);
    const double x_m = wave.length_m * (std::fmod(0.618 * k, 0.9) - 0.45) + 0.03 * side_m * std::cos(around);
    const double z_m = wave.width_m * (std::fmod(0.755 * k, 0.9) - 0.45) + 0.03 * side_m * std::sin(around);
    auto drawn = water.draw({.person_id = 1 + k,
                             .stroke_id = 1,
                             .radius_m = 0.025 * side_m,
                             .depth_m = 0.0075 * side_m,
                             .points = {{time_s, x_m, z_m}}});
    if (!drawn) return drawn.error();
  }
  return {};
}

struct StepResult {
  std::string name;
  std::uint32_t particle_count = 0;
  double neighbours_count = 0.0;  ///< mean of the particles after the measurement
  std::uint32_t substeps_count = 0;
  double tick_ms = 0.0;
  double substep_ms = 0.0;
  double particle_us = 0.0;           ///< grid + sph passes, per particle and substep
  double real_time_factor = 0.0;      ///< of the simulation alone
  std::vector<gpu::PassCost> passes;  ///< total_ms: per tick
};

/// The scene, its parts alone, and, if the number of particles is fixed, the thesis's numbers; on hardware up to a
/// million.
std::vector<StepCase> stepCases(const core::Scene& base, bool is_software) {
  std::vector<StepCase> cases = {{"scene as it is", base}};
  core::Scene wave_only = base;
  wave_only.particles.reset();
  wave_only.coupling.reset();
  wave_only.foam.reset();
  wave_only.boats.reset();
  wave_only.floaters.reset();
  wave_only.storm.reset();
  const bool two_way = base.coupling && base.coupling->mode == core::CouplingMode::kTwoWay;
  if (base.boats || base.floaters || base.storm || base.particles) {
    core::Scene calm = base;
    calm.events.clear();
    calm.boats.reset();
    calm.floaters.reset();
    calm.storm.reset();
    cases.push_back({"calm", calm});
  }
  if (base.wave && (base.particles || base.boats || base.foam)) cases.push_back({"wave only", wave_only});
  if (base.wave) cases.push_back({"50 people drawing", base, 50});
  if (base.wave && base.particles && !two_way) {
    core::Scene uncoupled = base;
    uncoupled.coupling.reset();
    cases.push_back({"not coupled", uncoupled});
  }
  if (base.floaters) {
    for (const std::uint32_t count : {256u, core::kMaxFloaters}) {
      cases.push_back({fmt::format("{} floaters", count), withFloaters(wave_only, count, 2.2)});
      cases.push_back({fmt::format("{} packed", count), withFloaters(wave_only, count, 0.9)});
    }
  }
  if (base.particles && !two_way) {
    std::vector<std::uint32_t> counts = {8192, 16384, 32768, 65536};
    if (!is_software) counts.insert(counts.end(), {262144, 1048576});
    for (const std::uint32_t count : counts) {
      core::Scene scene = base;
      scene.particles->count = count;
      cases.push_back({fmt::format("{} particles", count), scene});
    }
  }
  return cases;
}

core::Result<StepResult> measure(gpu::Context& ctx, const StepCase& test, double seconds) {
  auto sim = sim::WaterSim::create(ctx, test.scene);
  if (!sim) return sim.error();
  sim::WaterSim& water = **sim;
  core::Result<void> drawn;
  const auto run = [&](double limit_s) {
    ctx.finish();
    const auto begin = Clock::now();
    std::uint32_t ticks = 0;
    do {
      drawn = draw(water, test.drawing_count);
      water.step();
      ++ticks;
      if (!ctx.device().is_software && ticks % 8 == 0)
        ctx.finish();  // bound the queue, so that the measured time includes the work
    } while (drawn && since_s(begin) < limit_s);
    ctx.finish();
    return std::pair{since_s(begin), ticks};
  };
  run(std::min(0.5, seconds / 4));
  (void)water.takePassCosts();
  const auto [elapsed_s, ticks] = run(seconds);
  if (!drawn) return drawn.error();

  const sim::Derived& d = water.derived();
  StepResult r;
  r.name = test.name;
  r.particle_count = water.particleCount();
  if (d.particles) r.neighbours_count = meanNeighbours(water.copyState().position, countedBox(water.scene(), d));
  r.substeps_count = d.substeps_count;
  r.tick_ms = elapsed_s * 1e3 / ticks;
  r.substep_ms = r.tick_ms / d.substeps_count;
  r.real_time_factor = d.tick_s / (elapsed_s / ticks);
  r.passes = water.takePassCosts();
  for (const gpu::PassCost& pass : r.passes) {
    // A pool's count changes from tick to tick, so a cost per particle would be meaningless.
    if (r.particle_count > 0 && d.uniforms.pool_capacity_count == 0 && (pass.name == "grid" || pass.name == "sph"))
      r.particle_us += pass.total_ms * 1e3 / ticks / d.substeps_count / r.particle_count;
  }
  for (gpu::PassCost& pass : r.passes) pass.total_ms /= ticks;
  return r;
}

boost::json::object toJson(const StepResult& r) {
  boost::json::object passes;
  for (const gpu::PassCost& pass : r.passes) passes[pass.name] = pass.total_ms;
  return {{"name", r.name},
          {"particle_count", r.particle_count},
          {"neighbours_count", r.neighbours_count},
          {"substeps_count", r.substeps_count},
          {"tick_ms", r.tick_ms},
          {"substep_ms", r.substep_ms},
          {"sph_step_us_per_particle", r.particle_us},
          {"real_time_factor", r.real_time_factor},
          {"tick_ms_by_pass", passes}};
}

void print(std::FILE* out, const StepResult& r) {
  fmt::print(out, "{:<18} {:>9} {:>10.1f} {:>8} {:>9.3f} {:>9.3f} {:>11} {:>6.2f}  ", r.name, r.particle_count,
             r.neighbours_count, r.substeps_count, r.tick_ms, r.substep_ms,
             r.particle_us > 0 ? fmt::format("{:.3f}", r.particle_us) : "-", r.real_time_factor);
  for (const gpu::PassCost& pass : r.passes) fmt::print(out, " {} {:.3f}", pass.name, pass.total_ms);
  fmt::print(out, "\n");
}

}  // namespace

core::Result<boost::json::array> measureSteps(gpu::Context& ctx, const core::Scene& scene, double seconds,
                                              std::FILE* out) {
  fmt::print(out, "{:<18} {:>9} {:>10} {:>8} {:>9} {:>9} {:>11} {:>6}   ms per tick by pass\n", "case", "particles",
             "neighbours", "substeps", "tick ms", "substep ms", "us/particle", "rtf");
  boost::json::array results;
  for (const StepCase& test : stepCases(scene, ctx.device().is_software)) {
    auto result = measure(ctx, test, seconds);
    if (!result) return core::Error{result.error().code, test.name + ": " + result.error().message};
    print(out, *result);
    results.push_back(toJson(*result));
  }
  return results;
}

}  // namespace spindrift::bench
