#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <spindrift/core/text.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>

#include "scene_parts.h"

namespace spindrift::scene {
namespace {

/// Maximum depression or crest over the depth; beyond it the bed would fall dry or the wave equation become invalid.
constexpr double kMaxEffectDepthRatio = 0.9;
constexpr int kStrokePointMaxCount = 64;
/// Largest finger: its radius over the shorter side of the water (twice that for a disc), and its depth over the
/// water's and over the radius.
constexpr double kStrokeMaxRadiusSides = 0.125, kStrokeMaxDepthRatio = 1.0 / 3.0, kStrokeMaxDepthRadii = 0.5;
constexpr std::size_t kNameMaxBytes = 64;
constexpr std::size_t kGaugeNameMaxBytes = 32;
constexpr std::size_t kTitleMaxBytes = 200;
constexpr std::size_t kDescriptionMaxBytes = 4000;

using core::metres;

void checkHeight(double value_m, double depth_m, const std::string& path, std::vector<FieldIssue>& issues) {
  const double max_m = kMaxEffectDepthRatio * depth_m;
  if (value_m <= max_m) return;
  addRange(issues, path,
           metres(value_m) + " is above " + metres(max_m) + ", 0.9 of the water's depth of " + metres(depth_m) +
               "; choose at most " + metres(max_m) + " or a deeper water",
           max_m);
}

void checkPatch(double shift_m, double scale, double side_m, const std::string& path, std::vector<FieldIssue>& issues) {
  const double reach_m = 0.5 * side_m * (1.0 - scale);
  if (std::abs(shift_m) <= reach_m + kEdgeToleranceRatio * side_m) return;
  addRange(issues, path,
           metres(shift_m) + " pushes the particle patch over the edge of the water; choose " +
               core::formatNumber(reach_m > 0 ? -reach_m : 0) + " to " + metres(reach_m) + " or a smaller patch_scale");
}

void checkText(const std::string& text, std::size_t max_bytes, const std::string& path,
               std::vector<FieldIssue>& issues) {
  if (text.size() > max_bytes) {
    addRange(issues, path,
             std::to_string(text.size()) + " bytes are more than " + std::to_string(max_bytes) + "; shorten the text");
  }
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = core::utf8SequenceLength(text, at);
    if (length == 0) {
      addRange(issues, path, "byte " + std::to_string(at) + " is not UTF-8; save the file as UTF-8");
      return;
    }
    at += length;
  }
}

void checkParts(const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  if (!scene.has_wave() && !scene.has_particles()) {
    addAbsent(issues, "wave", "missing, and so is particles; a scene needs at least one of them: add \"wave {}\"");
  }
  if (scene.has_coupling() && !scene.has_wave()) {
    addAbsent(issues, "coupling", "needs a wave; add \"wave {}\" or remove coupling");
  }
  if (scene.has_coupling() && !scene.has_particles()) {
    addAbsent(issues, "coupling", "needs particles; add \"particles {}\" or remove coupling");
  }
  if (scene.has_foam() && !scene.has_particles() && !scene.foam().surface()) {
    addAbsent(
        issues, "foam",
        "needs particles, or a field on the surface; add \"particles {}\", say \"surface: true\" where there is a "
        "wave, or remove foam");
  }
  if (scene.foam().surface() && !scene.has_wave()) {
    addAbsent(issues, "foam.surface", "needs a wave; add \"wave {}\" or remove surface");
  }
  if (scene.coupling().patch_follow() == v1::PATCH_FOLLOW_BOAT && !scene.has_boats()) {
    addAbsent(issues, "coupling.patch_follow",
              "PATCH_FOLLOW_BOAT needs boats; add \"boats {}\" or follow something else");
  }
  if (scene.has_course() && !scene.has_boats())
    addAbsent(issues, "course", "needs boats; add \"boats {}\" or remove course");
  if (scene.course().has_red_goal() != scene.course().has_blue_goal()) {
    const bool has_red = scene.course().has_red_goal();
    addAbsent(issues, has_red ? "course.blue_goal" : "course.red_goal",
              std::string("missing beside ") + (has_red ? "red_goal" : "blue_goal") + "; add it, or remove both");
  }
  if (scene.has_wave()) return;
  if (scene.setting() == v1::SETTING_OPEN_SEA) {
    addAbsent(issues, "setting",
              "SETTING_OPEN_SEA needs a wave; add \"wave {}\" or choose SETTING_POOL, SETTING_GLASS_TANK or "
              "SETTING_FLUME");
  }
  const auto needsWave = [&](const char* path, const std::string& part) {
    addAbsent(issues, path, "needs a wave; add \"wave {}\" or remove " + part);
  };
  if (scene.obstacles_size() > 0) needsWave("obstacles[0]", "the obstacles");
  if (scene.beaches_size() > 0) needsWave("beaches[0]", "the beaches");
  if (scene.has_storm()) needsWave("storm", "storm");
  if (scene.has_floaters()) needsWave("floaters", "floaters");
  if (scene.has_course()) needsWave("course", "course");
  if (scene.has_bed()) needsWave("bed", "bed");
  if (scene.gauges_size() > 0) needsWave("gauges[0]", "the gauges");
  if (scene.wave_makers_size() > 0) needsWave("wave_makers[0]", "the wave-makers");
}

void checkLists(const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  checkCount(scene.obstacles_size(), kSceneObstacleMaxCount, "obstacles", "obstacles", issues);
  checkCount(scene.beaches_size(), kSceneBeachMaxCount, "beaches", "beaches", issues);
  checkCount(scene.wave_makers_size(), kSceneWaveMakerMaxCount, "wave_makers", "wave-makers", issues);
  checkCount(scene.boats().boats_size(), static_cast<int>(core::kMaxBoats), "boats.boats", "boats", issues);
  checkCount(scene.floaters().floaters_size(), static_cast<int>(core::kMaxFloaters), "floaters.floaters", "objects",
             issues);
  checkCount(scene.course().marks_size(), kSceneMarkMaxCount, "course.marks", "marks", issues);
  for (int i = 0; i < scene.obstacles_size(); ++i) {
    if (scene.obstacles(i).shape_case() != v1::Obstacle::SHAPE_NOT_SET) continue;
    issues.push_back({v1::REJECT_REASON_MALFORMED, indexed("obstacles", i),
                      "has no shape; say what stands there: \"rock {}\" or \"breakwater {}\""});
  }
}

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
    if (name.size() > kGaugeNameMaxBytes || !isSceneName(name)) {
      addRange(issues, indexed("gauges", i) + ".name",
               shown + " is not a name; use 1 to 32 letters, digits, '_' and '-'");
    } else if (!names.insert(name).second) {
      addRange(issues, indexed("gauges", i) + ".name", shown + " names an earlier gauge, too; choose another name");
    }
  }
}

