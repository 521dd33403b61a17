#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include <spindrift/core/files.h>
#include <spindrift/core/text.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>

#include "scene_parts.h"

namespace spindrift::scene {
namespace {

namespace fs = std::filesystem;

/// Height of the highest solitary wave over the depth (McCowan 1894). Higher waves break at the maker.
constexpr double kMaxHeightRatio = 0.78;
/// Significant height over depth, at most: the highest of many waves is about twice as high.
constexpr double kMaxSignificantRatio = 0.4;
constexpr double kSeriesMaxTime_s = 86400.0;
constexpr std::size_t kSeriesFileMaxBytes = 1024 * 1024;
constexpr std::size_t kLineEchoMaxBytes = 60;

using core::metres;

std::string makerPath(int index) {
  return indexed("wave_makers", index);
}

void checkHeight(double height_m, double ratio, double depth_m, const std::string& path,
                 std::vector<FieldIssue>& issues) {
  if (height_m <= ratio * depth_m) return;
  addRange(issues, path,
           metres(height_m) + " is more than " + core::formatNumber(ratio) + " of the water's depth of " +
               metres(depth_m) + ", where waves break; choose at most " + metres(ratio * depth_m));
}

void checkSide(const v1::Scene& scene, int index, std::vector<FieldIssue>& issues) {
  const v1::Side side = scene.wave_makers(index).side();
  const std::string path = makerPath(index) + ".side";
  if (side == v1::SIDE_DIRECTION)
    return addRange(issues, path, "SIDE_DIRECTION is for effects; a wave-maker is one of the four sides");
  if (boundaryOf(scene.wave(), side) != v1::WAVE_BOUNDARY_REFLECT) {
    addRange(issues, path,
             v1::Side_Name(side) + " is " + v1::WaveBoundary_Name(boundaryOf(scene.wave(), side)) +
                 "; a wave-maker needs a wall, and takes up waves by itself: make it WAVE_BOUNDARY_REFLECT, and the "
                 "opposite side not periodic");
  }
  for (int k = 0; k < index; ++k) {
    if (scene.wave_makers(k).side() != side) continue;
    addRange(issues, path, v1::Side_Name(side) + " has " + makerPath(k) + " already; one per side");
  }
}

void checkSeries(const v1::ElevationSeries& series, double depth_m, const std::string& path,
                 std::vector<FieldIssue>& issues) {
  const int count = series.time_s_size();
  if (count == 0 && !series.file().empty()) return;  // the file has been refused
  if (count != series.elevation_m_size()) {
    return addRange(issues, path + ".elevation_m",
                    std::to_string(series.elevation_m_size()) + " elevations at " + std::to_string(count) +
                        " times; give the same number of both");
  }
  if (count < 2 || count > kSceneSeriesRowMaxCount) {
    return addRange(issues, path + ".time_s",
                    std::to_string(count) + " rows; choose 2 to " + std::to_string(kSceneSeriesRowMaxCount));
  }
  for (int k = 0; k < count; ++k) {
    const double time_s = series.time_s(k);
    const std::string at = indexed("", k);
    if (!(time_s >= 0.0 && time_s <= kSeriesMaxTime_s)) {
      return addRange(issues, path + ".time_s" + at,
                      core::formatQuantity(time_s, "s") + " is not a time of a series; choose 0 to " +
                          core::formatQuantity(kSeriesMaxTime_s, "s"));
    }
    if (k > 0 && time_s <= series.time_s(k - 1)) {
      return addRange(issues, path + ".time_s" + at,
                      core::formatQuantity(time_s, "s") + " is not after the time before, " +
                          core::formatQuantity(series.time_s(k - 1), "s") + "; sort the rows by time");
    }
    if (!(std::abs(series.elevation_m(k)) <= kMaxHeightRatio * depth_m)) {
      return addRange(issues, path + ".elevation_m" + at,
                      metres(series.elevation_m(k)) + " is beyond " + core::formatNumber(kMaxHeightRatio) +
                          " of the water's depth of " + metres(depth_m) + "; choose " +
                          core::formatNumber(-kMaxHeightRatio * depth_m) + " to " + metres(kMaxHeightRatio * depth_m));
    }
  }
}

void checkWaves(const v1::WaveMaker& maker, double depth_m, const std::string& path, std::vector<FieldIssue>& issues) {
  checkHeight(maker.regular().height_m(), kMaxHeightRatio, depth_m, path + ".regular.height_m", issues);
  checkHeight(maker.irregular().significant_height_m(), kMaxSignificantRatio, depth_m,
              path + ".irregular.significant_height_m", issues);
  checkHeight(maker.solitary().height_m(), kMaxHeightRatio, depth_m, path + ".solitary.height_m", issues);
  if (maker.has_series()) checkSeries(maker.series(), depth_m, path + ".series", issues);
}

/// Reads two numbers; false if the line has something else.
bool readRow(std::string_view line, double& time_s, double& elevation_m) {
  constexpr const char* kBlank = " \t\r,;";
  for (double* number : {&time_s, &elevation_m}) {
    const std::size_t begin = line.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) return false;
    line.remove_prefix(begin);
    if (line.size() > 1 && line[0] == '+') line.remove_prefix(1);
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), *number);
    if (error != std::errc() || !std::isfinite(*number)) return false;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    if (number == &time_s && (line.empty() || line.find_first_of(kBlank) != 0)) return false;
  }
  return line.find_first_not_of(kBlank) == std::string_view::npos;
}

