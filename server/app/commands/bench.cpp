// Timings of the simulation's passes and of the stream's codecs, on the machine at hand.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <thread>
#include <vector>

#include <boost/json.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <spindrift/gpu/context.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim/water_sim.h>

#include "../paths.h"
#include "bench_codec.h"
#include "bench_fanout.h"
#include "commands.h"
#include "output.h"

namespace spindrift::app {
namespace {

using Clock = std::chrono::steady_clock;

double since_s(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// One scene at one particle count.
struct StepCase {
  std::string name;
  core::Scene scene;
};

struct StepResult {
  std::string name;
  std::uint32_t particle_count = 0;
  double neighbours_count = 0.0;
  std::uint32_t substeps_count = 0;
  double tick_ms = 0.0;
  double substep_ms = 0.0;
  double particle_us = 0.0;       ///< grid + sph passes, a particle and substep
  double real_time_factor = 0.0;  ///< of the simulation alone
  std::vector<gpu::PassCost> passes;
};

/// The scene, its parts alone, and, where the number of particles is the scene's, the thesis's counts.
std::vector<StepCase> stepCases(const core::Scene& base) {
  std::vector<StepCase> cases = {{"scene as it is", base}};
  core::Scene wave_only = base;
  wave_only.particles.reset();
  wave_only.coupling.reset();
  wave_only.foam.reset();
  wave_only.boats.reset();
  wave_only.storm.reset();
  const bool two_way = base.coupling && base.coupling->mode == core::CouplingMode::kTwoWay;
  if (base.boats || base.storm || base.particles) {
    core::Scene calm = base;
    calm.events.clear();
    calm.boats.reset();
    calm.storm.reset();
    cases.push_back({"calm", calm});
  }
  if (base.wave && (base.particles || base.boats || base.foam)) cases.push_back({"wave only", wave_only});
  if (base.wave && base.particles && !two_way) {
    core::Scene uncoupled = base;
    uncoupled.coupling.reset();
    cases.push_back({"not coupled", uncoupled});
  }
  if (base.particles && !two_way) {
    for (const std::uint32_t count : {8192u, 16384u, 32768u, 65536u}) {
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
  const auto run = [&](double limit_s) {
    ctx.finish();
    const auto begin = Clock::now();
    std::uint32_t ticks = 0;
    do {
      water.step();
      ++ticks;
      if (!ctx.device().is_software && ticks % 8 == 0)
        ctx.finish();  // bound the queue, so that the clock sees the work
    } while (since_s(begin) < limit_s);
    ctx.finish();
    return std::pair{since_s(begin), ticks};
  };
  run(std::min(0.5, seconds / 4));
  (void)water.takePassCosts();
  const auto [elapsed_s, ticks] = run(seconds);

  const sim::Derived& d = water.derived();
  StepResult r;
  r.name = test.name;
  r.particle_count = water.particleCount();
  r.neighbours_count = d.particles ? d.particles->neighbours_count : 0;
  r.substeps_count = d.substeps_count;
  r.tick_ms = elapsed_s * 1e3 / ticks;
  r.substep_ms = r.tick_ms / d.substeps_count;
  r.real_time_factor = d.tick_s / (elapsed_s / ticks);
  r.passes = water.takePassCosts();
  for (const gpu::PassCost& pass : r.passes) {
    // A pool's count changes from tick to tick; a cost per particle would say nothing.
    if (r.particle_count > 0 && d.uniforms.pool_capacity_count == 0 && (pass.name == "grid" || pass.name == "sph"))
      r.particle_us += pass.total_ms * 1e3 / ticks / d.substeps_count / r.particle_count;
  }
  for (gpu::PassCost& pass : r.passes) pass.mean_ms = pass.total_ms / ticks;
  return r;
}

boost::json::object toJson(const StepResult& r) {
  boost::json::object passes;
  for (const gpu::PassCost& pass : r.passes) passes[pass.name] = pass.mean_ms;
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
  fmt::print(out, "{:<18} {:>9} {:>8} {:>9.3f} {:>9.3f} {:>11} {:>6.2f}  ", r.name, r.particle_count, r.substeps_count,
             r.tick_ms, r.substep_ms, r.particle_us > 0 ? fmt::format("{:.3f}", r.particle_us) : "-",
             r.real_time_factor);
  for (const gpu::PassCost& pass : r.passes) fmt::print(out, " {} {:.2f}", pass.name, pass.mean_ms);
  fmt::print(out, "\n");
}

/// Apart from the others: the server that it measures has a context of its own.
int benchFanout(const BenchOptions& options, const v1::Scene& scene) {
  auto result = measureFanout(scene, options.device, options.seconds, options.json_file == "-" ? stderr : stdout);
  if (!result) return fail(result.error());
  if (auto written = writeJson(options.json_file, *result); !written) return fail(written.error());
  return 0;
}

}  // namespace

int bench(const BenchOptions& options) {
  auto device = gpu::parseDeviceChoice(options.device);
  if (!device) return fail(device.error());
  auto file = findScene(options.scene);
  if (!file) return fail(file.error());
  auto loaded = scene::loadSceneFile(*file, scene::parseFidelity(options.fidelity));
  if (!loaded) return fail(loaded.error());
  if (options.suite == "fanout") return benchFanout(options, *loaded);
  auto ctx = gpu::Context::create(*device);
  if (!ctx) return fail(ctx.error());
  const core::Scene scene = scene::toCore(*loaded);

  std::FILE* out = options.json_file == "-" ? stderr : stdout;
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  fmt::print(out, "machine {}, {} hardware threads; device {}, {}; scene {}\n", host,
             std::thread::hardware_concurrency(), (*ctx)->device().name, (*ctx)->device().gl_version, scene.name);
  boost::json::object json = {{"threads", std::thread::hardware_concurrency()},
                              {"device", (*ctx)->device().name},
                              {"gl_version", (*ctx)->device().gl_version},
                              {"scene", scene.name}};
  if (options.suite != "codec") {
    fmt::print(out, "{:<18} {:>9} {:>8} {:>9} {:>9} {:>11} {:>6}   ms a tick by pass\n", "case", "particles",
               "substeps", "tick ms", "substep ms", "us/particle", "rtf");
    boost::json::array results;
    for (const StepCase& test : stepCases(scene)) {
      auto result = measure(**ctx, test, options.seconds);
      if (!result) return fail({result.error().code, test.name + ": " + result.error().message});
      print(out, *result);
      results.push_back(toJson(*result));
    }
    json["step"] = std::move(results);
  }
  if (options.suite != "step") {
    auto result = measureCodecs(**ctx, scene, options.seconds, out);
    if (!result) return fail(result.error());
    json["codec"] = *std::move(result);
  }
  if (auto written = writeJson(options.json_file, json); !written) return fail(written.error());
  return 0;
}

}  // namespace spindrift::app
