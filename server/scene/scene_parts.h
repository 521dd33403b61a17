// Parts of a scene: their rules, and what they read from files. Called by the loader, checkStructure() and
// checkWater().
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/scene/fields.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::scene {

/// Most bytes of a file's name in an error.
inline constexpr std::size_t kNameEchoMaxBytes = 200;

/// Returns "events[3]".
inline std::string indexed(const char* list, int index) {
  return std::string(list) + "[" + std::to_string(index) + "]";
}

/// Checks the length of a list; `advice` says what to do.
void checkCount(int count, int max_count, const char* path, const char* what, std::vector<FieldIssue>& issues,
                const char* advice = "remove some");

/// Checks that a point lies in the water along one axis.
void checkPosition(double value_m, double side_m, const std::string& path, std::vector<FieldIssue>& issues);

/// Checks that an object with the half extent `reach_m` around its centre lies in the water along one axis.
void checkInside(double centre_m, double reach_m, double side_m, const std::string& path,
                 std::vector<FieldIssue>& issues);

/// Checks that a disc lies in no obstacle.
void checkDiscIsFree(double x_m, double z_m, double radius_m, const v1::Scene& scene, const std::string& prefix,
                     std::vector<FieldIssue>& issues);

/// Checks a length; `what` says of one that is too long what it is: "is more than the side of the water".
void checkAtMost(double value_m, double max_m, const std::string& path, const std::string& what,
                 std::vector<FieldIssue>& issues);

/// Waves of wave-makers that are missing or excluded by each other.
void checkMakerStructure(const v1::Scene& scene, std::vector<FieldIssue>& issues);

/// Wave-makers: sides, heights over the depth, and series, in a scene with a wave. Rules that need the waves' lengths
/// are those of sim::derive().
void checkMakerNumbers(const v1::Scene& scene, std::vector<FieldIssue>& issues);

/// Marks and goals of a course, in a scene with a wave.
void checkCourse(const v1::Course& course, const v1::Scene& scene, std::vector<FieldIssue>& issues);

/// Returns where a file lies that a scene names: in the folder of the scene or below, links followed. `folder`: nullopt
/// for scenes that are not files; `instead` says what those give in place of a name. Error: kInvalidInput.
core::Result<std::filesystem::path> fileInFolder(const std::optional<std::filesystem::path>& folder,
                                                 const std::filesystem::path& name, const std::string& instead);

/// Fills `grid.points` from its rows or its PNG, and removes the rows. `folder`: as for fileInFolder(). Adds what is
/// wrong to `issues`, with paths that start with "bed.grid".
void readDepthGrid(v1::DepthGrid& grid, const std::optional<std::filesystem::path>& folder,
                   std::vector<FieldIssue>& issues);

/// Larger images are refused before their pixels are read.
inline constexpr std::uint32_t kImageSideMaxCount = 1024;

/// A 16-bit grayscale image.
struct GrayImage {
  std::uint32_t width_count = 0;
  std::uint32_t height_count = 0;
  std::vector<std::uint16_t> values;  ///< width * height, the upper row first
};

/// Reads a 16-bit grayscale PNG. Errors: those of openFile(); kInvalidInput with the reason, without the file's name:
/// too big, no PNG, damaged, of another kind than 16-bit grayscale without transparency.
core::Result<GrayImage> readGrayPng(const std::filesystem::path& file);

/// Adds the numbers of the files that series of wave-makers name. `folder`: as for fileInFolder(). Adds what is wrong
/// to `issues`.
void readSeries(v1::Scene& scene, const std::optional<std::filesystem::path>& folder, std::vector<FieldIssue>& issues);

}  // namespace spindrift::scene
