#include "expectations.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <spindrift/codec/frame_decoder.h>

namespace spindrift::script {
namespace {

/// Elevation of the sample nearest to a point; nullopt outside of the water.
std::optional<double> elevation_m(const v1::LayerFrame& frame, double x_m, double z_m) {
  const auto surface = codec::decodeSurface(frame);
  if (!surface) return std::nullopt;
  const auto index = [](double at_m, double side_m, std::uint32_t count) {
    return static_cast<std::int64_t>(std::floor((at_m / side_m + 0.5) * count));
  };
  const std::int64_t i = index(x_m, surface->length_m, surface->count.x);
  const std::int64_t k = index(z_m, surface->width_m, surface->count.z);
  if (i < 0 || k < 0 || i >= surface->count.x || k >= surface->count.z) return std::nullopt;
  return surface->elevation_m[static_cast<std::size_t>(k * surface->count.x + i)];
}

}  // namespace

Seen seenSurface(const v1::ExpectSurface& step, Received& received) {
  const auto seen_m = elevation_m(received.newest[v1::LAYER_SURFACE], step.x_m(), step.z_m());
  if (!seen_m) return {false, "no surface there"};
  return {(!step.has_min_m() || *seen_m >= step.min_m()) && (!step.has_max_m() || *seen_m <= step.max_m()),
          fmt::format("elevation {:.4f} m", *seen_m)};
}

Seen seenGauge(const v1::ExpectGauge& step, const Received& received) {
  const auto& gauges = received.diagnostics.gauges();
  const auto gauge = std::ranges::find(gauges, step.gauge(), &v1::GaugeReading::name);
  if (gauge == gauges.end()) return {false, fmt::format("there is no gauge \"{}\"", step.gauge())};
  return {(!step.has_min_m() || gauge->elevation_m() >= step.min_m()) &&
              (!step.has_max_m() || gauge->elevation_m() <= step.max_m()) &&
              (!step.has_highest_min_m() || gauge->highest_m() >= step.highest_min_m()) &&
              (!step.has_highest_max_m() || gauge->highest_m() <= step.highest_max_m()) &&
              (!step.has_lowest_min_m() || gauge->lowest_m() >= step.lowest_min_m()) &&
              (!step.has_lowest_max_m() || gauge->lowest_m() <= step.lowest_max_m()),
          fmt::format("elevation {:.4f} m, highest {:.4f} m, lowest {:.4f} m", gauge->elevation_m(), gauge->highest_m(),
                      gauge->lowest_m())};
}

Seen seenBoat(const v1::ExpectBoat& step, std::uint32_t boat_id, Received& received) {
  const auto bodies = codec::decodeBodies(received.newest[v1::LAYER_BODIES]);
  if (!bodies) return {false, "no frame of the boats"};
  const auto boat = std::ranges::find(*bodies, boat_id, &codec::BodySample::boat_id);
  if (boat == bodies->end()) return {false, fmt::format("boat {} is not on the water", boat_id)};
  const double x_m = boat->position_m[0];
  const double z_m = boat->position_m[2];
  return {!step.has_radius_m() || std::hypot(x_m - step.x_m(), z_m - step.z_m()) <= step.radius_m(),
          fmt::format("boat {} at {:.2f}, {:.2f} m", boat_id, x_m, z_m)};
}

Seen seenParticles(const v1::ExpectParticles& step, Received& received) {
  const v1::LayerFrame& frame = received.newest[v1::LAYER_PARTICLES];
  const std::uint32_t count =
      frame.has_particles_fixed12() ? frame.particles_fixed12().count() : frame.particles_by_cell().count();
  return {count >= step.min_count() && (!step.has_max_count() || count <= step.max_count()),
          fmt::format("{} particles", count)};
}

}  // namespace spindrift::script
