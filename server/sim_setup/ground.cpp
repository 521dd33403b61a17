#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <spindrift/core/overloaded.h>
#include <spindrift/sim_setup/ground.h>

namespace spindrift::sim {
namespace {

/// Share of the depth by which shapes with rounded numbers may miss it: a slope of 0.049875 over 12.03 m and one of
/// -0.099502 over 6.03 m end 0.8 um below the floor. Such ground counts as wave.depth_m.
constexpr double kDepthTolerance = 1e-3;
/// The ground above a position counts as land on the way to shore if it is shallower than this share of the depth
/// there.
constexpr double kLandShare = 0.01;

/// A position relative to a centre: along a heading, and across it to the right. [m]
struct Place {
  double along_m, across_m;
};

Place placeFrom(double centre_x_m, double centre_z_m, double heading_deg, double x_m, double z_m) {
  const double heading = heading_deg * std::numbers::pi / 180.0;
  const double dx = x_m - centre_x_m;
  const double dz = z_m - centre_z_m;
  return {dx * std::cos(heading) + dz * std::sin(heading), dz * std::cos(heading) - dx * std::sin(heading)};
}

/// Length of a vector of which a side of zero is common.
double lengthOf(double a, double b) {
  return a == 0.0 || b == 0.0 ? std::abs(a + b) : std::hypot(a, b);
}

/// Distance in the plane from an obstacle, negative inside. [m]
double distance(const core::Rock& rock, double x_m, double z_m) {
  return std::hypot(x_m - rock.x_m, z_m - rock.z_m) - rock.radius_m;
}

double distance(const core::Breakwater& wall, double x_m, double z_m) {
  const Place place = placeFrom(wall.x_m, wall.z_m, wall.heading_deg, x_m, z_m);
  const double along = std::abs(place.along_m) - wall.length_m / 2;
  const double across = std::abs(place.across_m) - wall.width_m / 2;
  return lengthOf(std::max(along, 0.0), std::max(across, 0.0)) + std::min(std::max(along, across), 0.0);
}

double floorDepth(const core::Scene& scene) {
  const bool is_set = scene.bed && scene.bed->floor_depth_m > 0;
  return is_set ? scene.bed->floor_depth_m : scene.wave->depth_m;
}

/// Returns the depth that the grid gives; nullopt outside of its rectangle.
std::optional<double> gridDepth(const core::DepthGrid& grid, const core::WaveCells& water, double x_m, double z_m) {
  const double length_m = grid.length_m > 0 ? grid.length_m : water.length_m;
  const double width_m = grid.width_m > 0 ? grid.width_m : water.width_m;
  const double column = ((x_m - grid.x_m) / length_m + 0.5) * (grid.columns_count - 1);
  const double row = ((z_m - grid.z_m) / width_m + 0.5) * (grid.rows_count - 1);
  if (column < 0 || row < 0 || column > grid.columns_count - 1 || row > grid.rows_count - 1) return std::nullopt;
  const auto left = std::min(static_cast<std::size_t>(column), std::size_t{grid.columns_count} - 2);
  const auto before = std::min(static_cast<std::size_t>(row), std::size_t{grid.rows_count} - 2);
  const auto at = [&](std::size_t c, std::size_t r) { return double{(*grid.depths_m)[c + grid.columns_count * r]}; };
  const double along = column - static_cast<double>(left);
  return std::lerp(std::lerp(at(left, before), at(left + 1, before), along),
                   std::lerp(at(left, before + 1), at(left + 1, before + 1), along), row - static_cast<double>(before));
}

/// Share of the full height at a distance from the level part: 1 on it, 0 beyond the flank.
double flankShare(double distance_m, double flank_m) {
  if (distance_m <= 0) return 1.0;
  return flank_m > 0 ? std::max(1.0 - distance_m / flank_m, 0.0) : 0.0;
}

/// Distance from a rectangle with this centre; 0 inside.
double outsideRectangle(Place place, double length_m, double width_m) {
  return lengthOf(std::max(std::abs(place.along_m) - length_m / 2, 0.0),
                  std::max(std::abs(place.across_m) - width_m / 2, 0.0));
}

/// How much a shape raises the ground. [m]
double rise_m(const core::BedShape& shape, double x_m, double z_m) {
  return std::visit(
      core::Overloaded{
          [&](const core::BedCone& cone) {
            const double from_crest_m = std::hypot(x_m - cone.x_m, z_m - cone.z_m) - cone.crest_radius_m;
            return cone.height_m * flankShare(from_crest_m, cone.toe_radius_m - cone.crest_radius_m);
          },
          [&](const core::BedSlope& slope) {
            const double up_m = placeFrom(slope.x_m, slope.z_m, slope.heading_deg, x_m, z_m).along_m;
            const double end_m = slope.length_m > 0 ? slope.length_m : std::numeric_limits<double>::infinity();
            return slope.gradient_ratio * std::clamp(up_m, 0.0, end_m);
          },
          [&](const core::BedSill& sill) {
            const Place place = placeFrom(sill.x_m, sill.z_m, sill.heading_deg, x_m, z_m);
            return sill.height_m *
                   flankShare(outsideRectangle(place, sill.length_m, sill.crest_width_m), sill.flank_width_m);
          },
          [&](const core::BedChannel& channel) {
            const Place place = placeFrom(channel.x_m, channel.z_m, channel.heading_deg, x_m, z_m);
            return -channel.cut_m *
                   flankShare(outsideRectangle(place, channel.length_m, channel.bottom_width_m), channel.bank_width_m);
          },
      },
      shape);
}

/// Depth that no ground exceeds: a bound that needs no look at the cells.
double deepestPossible(const core::Scene& scene) {
  double deepest_m = floorDepth(scene);
  for (const core::Beach& beach : scene.beaches) deepest_m = std::max(deepest_m, beach.shore_depth_m);
  if (scene.bed->grid) {
    for (const float depth_m : *scene.bed->grid->depths_m) deepest_m = std::max(deepest_m, double{depth_m});
  }
  const core::WaveCells water = core::waveCellsOf(*scene.wave);
  const double reach_m = std::hypot(water.length_m, water.width_m);
  for (const core::BedShape& shape : scene.bed->shapes) {
    deepest_m += std::visit(core::Overloaded{
                                [](const core::BedCone& cone) { return std::max(-cone.height_m, 0.0); },
                                [&](const core::BedSlope& slope) {
                                  const double length_m = slope.length_m > 0 ? slope.length_m : 2 * reach_m;
                                  return std::max(-slope.gradient_ratio, 0.0) * length_m;
                                },
                                [](const core::BedSill&) { return 0.0; },
                                [](const core::BedChannel& channel) { return channel.cut_m; },
                            },
                            shape);
  }
  return deepest_m;
}

/// Still depth of an obstacle as ground; +infinity where it is not.
double obstacleDepth(const core::Rock& rock, double x_m, double z_m) {
  const double share = std::hypot(x_m - rock.x_m, z_m - rock.z_m) / rock.radius_m;
  return share < 1 ? -rock.height_m * (1 - share * share) : 2 * rock.height_m * (share - 1);
}

double obstacleDepth(const core::Breakwater& wall, double x_m, double z_m) {
  const Place place = placeFrom(wall.x_m, wall.z_m, wall.heading_deg, x_m, z_m);
  const bool is_inside = std::abs(place.along_m) <= wall.length_m / 2 && std::abs(place.across_m) <= wall.width_m / 2;
  return is_inside ? -wall.height_m : std::numeric_limits<double>::infinity();
}

/// The ground as the bed's shapes make it, at any depth.
double shapedDepth(const core::Scene& scene, double x_m, double z_m) {
  const double floor_m = floorDepth(scene);
  double depth_m = floor_m;
  if (scene.beaches.empty() && !scene.bed) return depth_m;
  const core::WaveCells water = core::waveCellsOf(*scene.wave);
  for (const core::Beach& beach : scene.beaches) {
    const double share =
        std::clamp(distanceTo(beach.side, water.length_m, water.width_m, x_m, z_m) / beach.width_m, 0.0, 1.0);
    depth_m = std::min(depth_m, std::lerp(beach.shore_depth_m, floor_m, share));
  }
  if (!scene.bed) return depth_m;
  if (scene.bed->grid) depth_m = gridDepth(*scene.bed->grid, water, x_m, z_m).value_or(depth_m);
  for (const core::BedShape& shape : scene.bed->shapes) depth_m -= rise_m(shape, x_m, z_m);
  return depth_m;
}

}  // namespace

double distanceTo(core::Side side, double length_m, double width_m, double x_m, double z_m) {
  switch (side) {
    case core::Side::kMinusX:
      return x_m + length_m / 2;
    case core::Side::kPlusZ:
      return width_m / 2 - z_m;
    case core::Side::kMinusZ:
      return z_m + width_m / 2;
    default:
      return length_m / 2 - x_m;
  }
}

double obstacleDistance(const core::Obstacle& obstacle, double x_m, double z_m) {
  return std::visit([&](const auto& o) { return distance(o, x_m, z_m); }, obstacle);
}

double obstacleDistance(const core::Scene& scene, double x_m, double z_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const core::Obstacle& obstacle : scene.obstacles)
    nearest_m = std::min(nearest_m, obstacleDistance(obstacle, x_m, z_m));
  return nearest_m;
}

