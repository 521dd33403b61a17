#include <cstdio>

#include <fmt/format.h>

#include <spindrift/sim/derive.h>
#include <spindrift/stream/scene_loader.h>

#include "../paths.h"
#include "commands.h"

namespace spindrift::app {
namespace {

void print(const std::string& file, const v1::Scene& scene, const sim::Derived& d) {
  fmt::print("{}: fine\n  scene      {} ({})\n  tick       {:.3f} ms, {} substeps of {:.3f} ms\n", file, scene.name(),
             scene.title(), d.tick_s * 1e3, d.substeps_count, d.dt_s * 1e3);
  if (d.wave) {
    fmt::print(
        "  wave       {0} x {0} cells of {1:.3f} m, speed {2:.2f} m/s, {3} steps a substep, Courant number {4:.3f}\n",
        d.wave->resolution_count, d.wave->cell_m, d.wave->speed_mps, d.wave->substeps_count, d.wave->courant);
  }
  if (d.particles) {
    const auto& p = *d.particles;
    fmt::print(
        "  particles  {} ({} x {} x {}), spacing {:.3f} m, support radius {:.3f} m, {:.0f} neighbours, mass {:.3f} "
        "kg\n",
        p.count, p.columns_x_count, p.layers_count, p.columns_z_count, p.spacing_m, p.support_radius_m,
        p.neighbours_count, p.mass_kg);
    fmt::print("  grid       {} x {} x {} cells\n", p.cells[0], p.cells[1], p.cells[2]);
  }
  for (const sim::StepRule& rule : d.rules)
    fmt::print("  rule       step <= {:.3f} ms: {} ({})\n", rule.max_dt_s * 1e3, rule.name, rule.field);
  fmt::print("  memory     {:.2f} MB on the device\n", static_cast<double>(d.device_bytes) / 1e6);
}

}  // namespace

int check(const CheckOptions& options) {
  int code = 0;
  for (const std::string& name : options.scenes) {
    auto file = findScene(name);
    if (!file) {
      code = fail(file.error());
      continue;
    }
    auto scene = stream::loadSceneFile(*file);
    if (!scene) {
      code = fail(scene.error());
      continue;
    }
    auto derived = sim::derive(stream::toCore(*scene));
    if (!derived) {
      code = fail({derived.error().code, file->string() + ": " + derived.error().message});
      continue;
    }
    print(file->string(), *scene, *derived);
  }
  return code;
}

}  // namespace spindrift::app
