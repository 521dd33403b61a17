// The depths that a scene gives as a grid. By hand, because scene.proto holds them in the forms of scene files.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace spindrift::core {

/// Depths at the points of a grid over a rectangle, bilinear between them. [m], negative on land
struct DepthGrid {
  double x_m = 0.0;  ///< centre
  double z_m = 0.0;
  double length_m = 0.0;            ///< first to last point along x; 0 = the length of the water
  double width_m = 0.0;             ///< the same along z
  std::uint32_t columns_count = 0;  ///< points along x
  std::uint32_t rows_count = 0;
  /// columns_count * rows_count, x fastest. Shared by the copies of a scene.
  std::shared_ptr<const std::vector<float>> depths_m;

  bool operator==(const DepthGrid& other) const {
    return x_m == other.x_m && z_m == other.z_m && length_m == other.length_m && width_m == other.width_m &&
           columns_count == other.columns_count && rows_count == other.rows_count &&
           (depths_m == other.depths_m || (depths_m && other.depths_m && *depths_m == *other.depths_m));
  }
};

}  // namespace spindrift::core