double groundDepth(const core::Scene& scene, double x_m, double z_m) {
  const double depth_m = shapedDepth(scene, x_m, z_m);
  return scene.bed ? std::min(depth_m, scene.wave->depth_m) : depth_m;
}

double groundDepthWithObstacles(const core::Scene& scene, double x_m, double z_m) {
  double depth_m = groundDepth(scene, x_m, z_m);
  for (const core::Obstacle& obstacle : scene.obstacles) {
    depth_m = std::min(depth_m, std::visit([&](const auto& o) { return obstacleDepth(o, x_m, z_m); }, obstacle));
  }
  return std::max(depth_m, -kHighestLand_m);
}

double bedDepth(const core::Scene& scene, double x_m, double z_m) {
  return std::max(groundDepth(scene, x_m, z_m), 0.0);
}

std::optional<double> shoreSlope(const core::Scene& scene, double x_m, double z_m) {
  const double here_m = groundDepth(scene, x_m, z_m);
  if (!scene.bed || here_m <= 0) return std::nullopt;
  const double step_m = 0.5 * core::waveCellsOf(*scene.wave).cell_m;
  const double rise_x = (groundDepth(scene, x_m - step_m, z_m) - groundDepth(scene, x_m + step_m, z_m)) / (2 * step_m);
  const double rise_z = (groundDepth(scene, x_m, z_m - step_m) - groundDepth(scene, x_m, z_m + step_m)) / (2 * step_m);
  const double slope = std::hypot(rise_x, rise_z);
  if (slope <= 0) return std::nullopt;
  // Where the ground would come out of the water if it continued with this slope.
  const double way_m = here_m / slope;
  const double top_m = groundDepth(scene, x_m + rise_x / slope * way_m, z_m + rise_z / slope * way_m);
  return top_m < kLandShare * here_m ? std::optional(slope) : std::nullopt;
}

