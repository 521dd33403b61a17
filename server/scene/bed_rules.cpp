#include <cmath>
#include <set>
#include <string>

#include <spindrift/core/scene.h>
#include <spindrift/core/text.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>

#include "scene_parts.h"

namespace spindrift::scene {
namespace {

constexpr std::size_t kGaugeNameMaxBytes = 32;

using core::metres;

bool isGaugeName(const std::string& name) {
  return name.size() <= kGaugeNameMaxBytes && isSceneName(name);
}

}  // namespace

void checkBedStructure(const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  checkCount(scene.bed().shapes_size(), kSceneBedShapeMaxCount, "bed.shapes", "shapes", issues,
             "remove some, or give a grid");
  for (int i = 0; i < scene.bed().shapes_size(); ++i) {
    if (scene.bed().shapes(i).shape_case() != v1::BedShape::SHAPE_NOT_SET) continue;
    issues.push_back({v1::REJECT_REASON_MALFORMED, indexed("bed.shapes", i),
                      "has no shape; say what is there: \"cone {}\", \"slope {}\", \"sill {}\" or \"channel {}\""});
  }
  checkCount(scene.gauges_size(), static_cast<int>(core::kMaxGauges), "gauges", "gauges", issues);
  std::set<std::string> names;
  for (int i = 0; i < scene.gauges_size(); ++i) {
    const std::string& name = scene.gauges(i).name();
    const std::string shown = "\"" + core::quoteText(name, kGaugeNameMaxBytes) + "\"";
    if (!isGaugeName(name)) {
      addRange(issues, indexed("gauges", i) + ".name",
               shown + " is not a name; use 1 to 32 letters, digits, '_' and '-'");
    } else if (!names.insert(name).second) {
      addRange(issues, indexed("gauges", i) + ".name", shown + " names an earlier gauge, too; choose another name");
    }
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

}  // namespace spindrift::scene
