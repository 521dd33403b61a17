#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <spindrift/core/files.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/ground.h>
#include <spindrift/sim_setup/scene_parts.h>
#include <spindrift/sim_setup/sea_state.h>

#include "commands.h"

namespace spindrift::cli {
namespace {

struct CheckOptions {
  std::vector<std::string> scenes;
  std::string fidelity;  ///< as in ServeOptions
};

const char* nameOf(core::WaveBoundary boundary) {
  if (boundary == core::WaveBoundary::kPeriodic) return "periodic";
  return boundary == core::WaveBoundary::kAbsorb ? "absorbs" : "reflects";
}

const char* nameOf(core::Side side) {
  constexpr const char* kNames[] = {"+x", "-x", "+z", "-z", "a direction"};
  return kNames[static_cast<int>(side)];
}

void printBed(const core::Bed& bed, double depth_m) {
  fmt::print("  bed        floor at a depth of {:.4g} m", bed.floor_depth_m > 0 ? bed.floor_depth_m : depth_m);
  if (bed.grid) {
    const auto [shallowest, deepest] = std::ranges::minmax(*bed.grid->depths_m);
    fmt::print(", grid of {} x {} points from {:.4g} to {:.4g} m", bed.grid->columns_count, bed.grid->rows_count,
               shallowest, deepest);
  }
  if (!bed.shapes.empty()) fmt::print(", shapes {}", bed.shapes.size());
  fmt::print("\n");
}

std::string wavesOf(const core::WaveMaker& maker) {
  if (const auto* regular = std::get_if<core::RegularWaves>(&maker.waves))
    return fmt::format("regular waves of {:.3g} m, {:.3g} s", regular->height_m, regular->period_s);
  if (const auto* irregular = std::get_if<core::IrregularWaves>(&maker.waves))
    return fmt::format("JONSWAP of {:.3g} m, peak at {:.3g} s", irregular->significant_height_m,
                       irregular->peak_period_s);
  if (const auto* solitary = std::get_if<core::SolitaryWave>(&maker.waves))
    return fmt::format("solitary wave of {:.3g} m", solitary->height_m);
  const auto& series = std::get<core::ElevationSeries>(maker.waves);
  return fmt::format("series of {} rows, {:.4g} s", series.time_s.size(),
                     series.time_s.empty() ? 0.0 : series.time_s.back());
}

void printWave(const core::Scene& scene) {
  const core::WaveScene& wave = *scene.wave;
  fmt::print("  sides      -x {}, +x {}, -z {}, +z {}", nameOf(wave.boundary_minus_x), nameOf(wave.boundary_plus_x),
             nameOf(wave.boundary_minus_z), nameOf(wave.boundary_plus_z));
  const bool absorbs = std::ranges::any_of(
      std::array{wave.boundary_minus_x, wave.boundary_plus_x, wave.boundary_minus_z, wave.boundary_plus_z},
      [](core::WaveBoundary b) { return b == core::WaveBoundary::kAbsorb; });
  if (absorbs)
    fmt::print(", {} of {:.3g} m", sim::hasMatchedLayer(scene) ? "matched layer" : "sponge", wave.sponge_width_m);
  fmt::print("\n  open side  {}: where waves come from if none is named\n", nameOf(sim::openSide(scene)));
  if (wave.steepening_ratio > 0) fmt::print("  steepening {:.3g}\n", wave.steepening_ratio);
  if (!scene.obstacles.empty()) fmt::print("  obstacles  {}\n", scene.obstacles.size());
  for (const core::Beach& beach : scene.beaches) {
    fmt::print("  beach      at {}, {:.3g} m wide, up to a depth of {:.3g} m\n", nameOf(beach.side), beach.width_m,
               beach.shore_depth_m);
  }
  if (scene.bed) printBed(*scene.bed, wave.depth_m);
  for (const core::WaveMaker& maker : scene.wave_makers)
    fmt::print("  maker      at {}: {}, from {:.4g} s on\n", nameOf(maker.side), wavesOf(maker), maker.begin_s);
  for (const core::Gauge& gauge : scene.gauges) {
    fmt::print("  gauge      {} at x {:.4g} m, z {:.4g} m, where the ground is {:.4g} m deep\n", gauge.name, gauge.x_m,
               gauge.z_m, sim::groundDepth(scene, gauge.x_m, gauge.z_m));
  }
}

void printParticles(const core::Scene& scene) {
  const core::ParticleScene& particles = *scene.particles;
  const bool iterates = particles.solver == core::PressureSolver::kPositionBased;
  fmt::print("  solver     {}{}\n",
             iterates ? fmt::format("position-based, {} iterations per substep", particles.iterations_count)
                      : fmt::format("weakly compressible, {} equation of state, {} pressure force",
                                    particles.equation_of_state == core::EquationOfState::kTait ? "Tait's" : "linear",
                                    particles.pressure_force == core::PressureForce::kMean ? "mean" : "conserving"),
             particles.cohesion ? ", cohesion" : "");
  if (scene.coupling && scene.coupling->mode == core::CouplingMode::kTwoWay)
    fmt::print("  coupling   two-way, droplets of {:.3g} m\n", scene.coupling->droplet_spacing_m);
}

void printBoats(const core::BoatsScene& boats) {
  fmt::print("  boats      {} of at most {}\n", boats.boats.size(), boats.capacity_count);
  for (std::size_t i = 0; i < boats.boats.size(); ++i) {
    const core::Boat& boat = boats.boats[i];
    fmt::print("  boat {:<5} {:.3g} x {:.3g} x {:.3g} m, draught {:.3g} m\n", i + 1, boat.length_m, boat.beam_m,
               boat.height_m, boat.density_ratio * boat.height_m);
  }
}

void printStorm(const core::Scene& scene, const sim::Derived& derived) {
  fmt::print("  storm      {:.3g}\n", scene.storm->level_ratio);
  if (!sim::hasWindSea(scene)) return;
  const sim::SeaState sea = sim::seaState(scene, *derived.wave);
  const auto enter = std::ranges::count_if(sea.waves, [](const sim::PlaneWave& wave) { return wave.sides != 0; });
  if (enter == 0) {
    fmt::print("  sea        calm: {}\n", sea.waves.empty() ? "no wind, or only waves that the grid does not resolve"
                                                            : "the wind comes from closed sides");
    return;
  }
  fmt::print(
      "  sea        wind of {:.3g} m/s over {:.4g} m: significant height {:.3g} m, peak at {:.3g} s and {:.3g} m; {} "
      "of "
      "{} waves come in\n",
      sea.wind_speed_mps, scene.storm->fetch_m, sea.significant_height_m, sea.peak_period_s, sea.peak_length_m, enter,
      sea.waves.size());
}

void print(const std::string& file, const v1::Scene& scene, const core::Scene& in, const sim::Derived& d) {
  fmt::print("{}: valid\n  scene      {} ({}), {}\n  setting    {}\n", file, scene.name(), scene.title(),
             scene::fidelityName(scene.fidelity()), scene::settingName(scene.setting()));
  fmt::print("  tick       {:.3f} ms, {} substeps of {:.3f} ms\n", d.tick_s * 1e3, d.substeps_count, d.dt_s * 1e3);
  if (d.wave) {
    fmt::print("  wave       {} x {} cells of {:.3f} m, speed {:.2f} m/s, {} steps per tick, Courant number {:.3f}\n",
               d.wave->count_x, d.wave->count_z, d.wave->cell_m, d.wave->speed_mps, d.wave->substeps_count,
               d.wave->courant);
    printWave(in);
  }
  if (d.particles) {
    const auto& p = *d.particles;
    // A pool has no lattice: its number of particles changes.
    const std::string count = p.layers_count == 0 ? fmt::format("up to {}", p.count)
                                                  : fmt::format("{} ({} x {} x {})", p.count, p.columns_x_count,
                                                                p.layers_count, p.columns_z_count);
    fmt::print(
        "  particles  {}, spacing {:.3f} m, support radius {:.3f} m, {:.0f} neighbours inside a lattice, mass {:.3f} "
        "kg\n",
        count, p.spacing_m, p.support_radius_m, p.neighbours_count, p.mass_kg);
    fmt::print("  grid       {} x {} x {} cells\n", p.cells[0], p.cells[1], p.cells[2]);
    printParticles(in);
  }
  if (in.boats) printBoats(*in.boats);
  if (in.floaters)
    fmt::print("  floaters   {} of at most {}\n", in.floaters->floaters.size(), in.floaters->capacity_count);
  if (in.storm) printStorm(in, d);
  for (const sim::StepRule& rule : d.rules)
    fmt::print("  rule       step <= {:.3f} ms: {} ({})\n", rule.max_dt_s * 1e3, rule.name, rule.field);
  fmt::print("  memory     {:.2f} MB on the device\n", static_cast<double>(d.device_bytes) / 1e6);
}

int check(const CheckOptions& options) {
  int code = 0;
  for (const std::string& name : options.scenes) {
    auto file = core::findScene(name);
    if (!file) {
      code = fail(file.error());
      continue;
    }
    auto scene = scene::loadSceneFile(*file, scene::parseFidelity(options.fidelity));
    if (!scene) {
      code = fail(scene.error());
      continue;
    }
    const core::Scene in = scene::toCore(*scene);
    auto derived = sim::derive(in);
    if (!derived) {
      code = fail({derived.error().code, file->string() + ": " + derived.error().message});
      continue;
    }
    print(file->string(), *scene, in, *derived);
  }
  return code;
}

}  // namespace

ProgramCommand addCheck(CLI::App& program) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command = program.add_subcommand("check", "Check scenes and print the derived quantities");
  command->add_option("scene", options->scenes, "Scene files or names of shipped scenes")->required();

  addFidelity(*command, options->fidelity);
  return {command, [options] { return check(*options); }};
}

}  // namespace spindrift::cli