core::Result<void> checkGround(const core::Scene& scene) {
  if (!scene.wave || !scene.bed) return {};
  if (const auto& grid = scene.bed->grid) {
    const std::size_t wanted = std::size_t{grid->columns_count} * grid->rows_count;
    if (grid->columns_count < 2 || grid->rows_count < 2 || !grid->depths_m || grid->depths_m->size() != wanted)
      return core::invalid(fmt::format(
          "bed.grid: {} x {} points with {} depths are not a grid: give rows or a png with at least 2 x 2 points",
          grid->columns_count, grid->rows_count, grid->depths_m ? grid->depths_m->size() : 0));
  }
  const double limit_m = scene.wave->depth_m * (1 + kDepthTolerance);
  if (deepestPossible(scene) <= limit_m) return {};
  const core::WaveCells water = core::waveCellsOf(*scene.wave);
  double deepest_m = limit_m, deepest_x_m = 0.0, deepest_z_m = 0.0;
  for (std::uint32_t z = 0; z < water.count.z; ++z) {
    for (std::uint32_t x = 0; x < water.count.x; ++x) {
      const double x_m = (x + 0.5) * water.cell_m - water.length_m / 2;
      const double z_m = (z + 0.5) * water.cell_m - water.width_m / 2;
      const double depth_m = shapedDepth(scene, x_m, z_m);
      if (depth_m > deepest_m) {
        deepest_m = depth_m;
        deepest_x_m = x_m;
        deepest_z_m = z_m;
      }
    }
  }
  if (deepest_m <= limit_m) return {};
  return core::invalid(
      fmt::format("bed: {:.4g} m at x {:.4g} m, z {:.4g} m is deeper than wave.depth_m of {:.4g} m, the bound "
                  "by which steps are chosen: choose wave.depth_m of at least {:.4g} m (and "
                  "bed.floor_depth_m for the depth of the level floor)",
                  deepest_m, deepest_x_m, deepest_z_m, scene.wave->depth_m, deepest_m));
}