void readFile(v1::ElevationSeries& series, const std::optional<fs::path>& folder, const std::string& path,
              std::vector<FieldIssue>& issues) {
  const std::string shown = "\"" + core::quoteText(series.file(), kNameEchoMaxBytes) + "\" ";
  const auto file = fileInFolder(folder, series.file(), "time_s and elevation_m");
  if (!file) return addRange(issues, path, shown + file.error().message);
  const auto text = core::readText(*file, kSeriesFileMaxBytes, "a text file", "give fewer rows");
  if (!text) return addRange(issues, path, shown + text.error().message);
  // Without rows checkSeries() adds no second error.
  const auto refuse = [&](const std::string& why) {
    series.clear_time_s();
    series.clear_elevation_m();
    addRange(issues, path, shown + why);
  };
  std::string_view rest = *text;
  for (int number = 1; !rest.empty(); ++number) {
    const std::string_view whole = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), whole.size() + 1));
    const std::string_view line = whole.substr(0, whole.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    double time_s = 0.0, elevation_m = 0.0;
    if (!readRow(line, time_s, elevation_m)) {
      return refuse("line " + std::to_string(number) + ": \"" + core::quoteText(whole, kLineEchoMaxBytes) +
                    "\" is not a row; give a time in seconds and an elevation in metres, both finite numbers");
    }
    if (series.time_s_size() == kSceneSeriesRowMaxCount) {
      return refuse("has more than " + std::to_string(kSceneSeriesRowMaxCount) + " rows; give fewer");
    }
    series.add_time_s(time_s);
    series.add_elevation_m(elevation_m);
  }
  if (series.time_s_size() == 0) refuse("has no rows; give times and elevations");
}

}  // namespace

void readSeries(v1::Scene& scene, const std::optional<fs::path>& folder, std::vector<FieldIssue>& issues) {
  const int count = std::min(scene.wave_makers_size(), kSceneWaveMakerMaxCount);
  for (int i = 0; i < count; ++i) {
    if (!scene.wave_makers(i).has_series()) continue;
    v1::ElevationSeries& series = *scene.mutable_wave_makers(i)->mutable_series();
    if (series.file().empty()) continue;
    const std::string path = makerPath(i) + ".series.file";
    if (series.time_s_size() + series.elevation_m_size() > 0) {
      issues.push_back({v1::REJECT_REASON_MALFORMED, path, "and time_s are both given; remove one of them"});
    } else {
      readFile(series, folder, path, issues);
    }
  }
}

void checkMakerStructure(const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  for (int i = 0; i < scene.wave_makers_size(); ++i) {
    const v1::WaveMaker& maker = scene.wave_makers(i);
    const bool goes_on = maker.has_regular() || maker.has_irregular();
    if (maker.waves_case() == v1::WaveMaker::WAVES_NOT_SET) {
      issues.push_back({v1::REJECT_REASON_MALFORMED, makerPath(i),
                        "has no waves; say which: \"regular {}\", \"irregular {}\", \"solitary {}\" or \"series {}\""});
    } else if (maker.duration_s() > 0 && !goes_on) {
      addRange(issues, makerPath(i) + ".duration_s",
               core::formatQuantity(maker.duration_s(), "s") +
                   " is for regular and irregular waves; the others end by themselves: remove it");
    }
  }
}

void checkMakerNumbers(const v1::Scene& scene, std::vector<FieldIssue>& issues) {
  const int count = std::min(scene.wave_makers_size(), kSceneWaveMakerMaxCount);
  for (int i = 0; i < count; ++i) {
    checkSide(scene, i, issues);
    checkWaves(scene.wave_makers(i), scene.wave().depth_m(), makerPath(i), issues);
  }
}

}  // namespace spindrift::scene