void checkEventNumbers(const v1::TimedEvent& event, const v1::Scene& scene, const std::string& prefix,
                       std::vector<FieldIssue>& issues) {
  const double tick_s = 1.0 / scene.tick_rate_hz();
  if (event.every_s() > 0 && event.every_s() < tick_s) {
    addRange(issues, prefix + "every_s",
             core::formatQuantity(event.every_s(), "s") + " is shorter than a tick of " +
                 core::formatQuantity(tick_s, "s") + "; choose 0 (once) or at least a tick");
  }
  if (event.effect().effect_case() == v1::Effect::EFFECT_NOT_SET) return;
  for (FieldIssue& issue : checkEffect(toCore(event.effect()), scene)) {
    issue.path = prefix + "effect." + issue.path;
    issues.push_back(std::move(issue));
  }
}

/// Returns the side length of the water along which a wave from there runs. A wave in a direction, or from the side
/// that the water decides, may run along either.
double sideAlong(std::optional<core::Side> side, const WaterExtents& water) {
  if (side == core::Side::kPlusX || side == core::Side::kMinusX) return water.side_x_m;
  if (side == core::Side::kPlusZ || side == core::Side::kMinusZ) return water.side_z_m;
  return water.shorterSide_m();
}

}  // namespace

void checkCount(int count, int max_count, const char* path, const char* what, std::vector<FieldIssue>& issues,
                const char* advice) {
  if (count <= max_count) return;
  addRange(issues, indexed(path, max_count),
           std::to_string(count) + " " + what + " are more than " + std::to_string(max_count) + "; " + advice);
}

