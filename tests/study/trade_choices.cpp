#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <spindrift/sim_setup/dispersion.h>
#include <spindrift/study/trade.h>

#include "particle_choices.h"

namespace spindrift::study {
namespace {

constexpr double kMaxTickRate_hz = 240.0;
constexpr double kMaxLayers = 64.0;

bool isTwoWay(const core::Scene& scene) {
  return scene.coupling && scene.coupling->mode == core::CouplingMode::kTwoWay;
}

/// Returns the scene with `scale` times as many particles across the water, by the rules of the fidelity levels
/// (scene/fidelity.cpp).
core::Scene withFinerParticles(core::Scene scene, double scale) {
  core::ParticleScene& p = *scene.particles;
  double count_ratio = std::pow(scale, scene.wave && !isTwoWay(scene) ? 2 : 3);
  if (!scene.wave) {
    // Keeps the depth; whole layers decide.
    const double layers_count = std::clamp(std::round(p.layers_count * scale), 1.0, kMaxLayers);
    count_ratio = std::pow(layers_count / p.layers_count, 3);
    p.layers_count = layers_count;
  }
  p.count = static_cast<std::uint32_t>(std::lround(p.count * count_ratio));
  if (isTwoWay(scene)) scene.coupling->droplet_spacing_m /= scale;
  return scene;
}

core::Scene withResolution(core::Scene scene, double scale) {
  core::WaveScene& wave = *scene.wave;
  const core::WaveCells before = core::waveCellsOf(wave);
  // Multiples of 16 stay so, and the cells of a rectangle fit its width.
  const std::uint32_t step = wave.resolution_count % 16 == 0 ? 16 : 1;
  const double cells = std::round(wave.resolution_count * scale / step) * step;
  const double most = std::floor(std::sqrt(core::kWaveMaxCellCount * before.length_m / before.width_m));
  const auto limit = std::min(static_cast<std::uint32_t>(most), core::kWaveMaxSideCount);
  wave.resolution_count = std::min(static_cast<std::uint32_t>(cells), limit);
  const auto fits = [&] {
    const core::WaveCells after = core::waveCellsOf(wave.resolution_count, before.length_m, before.width_m);
    if (!core::widthFits(after, before.width_m)) return false;
    sim::WaveLayout out;
    out.count_x = after.count.x;
    out.count_z = after.count.z;
    out.is_periodic_x = sim::isPeriodicX(wave);
    out.is_periodic_z = sim::isPeriodicZ(wave);
    return wave.dispersion == core::Dispersion::kNone || sim::canDisperse(out);
  };
  // Dispersion needs a number of cells that can be halved often enough; the largest one of a square can.
  while (!fits() && wave.resolution_count + step <= limit) wave.resolution_count += step;
  return scene;
}

core::Scene waveAlone(core::Scene scene) {
  scene.particles.reset();
  scene.coupling.reset();
  if (scene.foam && !scene.foam->surface) scene.foam.reset();
  return scene;
}

}  // namespace

std::vector<TradeChoice> singleKnobs(const core::Scene& scene) {
  std::vector<TradeChoice> out;
  const auto add = [&](std::string knob, std::string setting, core::Scene changed) {
    out.push_back({std::move(knob), std::move(setting), std::move(changed)});
  };
  const auto changed = [&](auto change) {
    core::Scene copy = scene;
    change(copy);
    return copy;
  };
  if (scene.tick_rate_hz * 2 <= kMaxTickRate_hz)
    add("time step", "/ 2", changed([](core::Scene& s) { s.tick_rate_hz *= 2; }));
  if (scene.wave) {
    for (const double scale : {0.5, 0.75, 1.5, 2.0, 3.0})
      add("wave resolution", fmt::format("x {}", scale), withResolution(scene, scale));
    const bool nine = scene.wave->stencil == core::Stencil::kNinePoint;
    add("stencil", nine ? "5-point" : "9-point", changed([&](core::Scene& s) {
          s.wave->stencil = nine ? core::Stencil::kFivePoint : core::Stencil::kNinePoint;
        }));
    for (const double quantum_m : {0.0005, 0.016})
      add("quantum", fmt::format("{} mm", 1e3 * quantum_m),
          changed([&](core::Scene& s) { s.stream.surface_quantum_m = quantum_m; }));
  }
  if (scene.particles) {
    for (const double scale : {0.7, 1.4, 2.0})
      add("particles across", fmt::format("x {}", scale), withFinerParticles(scene, scale));
    for (const core::KernelSet set : kKernelSets) {
      if (set != scene.particles->kernel_set)
        add("kernel set", nameOf(set), changed([&](core::Scene& s) { s.particles->kernel_set = set; }));
    }
    for (const core::PressureSolver solver : kSolvers) {
      if (solver == scene.particles->solver) continue;
      add("solver", nameOf(solver), changed([&](core::Scene& s) {
            s.particles->solver = solver;
            // The stiffness that a column of water needs: 1 % compression at ten times the speed of its fall.
            const double fall_mps =
                std::sqrt(2 * s.gravity_mps2 * (s.wave ? s.wave->depth_m : s.particles->headroom_m));
            if (!isTwoWay(s)) s.particles->sound_speed_mps = std::max(s.particles->sound_speed_mps, 10 * fall_mps);
          }));
    }
    if (scene.particles->solver == core::PressureSolver::kPositionBased) {
      for (const std::uint32_t count : {1u, 8u})
        add("iterations", std::to_string(count),
            changed([&](core::Scene& s) { s.particles->iterations_count = count; }));
    } else {
      const bool mean = scene.particles->pressure_force == core::PressureForce::kMean;
      add("pressure force", mean ? "conserving" : "mean (thesis)", changed([&](core::Scene& s) {
            s.particles->pressure_force = mean ? core::PressureForce::kConserving : core::PressureForce::kMean;
          }));
    }
  }
  if (scene.coupling) {
    add("coupling", "wave alone", waveAlone(scene));
    // As a band on the wave, or as two-way spray: each replaces the other with the same water.
    add("coupling", isTwoWay(scene) ? "one-way" : "two-way", changed([&](core::Scene& s) {
          s.coupling->mode = isTwoWay(s) ? core::CouplingMode::kOneWay : core::CouplingMode::kTwoWay;
        }));
    if (!isTwoWay(scene)) {
      const bool five = scene.coupling->lattice_count == 5;
      add("lattice", five ? "3 x 3" : "5 x 5",
          changed([&](core::Scene& s) { s.coupling->lattice_count = five ? 3 : 5; }));
      add("downward force", "none", changed([](core::Scene& s) { s.coupling->downforce_per_m_s2 = 0.0; }));
    }
  }
  add("seed", "another", changed([](core::Scene& s) { s.seed += 1; }));
  return out;
}

core::Scene finerThan(const core::Scene& reference, double wave_scale) {
  core::Scene scene = reference;
  if (scene.wave) scene = withResolution(scene, wave_scale);
  if (scene.particles) scene = withFinerParticles(scene, 1.25);
  return scene;
}

std::vector<TradeChoice> simplerWaves(const core::Scene& scene) {
  std::vector<TradeChoice> out;
  if (!scene.wave) return out;
  const bool disperses = scene.wave->dispersion != core::Dispersion::kNone;
  const bool is_nonlinear = scene.wave->bulk != core::Bulk::kLinear;
  const auto add = [&](const char* knob, const char* setting, core::Dispersion dispersion, core::Bulk bulk) {
    core::Scene simpler = scene;
    simpler.wave->dispersion = dispersion;
    simpler.wave->bulk = bulk;
    out.push_back({knob, setting, std::move(simpler)});
  };
  if (disperses) add("dispersion", "off", core::Dispersion::kNone, scene.wave->bulk);
  if (is_nonlinear) add("bulk", "linear", scene.wave->dispersion, core::Bulk::kLinear);
  if (disperses && is_nonlinear) add("bulk, dispersion", "linear, off", core::Dispersion::kNone, core::Bulk::kLinear);
  return out;
}

std::vector<TradeChoice> costSweep() {
  core::Scene base;
  base.name = "cost";
  base.wave.emplace();
  base.particles.emplace();
  base.coupling.emplace();
  base.foam.emplace();
  std::vector<TradeChoice> out;
  for (const std::uint32_t n : {64u, 128u, 256u, 512u, 1024u}) {
    core::Scene scene = base;
    scene.particles.reset();
    scene.coupling.reset();
    scene.foam.reset();
    scene.wave->resolution_count = n;
    out.push_back({"wave alone", fmt::format("{} x {} cells", n, n), scene});
  }
  for (const bool coupled : {false, true}) {
    for (const std::uint32_t count : {8192u, 16384u, 32768u, 65536u}) {
      core::Scene scene = base;
      scene.particles->count = count;
      if (!coupled) {
        scene.wave.reset();
        scene.coupling.reset();
      }
      out.push_back(
          {coupled ? "coupled, 256 x 256 cells" : "particles alone", fmt::format("{} particles", count), scene});
    }
  }
  // Only the neighbour grid changes its size with the support radius.
  for (const double ratio : {1.6, 2.0, 2.4, 3.0}) {
    core::Scene scene = base;
    scene.wave.reset();
    scene.coupling.reset();
    scene.particles->support_ratio = ratio;
    out.push_back({"particles alone, 8192", fmt::format("support {} spacings", ratio), scene});
  }
  return out;
}

}  // namespace spindrift::study
