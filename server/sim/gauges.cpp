#include "gauges.h"

#include <array>
#include <cstring>

#include <shared/bindings.h>
#include <shared/gauge_uniforms.h>

#include "create_all.h"

namespace spindrift::sim {
namespace {

static_assert(MAX_GAUGES == core::kMaxGauges);
using Reading = std::array<float, 4>;

}  // namespace

core::Result<std::unique_ptr<Gauges>> Gauges::create(gpu::Context& ctx, const core::Scene& scene,
                                                     const WaveLayout& layout, const gpu::Defines& defines) {
  auto out = std::make_unique<Gauges>();
  out->count_ = static_cast<std::uint32_t>(scene.gauges.size());
  shared::GaugeUniforms uniforms{};
  uniforms.gauge_count = out->count_;
  for (std::size_t k = 0; k < scene.gauges.size(); ++k) {
    const core::Gauge& gauge = scene.gauges[k];
    uniforms.gauges[k].column = static_cast<float>((gauge.x_m + layout.length_m / 2) / layout.cell_m - 0.5);
    uniforms.gauges[k].row = static_cast<float>((gauge.z_m + layout.width_m / 2) / layout.cell_m - 0.5);
  }
  Creation create;
  create(out->places_, gpu::Buffer::create(ctx, "gauges", sizeof uniforms, gpu::BufferUse::kUpdatable));
  create(out->readings_, gpu::Buffer::create(ctx, "gauge readings", out->count_ * sizeof(Reading),
                                             gpu::BufferUse::kDeviceOnly, gpu::BufferContent::kScratch));
  create(out->program_, gpu::Program::create(ctx, "diagnostics/gauges.comp", defines));
  if (create.error()) return *create.error();
  out->places_.uploadValue(uniforms);
  return out;
}

void Gauges::measure() {
  places_.bindUniform(GAUGE_UNIFORMS);
  readings_.bindStorage(PARTIAL_SUM);
  program_.dispatch(count_);
}

std::vector<GaugeReading> Gauges::parse(std::span<const std::byte> bytes) {
  std::vector<GaugeReading> out(bytes.size() / sizeof(Reading));
  for (std::size_t k = 0; k < out.size(); ++k) {
    Reading words;
    std::memcpy(words.data(), bytes.data() + k * sizeof words, sizeof words);
    out[k] = {.elevation_m = words[0], .velocity_x_mps = words[1], .velocity_z_mps = words[2]};
  }
  return out;
}

}  // namespace spindrift::sim
