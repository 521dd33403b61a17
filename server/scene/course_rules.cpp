// Rules between the water and the course of a scene: its marks, start and goals.
#include <algorithm>
#include <cmath>
#include <string>

#include <spindrift/core/text.h>
#include <spindrift/scene/scene_rules.h>

#include "scene_parts.h"

namespace spindrift::scene {
namespace {

using core::metres;

/// Marks are passed one after the other, so the discs of neighbours must not touch.
void checkMarks(const v1::Course& course, const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  constexpr double kBuoyRadius_m = 0.3;
  const WaterExtents water = waterExtentsOf(scene);
  const int count = course.marks_size();
  if (count == 1)
    addRange(issues, "course.marks[0]", "is the only mark; a lap needs at least two, so add another or remove it");
  for (int i = 0; i < count; ++i) {
    const v1::CourseMark& mark = course.marks(i);
    const std::string prefix = indexed("course.marks", i) + ".";
    checkInside(mark.x_m(), kBuoyRadius_m, water.side_x_m, prefix + "x_m", issues);
    checkInside(mark.z_m(), kBuoyRadius_m, water.side_z_m, prefix + "z_m", issues);
    checkDiscIsFree(mark.x_m(), mark.z_m(), kBuoyRadius_m, scene, prefix, issues);
    const v1::CourseMark& next = course.marks((i + 1) % count);
    const double distance_m = std::hypot(next.x_m() - mark.x_m(), next.z_m() - mark.z_m());
    if (count == 1 || distance_m > mark.radius_m() + next.radius_m()) continue;
    addRange(issues, prefix + "radius_m",
             metres(mark.radius_m()) + " and the " + metres(next.radius_m()) + " of " +
                 indexed("course.marks", (i + 1) % count) + " reach over the " + metres(distance_m) +
                 " between them; choose less, or put them further apart");
  }
}

void checkGoals(const v1::Course& course, const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  const WaterExtents water = waterExtentsOf(scene);
  const v1::CourseGoal& red = course.red_goal();
  const v1::CourseGoal& blue = course.blue_goal();
  for (const bool is_red : {true, false}) {
    const v1::CourseGoal& goal = is_red ? red : blue;
    const std::string prefix = is_red ? "course.red_goal." : "course.blue_goal.";
    checkInside(goal.x_m(), 0.5 * goal.length_m(), water.side_x_m, prefix + "x_m", issues);
    checkInside(goal.z_m(), 0.5 * goal.width_m(), water.side_z_m, prefix + "z_m", issues);
  }
  // The ball lies in the middle of both.
  const double away_x_m = 0.5 * std::abs(red.x_m() - blue.x_m());
  const double away_z_m = 0.5 * std::abs(red.z_m() - blue.z_m());
  const bool is_between = away_x_m > 0.5 * std::max(red.length_m(), blue.length_m()) ||
                          away_z_m > 0.5 * std::max(red.width_m(), blue.width_m());
  if (!is_between)
    addRange(issues, "course.blue_goal.x_m",
             metres(blue.x_m()) +
                 " is too near to red_goal: the middle between them, where the ball begins, lies in a "
                 "goal; put them further apart");
}

}  // namespace

void checkCourse(const v1::Course& course, const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  const WaterExtents water = waterExtentsOf(scene);
  for (const v1::Side side : {v1::SIDE_PLUS_X, v1::SIDE_PLUS_Z}) {
    if (boundaryOf(scene.wave(), side) != v1::WAVE_BOUNDARY_PERIODIC) continue;
    const bool along_x = side == v1::SIDE_PLUS_X;
    addRange(issues, std::string("wave.boundary_plus_") + (along_x ? "x" : "z"),
             "is periodic, and a boat that crosses it would leave the course; make both sides WAVE_BOUNDARY_REFLECT or "
             "WAVE_BOUNDARY_ABSORB, or remove course");
  }
  checkPosition(course.start_x_m(), water.side_x_m, "course.start_x_m", issues);
  checkPosition(course.start_z_m(), water.side_z_m, "course.start_z_m", issues);
  checkMarks(course, scene, issues);
  if (course.has_red_goal() && course.has_blue_goal()) checkGoals(course, scene, issues);
}

}  // namespace spindrift::scene