namespace {

/// The water along a side is judged by so many positions, from the side to this share of the way across, where crests
/// start.
constexpr int kPlacesAlong = 32;
constexpr int kPlacesAcross = 8;
constexpr double kJudgedShare = 0.25;
/// Sides whose depths differ by less than this share of the water's depth are equally deep.
constexpr double kEqualShare = 0.05;

struct SideWater {
  core::Side side = core::Side::kPlusX;
  core::WaveBoundary boundary = core::WaveBoundary::kPeriodic;
  /// From the centre toward the side.
  double x = 0.0;
  double z = 0.0;
};

double meanDepth(const core::Scene& scene, const SideWater& at) {
  const core::WaveCells water = core::waveCellsOf(*scene.wave);
  double sum_m = 0.0;
  for (int across = 0; across < kPlacesAcross; ++across) {
    // In half lengths from the centre: 1 at the side.
    const double outward = 1.0 - 2.0 * kJudgedShare * (across + 0.5) / kPlacesAcross;
    for (int along = 0; along < kPlacesAlong; ++along) {
      const double sideward = 2.0 * (along + 0.5) / kPlacesAlong - 1.0;
      const double x_m = 0.5 * water.length_m * (at.x != 0.0 ? at.x * outward : sideward);
      const double z_m = 0.5 * water.width_m * (at.z != 0.0 ? at.z * outward : sideward);
      sum_m += std::max(groundDepthWithObstacles(scene, x_m, z_m), 0.0);
    }
  }
  return sum_m / (kPlacesAlong * kPlacesAcross);
}

}  // namespace

core::Side openSide(const core::Scene& scene) {
  if (!scene.wave) return core::Side::kPlusX;
  const core::WaveScene& wave = *scene.wave;
  const std::array<SideWater, 4> sides{{{core::Side::kPlusX, wave.boundary_plus_x, 1, 0},
                                        {core::Side::kMinusX, wave.boundary_minus_x, -1, 0},
                                        {core::Side::kPlusZ, wave.boundary_plus_z, 0, 1},
                                        {core::Side::kMinusZ, wave.boundary_minus_z, 0, -1}}};
  std::array<double, sides.size()> depths_m{};
  std::ranges::transform(sides, depths_m.begin(), [&](const SideWater& at) { return meanDepth(scene, at); });
  const double least_m = std::ranges::max(depths_m) - kEqualShare * wave.depth_m;
  const SideWater* chosen = nullptr;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const bool is_open = sides[k].boundary == core::WaveBoundary::kAbsorb;
    if (depths_m[k] < least_m || (chosen && (!is_open || chosen->boundary == core::WaveBoundary::kAbsorb))) continue;
    chosen = &sides[k];
  }
  return chosen->side;
}

}  // namespace spindrift::sim
