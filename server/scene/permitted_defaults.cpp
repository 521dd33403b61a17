// Defaults of effects, boats and floaters in commands, fitted to the water that they are for.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <google/protobuf/descriptor.h>

#include <spindrift/scene/scene_rules.h>

namespace spindrift::scene {
namespace {

/// Limits may follow from another field that was left out: that of a boat's beam from its length.
constexpr int kPassCount = 2;
/// Positions that are tried for a boat or a floater.
constexpr int kPlaceMaxCount = 400;
/// A finger in the water: its radius as a share of the shorter side; its depth in radii, or as a share of the water's.
constexpr double kFingerSides = 0.025, kFingerDepthRadii = 0.45, kFingerDepthRatio = 0.2;
/// Radius of a cloud or a calmed disc as a share of the shorter side.
constexpr double kDiscSides = 0.1;

/// `issues_of` returns the violations by the message; their paths end with the names of its fields.
template <typename Message, typename IssuesOf>
void complete(Message& message, const IssuesOf& issues_of) {
  const Message sent = message;
  fillMessageDefaults(message);
  for (int pass = 0; pass < kPassCount; ++pass) {
    for (const FieldIssue& issue : issues_of(message)) {
      const auto* field = Message::descriptor()->FindFieldByName(issue.path.substr(issue.path.rfind('.') + 1));
      if (!issue.nearest || Message::GetReflection()->HasField(sent, field)) continue;
      const v1::ParameterOptions& options = *parameterOptions(*field);
      setNumber(message, *field, std::clamp(*issue.nearest, options.min(), options.max()));
    }
  }
}

/// Moves a boat or a floater to the first permitted position on a spiral from the middle outward; leaves it where none
/// is found.
template <typename Message, typename IssuesOf>
void findPlace(Message& message, const v1::Scene& scene, const IssuesOf& issues_of) {
  const WaterExtents water = waterExtentsOf(scene);
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));  // fills the water evenly
  Message tried = message;
  for (int k = 0; k < kPlaceMaxCount; ++k) {
    const double out = std::sqrt(static_cast<double>(k) / kPlaceMaxCount);
    tried.set_x_m(0.5 * water.side_x_m * out * std::cos(k * golden_angle));
    tried.set_z_m(0.5 * water.side_z_m * out * std::sin(k * golden_angle));
    const std::vector<FieldIssue> issues = issues_of(tried);
    const auto is_of_place = [](const FieldIssue& issue) { return issue.path == "x_m" || issue.path == "z_m"; };
    if (!std::ranges::all_of(issues, is_of_place)) return;  // no position mends the others
    if (!issues.empty()) continue;
    message = std::move(tried);
    return;
  }
}

}  // namespace

void completeEffect(v1::Splash& splash, const v1::Scene& scene) {
  complete(splash, [&](const v1::Splash& filled) { return checkEffect(toCore(filled), scene); });
}

void completeEffect(v1::BreakingWave& wave, const v1::Scene& scene) {
  complete(wave, [&](const v1::BreakingWave& filled) { return checkEffect(toCore(filled), scene); });
}

void completeBoat(v1::Boat& boat, const v1::Scene& scene) {
  const bool has_place = boat.has_x_m() || boat.has_z_m();
  const auto issues_of = [&](const v1::Boat& filled) { return checkBoat(toCore(filled), scene, ""); };
  complete(boat, issues_of);
  if (!has_place) findPlace(boat, scene, issues_of);
}

void completeFloater(v1::Floater& floater, const v1::Scene& scene) {
  const bool has_place = floater.has_x_m() || floater.has_z_m();
  const bool has_height = floater.has_y_m();
  const auto issues_of = [&](const v1::Floater& filled) { return checkFloater(toCore(filled), scene, ""); };
  complete(floater, issues_of);
  if (!has_height) floater.set_y_m(floater.size_m() / 2);
  if (!has_place) findPlace(floater, scene, issues_of);
}

void completeStroke(v1::Stroke& stroke, const v1::Scene& scene) {
  const WaterExtents water = waterExtentsOf(scene);
  if (stroke.points_size() == 0 && !stroke.ends()) stroke.add_points();  // in the middle
  if (!stroke.has_radius_m())
    stroke.set_radius_m((isDisc(stroke.tool()) ? kDiscSides : kFingerSides) * water.shorterSide_m());
  if (!stroke.has_depth_m())
    stroke.set_depth_m(std::min(kFingerDepthRadii * stroke.radius_m(), kFingerDepthRatio * water.depth_m));
}

}  // namespace spindrift::scene