void checkAtMost(double value_m, double max_m, const std::string& path, const std::string& what,
                 std::vector<FieldIssue>& issues) {
  if (value_m > max_m)
    addRange(issues, path, metres(value_m) + " " + what + "; choose at most " + metres(max_m), max_m);
}

void checkPosition(double value_m, double side_m, const std::string& path, std::vector<FieldIssue>& issues) {
  if (std::abs(value_m) <= 0.5 * side_m) return;
  addRange(issues, path,
           metres(value_m) + " lies outside of the water; choose " + core::formatNumber(-0.5 * side_m) + " to " +
               metres(0.5 * side_m));
}

WaterExtents waterExtentsOf(const v1::Scene& scene) {
  if (scene.has_wave()) {
    const core::WaveCells cells = waveCellsOf(scene.wave());
    return {cells.length_m, cells.width_m, scene.wave().depth_m()};
  }
  const v1::ParticleScene& p = scene.particles();
  const double width_m = p.box_width_m() > 0 ? p.box_width_m() : p.box_side_m();
  const double area_m2 = p.box_side_m() * p.fill_x_ratio() * width_m * p.fill_z_ratio();
  return {p.box_side_m(), width_m, p.layers_count() * std::sqrt(area_m2 * p.layers_count() / std::max(p.count(), 1u))};
}

bool isSceneName(const std::string& name) {
  const char* const allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  return !name.empty() && name.size() <= kNameMaxBytes && name.find_first_not_of(allowed) == std::string::npos;
}

std::vector<FieldIssue> checkEffect(const core::Effect& effect, const v1::Scene& scene) {
  std::vector<FieldIssue> issues;
  const WaterExtents water = waterExtentsOf(scene);
  if (const auto* splash = std::get_if<core::Splash>(&effect)) {
    checkPosition(splash->x_m, water.side_x_m, "splash.x_m", issues);
    checkPosition(splash->z_m, water.side_z_m, "splash.z_m", issues);
    checkAtMost(splash->radius_m, 0.5 * water.shorterSide_m(), "splash.radius_m",
                "is more than half the side of the water", issues);
    checkHeight(splash->depth_m, water.depth_m, "splash.depth_m", issues);
  } else {
    const auto& wave = std::get<core::BreakingWave>(effect);
    checkHeight(wave.amplitude_m, water.depth_m, "breaking_wave.amplitude_m", issues);
    checkAtMost(wave.length_m, sideAlong(wave.side, water), "breaking_wave.length_m",
                "is more than the side of the water", issues);
    checkPosition(wave.x_m, water.side_x_m, "breaking_wave.x_m", issues);
    checkPosition(wave.z_m, water.side_z_m, "breaking_wave.z_m", issues);
    if (wave.width_m > 0 && wave.side != core::Side::kDirection) {
      addRange(issues, "breaking_wave.width_m",
               metres(wave.width_m) + " is for waves with SIDE_DIRECTION; choose that side, or leave the width out");
    }
  }
  return issues;
}

bool isDisc(v1::StrokeTool tool) {
  return tool == v1::STROKE_TOOL_RAIN || tool == v1::STROKE_TOOL_CALM;
}

std::vector<FieldIssue> checkStroke(const v1::Stroke& stroke, const v1::Scene& scene) {
  std::vector<FieldIssue> issues;
  const WaterExtents water = waterExtentsOf(scene);
  if (stroke.points_size() > kStrokePointMaxCount) {
    addRange(issues, "stroke.points",
             std::to_string(stroke.points_size()) + " points are more than " + std::to_string(kStrokePointMaxCount) +
                 "; send them in several messages");
    return issues;
  }
  for (int k = 0; k < stroke.points_size(); ++k) {
    const std::string path = indexed("stroke.points", k) + ".";
    checkPosition(stroke.points(k).x_m(), water.side_x_m, path + "x_m", issues);
    checkPosition(stroke.points(k).z_m(), water.side_z_m, path + "z_m", issues);
    if (k > 0 && stroke.points(k).time_s() <= stroke.points(k - 1).time_s()) {
      addRange(issues, path + "time_s",
               core::formatQuantity(stroke.points(k).time_s(), "s") + " is not later than the point before; send the " +
                   "points in the order of their times");
    }
  }
  const bool is_disc = isDisc(stroke.tool());
  checkAtMost(
      stroke.radius_m(), (is_disc ? 2 : 1) * kStrokeMaxRadiusSides * water.shorterSide_m(), "stroke.radius_m",
      is_disc ? "is more than a quarter of the side of the water" : "is more than an eighth of the side of the water",
      issues);
  checkAtMost(stroke.depth_m(), kStrokeMaxDepthRatio * water.depth_m, "stroke.depth_m",
              "is more than a third of the water's depth", issues);
  checkAtMost(stroke.depth_m(), kStrokeMaxDepthRadii * stroke.radius_m(), "stroke.depth_m",
              "is more than half the radius", issues);
  return issues;
}

