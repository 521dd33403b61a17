// The surface at points that somebody asks for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace spindrift::sim {

/// Limit of the points that are sampled at once.
inline constexpr std::size_t kMaxSurfacePoints = 8192;

struct SurfacePoint {
  double x_m = 0.0;
  double z_m = 0.0;
};

/// Values at a point, laid out as shaders/diagnostics/points.comp writes them; v1::QueryResult says what they are.
struct SurfaceSample {
  float elevation_m = 0.0F;
  float vertical_speed_mps = 0.0F;
  float velocity_x_mps = 0.0F;
  float velocity_z_mps = 0.0F;
  float slope_x = 0.0F;
  float slope_z = 0.0F;
  float depth_m = 0.0F;
  float wet_ratio = 0.0F;
  float foam_ratio = 0.0F;
  std::array<float, 3> unused{};
};

/// The samples of one call, in the order of its points. Points outside of the water have zeros.
struct SurfaceSamples {
  std::uint64_t number = 0;  ///< as the caller gave it
  std::vector<SurfaceSample> samples;
  std::vector<std::uint32_t> outside;  ///< indices of points outside of the water, ascending
};

}  // namespace spindrift::sim
