#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include <spindrift/core/text.h>

#include "scene_parts.h"

namespace spindrift::scene {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "DepthGrid.points are little-endian");

constexpr int kGridSideMinCount = 2;
constexpr int kGridSideMaxCount = static_cast<int>(kImageSideMaxCount);
constexpr double kDepthMax_m = 100.0;
constexpr double kLandMax_m = 9000.0;

void setPoints(v1::DepthGrid& grid, std::size_t columns, std::size_t rows, const std::vector<float>& depths_m) {
  for (std::size_t row = 0; row < rows; ++row)
    grid.add_points(depths_m.data() + row * columns, columns * sizeof(float));
}

/// Returns false if the number of points along a side is out of range.
bool checkSide(int count, const std::string& path, const char* what, std::vector<FieldIssue>& issues) {
  if (count >= kGridSideMinCount && count <= kGridSideMaxCount) return true;
  addRange(issues, path,
           std::to_string(count) + " " + what + "; choose " + std::to_string(kGridSideMinCount) + " to " +
               std::to_string(kGridSideMaxCount));
  return false;
}

void readRows(v1::DepthGrid& grid, std::vector<FieldIssue>& issues) {
  const int columns = grid.rows(0).depth_m_size();
  if (!checkSide(grid.rows_size(), "bed.grid.rows[0]", "rows", issues)) return;
  if (!checkSide(columns, "bed.grid.rows[0].depth_m", "numbers", issues)) return;
  std::vector<float> depths_m;
  for (int r = 0; r < grid.rows_size(); ++r) {
    const std::string path = indexed("bed.grid.rows", r);
    const auto& row = grid.rows(r).depth_m();
    if (row.size() != columns) {
      return addRange(issues, path,
                      std::to_string(row.size()) + " numbers, and the first row has " + std::to_string(columns) +
                          "; give every row the same number");
    }
    for (const float depth_m : row) {
      if (!(depth_m >= -kLandMax_m && depth_m <= kDepthMax_m)) {
        return addRange(issues, path,
                        core::formatNumber(depth_m) + " is not a depth; choose " + core::formatNumber(-kLandMax_m) +
                            " to " + core::formatQuantity(kDepthMax_m, "m"));
      }
      depths_m.push_back(depth_m);
    }
  }
  setPoints(grid, static_cast<std::size_t>(columns), static_cast<std::size_t>(grid.rows_size()), depths_m);
  grid.clear_rows();
}

void readImage(v1::DepthGrid& grid, const std::optional<fs::path>& folder, std::vector<FieldIssue>& issues) {
  constexpr const char* kPath = "bed.grid.png";
  const std::string shown = "\"" + core::quoteText(grid.png(), kNameEchoMaxBytes) + "\" ";
  const auto file = fileInFolder(folder, grid.png(), "rows");
  if (!file) return addRange(issues, kPath, shown + file.error().message);
  const auto image = readGrayPng(*file);
  if (!image) return addRange(issues, kPath, shown + image.error().message);
  if (!checkSide(static_cast<int>(image->width_count), kPath, "pixels along x", issues) ||
      !checkSide(static_cast<int>(image->height_count), kPath, "pixels along z", issues))
    return;
  std::vector<float> depths_m;
  depths_m.reserve(image->values.size());
  for (const std::uint16_t value : image->values)
    depths_m.push_back(static_cast<float>(std::lerp(grid.black_depth_m(), grid.white_depth_m(), value / 65535.0)));
  setPoints(grid, image->width_count, image->height_count, depths_m);
}

}  // namespace

void readDepthGrid(v1::DepthGrid& grid, const std::optional<fs::path>& folder, std::vector<FieldIssue>& issues) {
  if (grid.points_size() > 0) {
    issues.push_back({v1::REJECT_REASON_MALFORMED, "bed.grid.points",
                      "is what the server makes of rows or png; remove it and give one of these"});
  } else if (grid.rows_size() > 0 && !grid.png().empty()) {
    issues.push_back({v1::REJECT_REASON_MALFORMED, "bed.grid.png", "and rows are both given; remove one of them"});
  } else if (grid.rows_size() > 0) {
    readRows(grid, issues);
  } else if (!grid.png().empty()) {
    readImage(grid, folder, issues);
  } else {
    issues.push_back(
        {v1::REJECT_REASON_MALFORMED, "bed.grid", "has no depths; give rows { depth_m: [...] } or the name of a png"});
  }
}

}  // namespace spindrift::scene
