// Rules between the water and the objects in it: sides, sponge, obstacles, beaches, boats, floaters, wave-makers.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <spindrift/core/text.h>
#include <spindrift/scene/scene_rules.h>

#include "scene_parts.h"

namespace spindrift::scene {
namespace {

/// Maximum length of a boat over the water's longer and over its shorter side; a longer one would have no room to sail.
constexpr double kMaxBoatSideRatio = 0.25;
constexpr double kMaxBoatWidthRatio = 0.5;
/// Draught over the water's depth of a boat whose height follows from the water.
constexpr double kFittingDraughtRatio = 0.6;
/// Maximum size of a floater over the water's shorter side, and its maximum height over the rest level.
constexpr double kMaxFloaterSideRatio = 0.25;
constexpr double kMaxFloaterHeight_m = 20.0;
constexpr double kMinFloaterDensity = 0.02;  ///< foam of polystyrene

using core::metres;

/// A rectangle seen from above. half_z is to the left of the heading; the heading turns from +x toward +z.
struct Footprint {
  double x_m, z_m;
  double half_length_m, half_width_m;
  double cosine, sine;

  Footprint(double x, double z, double length_m, double width_m, double heading_deg)
      : x_m(x),
        z_m(z),
        half_length_m(length_m / 2),
        half_width_m(width_m / 2),
        cosine(std::cos(heading_deg * std::numbers::pi / 180)),
        sine(std::sin(heading_deg * std::numbers::pi / 180)) {}

