#include "surface_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>

#include <shared/bindings.h>
#include <shared/surface_points.h>

#include "ticks_in_flight.h"

namespace spindrift::sim {
namespace {

static_assert(sizeof(SurfaceSample) == SURFACE_POINT_TEXELS * 4 * sizeof(float));
/// One per tick in flight and one per round between ticks, for questions that came before the tick.
constexpr std::size_t kSlotCount = 2 * (TicksInFlight::kMaxCount + 1);

}  // namespace

CellPlace cellPlaceOf(const WaveLayout& layout, double x_m, double z_m) {
  return {static_cast<float>((x_m + layout.length_m / 2) / layout.cell_m - 0.5),
          static_cast<float>((z_m + layout.width_m / 2) / layout.cell_m - 0.5)};
}

SurfacePoints::SurfacePoints(Creation& create)
    : ctx_(create.context()),
      places_(create.updatable("query points", kMaxSurfacePoints * sizeof(CellPlace))),
      values_(create.buffer("query values", kMaxSurfacePoints * sizeof(SurfaceSample), gpu::BufferContent::kScratch)),
      pass_(create.pass("diagnostics/points.comp")),
      ring_(create.ring("queries", kMaxSurfacePoints * sizeof(SurfaceSample), kSlotCount)) {}

bool SurfacePoints::sample(std::span<const SurfacePoint> points, std::uint64_t number, const WaveLayout& layout,
                           Wave& wave, SurfaceFoam* foam) {
  assert(!points.empty() && points.size() <= kMaxSurfacePoints);
  auto slot = ring_->begin();
  if (!slot) return false;
  std::vector<CellPlace> places(points.size());
  SurfaceSamples record{.number = number, .samples = {}, .outside = {}};
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto [x_m, z_m] = points[k];
    if (std::abs(x_m) <= layout.length_m / 2 && std::abs(z_m) <= layout.width_m / 2)
      places[k] = cellPlaceOf(layout, x_m, z_m);
    else
      record.outside.push_back(static_cast<std::uint32_t>(k));
  }
  record.samples.resize(points.size());
  places_.upload(places);
  wave.elevation().bindTexel(ELEVATION);
  wave.flow().bindTexel(FLOW);
  wave.bindBasin();
  if (foam) foam->field().bindTexel(FOAM_FIELD);
  places_.bindStorage(QUERY_POINTS);
  values_.bindStorage(PARTIAL_SUM);
  pass_.setUniform("point_count", static_cast<std::uint32_t>(points.size()));
  pass_.dispatch(static_cast<std::uint32_t>(points.size()));
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);  // the next tick's passes write the buffers that were read here
  if (!slot->copyFrom(values_, 0, points.size() * sizeof(SurfaceSample), 0)) return false;
  slot->submit(number);
  in_flight_.push_back(std::move(record));
  return true;
}

std::vector<SurfaceSamples> SurfacePoints::poll() {
  std::vector<SurfaceSamples> out;
  for (const auto& slot : ring_->poll()) {
    // A slot whose fence failed is never returned: skip it.
    while (in_flight_.front().number != slot->tag()) in_flight_.pop_front();
    SurfaceSamples record = std::move(in_flight_.front());
    in_flight_.pop_front();
    std::memcpy(record.samples.data(), slot->bytes().data(), record.samples.size() * sizeof(SurfaceSample));
    for (const std::uint32_t k : record.outside) record.samples[k] = {};
    out.push_back(std::move(record));
  }
  return out;
}

}  // namespace spindrift::sim
