// The gauges of a scene on the device: one small dispatch per tick, read back with the diagnostics.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/context.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim/gauge_history.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

class Gauges {
 public:
  /// Precondition: the scene has gauges.
  static core::Result<std::unique_ptr<Gauges>> create(gpu::Context& ctx, const core::Scene& scene,
                                                      const WaveLayout& layout, const gpu::Defines& defines);

  /// Reads the water after a tick into readings(). ELEVATION, FLOW and the basin are bound.
  void measure();
  /// 4 floats per gauge, as shaders/diagnostics/gauges.comp writes them.
  [[nodiscard]] const gpu::Buffer& readings() const { return readings_; }
  /// Converts the bytes of readings().
  [[nodiscard]] static std::vector<GaugeReading> parse(std::span<const std::byte> bytes);

 private:
  std::uint32_t count_ = 0;
  gpu::Buffer places_, readings_;
  gpu::Program program_;
};

}  // namespace spindrift::sim