  [[nodiscard]] double reachX_m() const { return std::abs(cosine) * half_length_m + std::abs(sine) * half_width_m; }
  [[nodiscard]] double reachZ_m() const { return std::abs(sine) * half_length_m + std::abs(cosine) * half_width_m; }
  /// Returns half of its extent along a direction.
  [[nodiscard]] double reach_m(double direction_x, double direction_z) const {
    return std::abs(direction_x * cosine + direction_z * sine) * half_length_m +
           std::abs(direction_z * cosine - direction_x * sine) * half_width_m;
  }
};

/// A disc seen from above.
struct Disc {
  double x_m, z_m, radius_m;
};

/// Separating axis test: two rectangles are apart if their extents are apart along a side of one of them.
bool overlap(const Footprint& a, const Footprint& b) {
  const std::array<std::array<double, 2>, 4> axes = {
      {{a.cosine, a.sine}, {-a.sine, a.cosine}, {b.cosine, b.sine}, {-b.sine, b.cosine}}};
  return std::ranges::none_of(axes, [&](const std::array<double, 2>& axis) {
    const double distance_m = std::abs((b.x_m - a.x_m) * axis[0] + (b.z_m - a.z_m) * axis[1]);
    return distance_m >= a.reach_m(axis[0], axis[1]) + b.reach_m(axis[0], axis[1]);
  });
}

bool overlap(const Footprint& a, const Disc& disc) {
  const double dx = disc.x_m - a.x_m;
  const double dz = disc.z_m - a.z_m;
  const double along_m = std::max(0.0, std::abs(dx * a.cosine + dz * a.sine) - a.half_length_m);
  const double across_m = std::max(0.0, std::abs(dz * a.cosine - dx * a.sine) - a.half_width_m);
  return std::hypot(along_m, across_m) < disc.radius_m;
}

bool overlap(const Disc& disc, const Footprint& b) {
  return overlap(b, disc);
}

bool overlap(const Disc& a, const Disc& b) {
  return std::hypot(b.x_m - a.x_m, b.z_m - a.z_m) < a.radius_m + b.radius_m;
}

Footprint footprintOf(const core::Boat& boat) {
  return {boat.x_m, boat.z_m, boat.length_m, boat.beam_m, boat.heading_deg};
}

Footprint footprintOf(const v1::Breakwater& wall) {
  return {wall.x_m(), wall.z_m(), wall.length_m(), wall.width_m(), wall.heading_deg()};
}

/// Checks that a Footprint or a Disc lies in no obstacle.
template <typename Outline>
void checkFree(const Outline& outline, const v1::Scene& scene, const std::string& prefix,
               std::vector<FieldIssue>& issues) {
  for (int i = 0; i < scene.obstacles_size(); ++i) {
    const v1::Obstacle& obstacle = scene.obstacles(i);
    const v1::Rock& rock = obstacle.rock();
    const bool hits = obstacle.has_rock()         ? overlap(outline, Disc{rock.x_m(), rock.z_m(), rock.radius_m()})
                      : obstacle.has_breakwater() ? overlap(outline, footprintOf(obstacle.breakwater()))
                                                  : false;
    if (!hits) continue;
    addRange(issues, prefix + "x_m",
             metres(outline.x_m) + ", z " + metres(outline.z_m) + " lies in " + indexed("obstacles", i) +
                 "; choose a position in open water");
  }
}

void checkPair(v1::WaveBoundary minus, v1::WaveBoundary plus, const char* minus_path, const char* plus_path,
               std::vector<FieldIssue>& issues) {
  const bool minus_periodic = minus == v1::WAVE_BOUNDARY_PERIODIC;
  if (minus_periodic == (plus == v1::WAVE_BOUNDARY_PERIODIC)) return;
  const char* periodic_path = minus_periodic ? minus_path : plus_path;
  const char* other_path = minus_periodic ? plus_path : minus_path;
  addRange(issues, std::string("wave.") + other_path,
           v1::WaveBoundary_Name(minus_periodic ? plus : minus) + " is not periodic, but " + periodic_path +
               " is (also where it is left out); make both WAVE_BOUNDARY_PERIODIC or neither");
}

void checkSides(const v1::WaveScene& wave, std::vector<FieldIssue>& issues) {
  checkPair(wave.boundary_minus_x(), wave.boundary_plus_x(), "boundary_minus_x", "boundary_plus_x", issues);
  checkPair(wave.boundary_minus_z(), wave.boundary_plus_z(), "boundary_minus_z", "boundary_plus_z", issues);
  // A layer lies along the normal of its side.
  const core::WaveCells cells = waveCellsOf(wave);
  const bool absorbs_x =
      wave.boundary_minus_x() == v1::WAVE_BOUNDARY_ABSORB || wave.boundary_plus_x() == v1::WAVE_BOUNDARY_ABSORB;
  const bool absorbs_z =
      wave.boundary_minus_z() == v1::WAVE_BOUNDARY_ABSORB || wave.boundary_plus_z() == v1::WAVE_BOUNDARY_ABSORB;
  const double side_m = absorbs_x && absorbs_z ? std::min(cells.length_m, cells.width_m)
                        : absorbs_x            ? cells.length_m
                                               : cells.width_m;
  if (absorbs_x || absorbs_z) {
    checkAtMost(wave.sponge_width_m(), 0.5 * side_m, "wave.sponge_width_m",
                "is more than half the side of the water of " + metres(side_m), issues);
  }
}

void checkObstacles(const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  const core::WaveCells cells = waveCellsOf(scene.wave());
  const double side_m = std::min(cells.length_m, cells.width_m);
  for (int i = 0; i < scene.obstacles_size(); ++i) {
    const v1::Obstacle& obstacle = scene.obstacles(i);
    if (obstacle.has_rock()) {
      const std::string prefix = indexed("obstacles", i) + ".rock.";
      checkAtMost(obstacle.rock().radius_m(), 0.5 * side_m, prefix + "radius_m",
                  "is more than half the side of the water", issues);
      if (obstacle.rock().radius_m() > 0.5 * side_m) continue;
      checkInside(obstacle.rock().x_m(), obstacle.rock().radius_m(), cells.length_m, prefix + "x_m", issues);
      checkInside(obstacle.rock().z_m(), obstacle.rock().radius_m(), cells.width_m, prefix + "z_m", issues);
    } else if (obstacle.has_breakwater()) {
      const std::string prefix = indexed("obstacles", i) + ".breakwater.";
      const Footprint wall = footprintOf(obstacle.breakwater());
      checkInside(wall.x_m, wall.reachX_m(), cells.length_m, prefix + "x_m", issues);
      checkInside(wall.z_m, wall.reachZ_m(), cells.width_m, prefix + "z_m", issues);
    }
  }
}

void checkBeaches(const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  const v1::WaveScene& wave = scene.wave();
  for (int i = 0; i < scene.beaches_size(); ++i) {
    const v1::Beach& beach = scene.beaches(i);
    const std::string prefix = indexed("beaches", i) + ".";
    if (beach.side() == v1::SIDE_DIRECTION) {
      addRange(issues, prefix + "side", "SIDE_DIRECTION is for waves; a beach lies along one of the four sides");
      continue;
    }
    if (boundaryOf(wave, beach.side()) == v1::WAVE_BOUNDARY_PERIODIC) {
      addRange(issues, prefix + "side",
               v1::Side_Name(beach.side()) +
                   " is periodic, which has no shore; make it WAVE_BOUNDARY_REFLECT or "
                   "WAVE_BOUNDARY_ABSORB, and the opposite side too");
    }
    for (int k = 0; k < i; ++k) {
      if (scene.beaches(k).side() != beach.side()) continue;
      addRange(issues, prefix + "side",
               v1::Side_Name(beach.side()) + " has " + indexed("beaches", k) + " already; one per side");
    }
    const core::WaveCells cells = waveCellsOf(wave);
    const bool along_x = beach.side() != v1::SIDE_PLUS_Z && beach.side() != v1::SIDE_MINUS_Z;
    const double side_m = along_x ? cells.length_m : cells.width_m;
    checkAtMost(beach.width_m(), side_m, prefix + "width_m", "is more than the side of the water", issues);
    checkAtMost(beach.shore_depth_m(), wave.depth_m(), prefix + "shore_depth_m",
                "is deeper than the water of " + metres(wave.depth_m()), issues);
  }
}

void checkBedNumbers(const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  checkAtMost(scene.bed().floor_depth_m(), scene.wave().depth_m(), "bed.floor_depth_m",
              "is deeper than the water of " + metres(scene.wave().depth_m()), issues);
  for (int i = 0; i < scene.bed().shapes_size(); ++i) {
    const v1::BedShape& shape = scene.bed().shapes(i);
    if (shape.cone().crest_radius_m() <= shape.cone().toe_radius_m()) continue;
    addRange(issues, indexed("bed.shapes", i) + ".cone.crest_radius_m",
             metres(shape.cone().crest_radius_m()) + " is more than the toe radius of " +
                 metres(shape.cone().toe_radius_m()) + "; choose at most that");
  }
  const WaterExtents water = waterExtentsOf(scene);
  for (int i = 0; i < scene.gauges_size(); ++i) {
    checkPosition(scene.gauges(i).x_m(), water.side_x_m, indexed("gauges", i) + ".x_m", issues);
    checkPosition(scene.gauges(i).z_m(), water.side_z_m, indexed("gauges", i) + ".z_m", issues);
  }
}

void checkHull(const core::Boat& boat, const WaterExtents& water, const std::string& prefix,
               std::vector<FieldIssue>& issues) {
  const double max_length_m = std::min(kMaxBoatSideRatio * std::max(water.side_x_m, water.side_z_m),
                                       kMaxBoatWidthRatio * water.shorterSide_m());
  checkAtMost(boat.length_m, max_length_m, prefix + "length_m",
              "is more than a quarter of the water's length or half of its width of " + metres(water.side_x_m) + " x " +
                  metres(water.side_z_m),
              issues);
  checkAtMost(boat.beam_m, boat.length_m, prefix + "beam_m", "is more than the boat's length", issues);
  const double draught_m = boat.density_ratio * boat.height_m;
  if (draught_m >= water.depth_m) {
    addRange(issues, prefix + "height_m",
             metres(boat.height_m) + " at a density of " + core::formatNumber(boat.density_ratio) + " draws " +
                 metres(draught_m) + ", and the water is " + metres(water.depth_m) + " deep; choose less than " +
                 metres(water.depth_m / boat.density_ratio) + " or a lighter boat",
             kFittingDraughtRatio * water.depth_m / boat.density_ratio);
  }
}

void checkCapacity(int count, std::uint32_t capacity_count, const char* list, const char* what,
                   std::vector<FieldIssue>& issues) {
  if (count <= static_cast<int>(capacity_count)) return;
  addRange(issues, indexed(list, static_cast<int>(capacity_count)),
           std::to_string(count) + " " + what + " are more than the capacity_count of " +
               std::to_string(capacity_count) + "; remove some or raise it");
}

void checkFloaters(const v1::FloatersScene& floaters, const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  checkCapacity(floaters.floaters_size(), floaters.capacity_count(), "floaters.floaters", "objects", issues);
  const int count = std::min(floaters.floaters_size(), static_cast<int>(core::kMaxFloaters));
  for (int i = 0; i < count; ++i) {
    const std::string prefix = indexed("floaters.floaters", i) + ".";
    for (FieldIssue& issue : checkFloater(toCore(floaters.floaters(i)), scene, prefix))
      issues.push_back(std::move(issue));
  }
}

void checkBoats(const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  const v1::BoatsScene& boats = scene.boats();
  checkCapacity(boats.boats_size(), boats.capacity_count(), "boats.boats", "boats", issues);
  const int count = std::min(boats.boats_size(), static_cast<int>(core::kMaxBoats));
  for (int i = 0; i < count; ++i) {
    const core::Boat boat = toCore(boats.boats(i));
    const std::string prefix = indexed("boats.boats", i) + ".";
    for (FieldIssue& issue : checkBoat(boat, scene, prefix)) issues.push_back(std::move(issue));
    for (int k = 0; k < i; ++k) {
      if (!overlap(footprintOf(boat), footprintOf(toCore(boats.boats(k))))) continue;
      addRange(issues, prefix + "x_m",
               metres(boat.x_m) + ", z " + metres(boat.z_m) + " overlaps " + indexed("boats.boats", k) +
                   "; move one of them");
    }
  }
}

}  // namespace

void checkInside(double centre_m, double reach_m, double side_m, const std::string& path,
                 std::vector<FieldIssue>& issues) {
  const double max_m = 0.5 * side_m - reach_m;
  if (std::abs(centre_m) <= max_m + kEdgeToleranceRatio * side_m) return;
  if (max_m <= 0) {
    addRange(issues, path,
             "is " + metres(2 * reach_m) + " wide along this axis, more than the water's side of " + metres(side_m) +
                 "; make it smaller");
    return;
  }
  addRange(issues, path,
           metres(centre_m) + " puts it over the edge of the water; choose " + core::formatNumber(-max_m) + " to " +
               metres(max_m));
}

void checkDiscIsFree(double x_m, double z_m, double radius_m, const v1::Scene& scene, const std::string& prefix,
                     std::vector<FieldIssue>& issues) {
  checkFree(Disc{x_m, z_m, radius_m}, scene, prefix, issues);
}

v1::WaveBoundary boundaryOf(const v1::WaveScene& wave, v1::Side side) {
  switch (side) {
    case v1::SIDE_MINUS_X:
      return wave.boundary_minus_x();
    case v1::SIDE_PLUS_Z:
      return wave.boundary_plus_z();
    case v1::SIDE_MINUS_Z:
      return wave.boundary_minus_z();
    default:
      return wave.boundary_plus_x();
  }
}

core::WaveCells waveCellsOf(const v1::WaveScene& wave) {
  const google::protobuf::Descriptor& type = *v1::WaveScene::descriptor();
  const auto number = [&](const char* name) { return numberOf(wave, *type.FindFieldByName(name)); };
  return core::waveCellsOf(static_cast<std::uint32_t>(number("resolution_count")), number("side_m"), number("width_m"));
}

void checkCells(const v1::WaveScene& wave, std::vector<FieldIssue>& issues) {
  const core::WaveCells cells = waveCellsOf(wave);
  const double width_m = wave.width_m();
  if (!core::widthFits(cells, width_m)) {
    const double whole = std::floor(width_m / cells.cell_m);
    const std::string less = whole > 0 ? metres(whole * cells.cell_m) + " or " : "";
    addRange(issues, "wave.width_m",
             metres(width_m) + " is not a whole number of cells: side_m and resolution_count make them " +
                 metres(cells.cell_m) + " wide; choose " + less + metres((whole + 1) * cells.cell_m) +
                 ", or another resolution_count");
  }
  if (cells.count.z > core::kWaveMaxSideCount || cells.count.total() > core::kWaveMaxCellCount) {
    addRange(issues, "wave.resolution_count",
             std::to_string(cells.count.x) + " x " + std::to_string(cells.count.z) + " cells are more than " +
                 std::to_string(core::kWaveMaxSideCount) + " along z or " + std::to_string(core::kWaveMaxCellCount) +
                 " in all; choose fewer, or a smaller width_m");
  }
}

std::vector<FieldIssue> checkBoat(const core::Boat& boat, const v1::Scene& scene, const std::string& prefix) {
  std::vector<FieldIssue> issues;
  const WaterExtents water = waterExtentsOf(scene);
  checkHull(boat, water, prefix, issues);
  const Footprint hull = footprintOf(boat);
  checkInside(boat.x_m, hull.reachX_m(), water.side_x_m, prefix + "x_m", issues);
  checkInside(boat.z_m, hull.reachZ_m(), water.side_z_m, prefix + "z_m", issues);
  checkFree(hull, scene, prefix, issues);
  return issues;
}

std::vector<FieldIssue> checkFloater(const core::Floater& floater, const v1::Scene& scene, const std::string& prefix) {
  std::vector<FieldIssue> issues;
  const WaterExtents water = waterExtentsOf(scene);
  checkAtMost(floater.size_m, kMaxFloaterSideRatio * water.shorterSide_m(), prefix + "size_m",
              "is more than a quarter of the water's shorter side of " + metres(water.shorterSide_m()), issues);
  if (floater.density_ratio > 0 && floater.density_ratio < kMinFloaterDensity) {
    addRange(issues, prefix + "density_ratio",
             core::formatNumber(floater.density_ratio) + " is lighter than anything; choose at least " +
                 core::formatNumber(kMinFloaterDensity) + ", or 0 for what suits its kind",
             kMinFloaterDensity);
  }
  checkAtMost(floater.y_m, kMaxFloaterHeight_m, prefix + "y_m", "is too high above the rest level", issues);
  if (floater.y_m < -water.depth_m) {
    addRange(issues, prefix + "y_m",
             metres(floater.y_m) + " lies below the bed; choose at least " + metres(-water.depth_m));
  }
  // It may turn any way, so that it takes the disc of its longest extent.
  const Disc disc{floater.x_m, floater.z_m, floater.size_m / 2};
  checkInside(disc.x_m, disc.radius_m, water.side_x_m, prefix + "x_m", issues);
  checkInside(disc.z_m, disc.radius_m, water.side_z_m, prefix + "z_m", issues);
  checkFree(disc, scene, prefix, issues);
  return issues;
}

std::vector<FieldIssue> checkWater(const v1::Scene& scene) {
  std::vector<FieldIssue> issues;
  if (scene.has_wave()) {
    checkCells(scene.wave(), issues);
    checkSides(scene.wave(), issues);
    checkObstacles(scene, issues);
    checkBeaches(scene, issues);
    checkBedNumbers(scene, issues);
    checkMakerNumbers(scene, issues);
    checkFloaters(scene.floaters(), scene, issues);
    if (scene.has_course()) checkCourse(scene.course(), scene, issues);
  }
  if (scene.has_boats()) checkBoats(scene, issues);
  return issues;
}

}  // namespace spindrift::scene
