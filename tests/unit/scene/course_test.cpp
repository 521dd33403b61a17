// Rules of a course: marks that can be passed one after the other, goals in the water.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene_error.h"

namespace spindrift::scene {
namespace {

using testing::HasSubstr;

std::string errorOfCourse(const std::string& course, const std::string& parts = "boats {}") {
  return errorOf(
      "wave { side_m: 40 width_m: 20 resolution_count: 64 depth_m: 2 boundary_minus_x: WAVE_BOUNDARY_REFLECT "
      "boundary_plus_x: WAVE_BOUNDARY_REFLECT boundary_minus_z: WAVE_BOUNDARY_REFLECT boundary_plus_z: "
      "WAVE_BOUNDARY_REFLECT }\nobstacles { rock { x_m: 15 radius_m: 2 } }\n" +
      parts + "\ncourse { " + course + " }\n");
}

constexpr const char* kLoaded = "(the scene loaded)";

TEST(Course, OfMarksAndGoalsInTheWaterLoads) {
  EXPECT_EQ(errorOfCourse("marks { x_m: 5 } marks { x_m: -5 } red_goal { x_m: -18 } blue_goal { x_m: 12 }"), kLoaded);
  EXPECT_EQ(errorOfCourse("red_goal { x_m: -18 } blue_goal { x_m: 12 }"), kLoaded);
}

TEST(Course, NeedsBoatsAndSidesThatAreClosed) {
  EXPECT_THAT(errorOfCourse("", ""), HasSubstr("course: needs boats"));
  EXPECT_THAT(errorOf("wave {}\nboats {}\ncourse {}\n"), HasSubstr("periodic"));
}

TEST(Course, MarksLieInTheWaterAndApart) {
  EXPECT_THAT(errorOfCourse("marks { x_m: 5 }"), HasSubstr("only mark"));
  EXPECT_THAT(errorOfCourse("marks { x_m: 25 } marks {}"), HasSubstr("course.marks[0].x_m"));
  EXPECT_THAT(errorOfCourse("marks { x_m: 15 } marks {}"), HasSubstr("obstacles[0]")) << "on land";
  EXPECT_THAT(errorOfCourse("marks { x_m: 3 } marks { x_m: -3 }"), HasSubstr("between them"));
  std::string many;
  for (int k = 0; k < 17; ++k) many += "marks {} ";
  EXPECT_THAT(errorOfCourse(many), HasSubstr("17 marks are more than 16"));
}

TEST(Course, GoalsAreTwoInTheWaterWithTheBallBetweenThem) {
  EXPECT_THAT(errorOfCourse("red_goal {}"), HasSubstr("course.blue_goal: missing"));
  EXPECT_THAT(errorOfCourse("red_goal { x_m: -19.5 length_m: 3 } blue_goal { x_m: 12 }"),
              HasSubstr("course.red_goal.x_m"));
  EXPECT_THAT(errorOfCourse("red_goal { x_m: -1 } blue_goal { x_m: 1 length_m: 6 }"), HasSubstr("too near"));
}

}  // namespace
}  // namespace spindrift::scene