std::vector<FieldIssue> checkPlace(double x_m, double z_m, const v1::Scene& scene, const std::string& prefix) {
  std::vector<FieldIssue> issues;
  const WaterExtents water = waterExtentsOf(scene);
  checkPosition(x_m, water.side_x_m, prefix + "x_m", issues);
  checkPosition(z_m, water.side_z_m, prefix + "z_m", issues);
  return issues;
}

std::vector<FieldIssue> checkStructure(const v1::Scene& scene) {
  std::vector<FieldIssue> issues;
  if (!isSceneName(scene.name())) {
    addRange(
        issues, "name",
        "\"" + core::quoteText(scene.name(), kNameMaxBytes) +
            "\" is not a name; use 1 to 64 letters, digits, '_' and '-' (the file's name counts where it is left out)");
  }
  checkText(scene.title(), kTitleMaxBytes, "title", issues);
  checkText(scene.description(), kDescriptionMaxBytes, "description", issues);
  checkParts(scene, issues);
  checkLists(scene, issues);
  checkBedStructure(scene, issues);
  checkMakerStructure(scene, issues);
  checkCount(scene.events_size(), kSceneEventMaxCount, "events", "events", issues,
             "remove some, or repeat one with every_s");
  for (int i = 0; i < scene.events_size(); ++i) {
    if (scene.events(i).effect().effect_case() != v1::Effect::EFFECT_NOT_SET) continue;
    issues.push_back({v1::REJECT_REASON_MALFORMED, indexed("events", i) + ".effect",
                      "missing; say what happens: \"effect { splash {} }\" or \"effect { breaking_wave {} }\""});
  }
  return issues;
}

std::vector<FieldIssue> checkNumbers(const v1::Scene& scene) {
  std::vector<FieldIssue> issues;
  // The range is 3 to 5. The lattice needs a point under the particle, so the count must be odd.
  if (scene.coupling().lattice_count() == 4) addRange(issues, "coupling.lattice_count", "4 is even; choose 3 or 5");
  if (scene.has_particles()) {
    const v1::ParticleScene& particles = scene.particles();
    const double side_x_m = scene.has_wave() ? waveCellsOf(scene.wave()).length_m : particles.box_side_m();
    const double side_z_m = scene.has_wave() ? waveCellsOf(scene.wave()).width_m : particles.box_side_m();
    checkPatch(particles.patch_shift_x_m(), particles.patch_scale(), side_x_m, "particles.patch_shift_x_m", issues);
    checkPatch(particles.patch_shift_z_m(), particles.patch_scale(), side_z_m, "particles.patch_shift_z_m", issues);
  }
  constexpr double kLeastRestart_s = 1.0;
  if (scene.restart_after_s() > 0 && scene.restart_after_s() < kLeastRestart_s) {
    addRange(issues, "restart_after_s",
             core::formatQuantity(scene.restart_after_s(), "s") + " is too short; choose 0 (never) or at least " +
                 core::formatQuantity(kLeastRestart_s, "s"));
  }
  for (FieldIssue& issue : checkWater(scene)) issues.push_back(std::move(issue));
  for (int i = 0; i < scene.events_size(); ++i)
    checkEventNumbers(scene.events(i), scene, indexed("events", i) + ".", issues);
  return issues;
}

}  // namespace spindrift::scene
