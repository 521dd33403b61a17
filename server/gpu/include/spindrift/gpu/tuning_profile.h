// How passes share their work among a device's invocations: what is fast differs between devices, results do not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <shared/groups.h>

#include <spindrift/core/result.h>

namespace spindrift::gpu {

struct DeviceInfo;

/// Preprocessor names and values put before the shader's first line.
using Defines = std::vector<std::pair<std::string, std::string>>;

/// Every shader gets these numbers as defines of the same names in capitals. shaders/shared/groups.h says what each
/// means and has the values of a CPU; tuningFields() has the values allowed. States do not depend on them, bit for bit.
struct TuningProfile {
  std::uint32_t particle_group = PARTICLE_GROUP;          ///< particles of a work group
  std::uint32_t wave_group_x = WAVE_GROUP_X;              ///< wave cells of a work group along x
  std::uint32_t wave_group_y = WAVE_GROUP_Y;              ///< and along z
  std::uint32_t scan_items = SCAN_ITEMS;                  ///< groups of four grid cells per scan invocation
  std::uint32_t reduce_items = REDUCE_ITEMS;              ///< values per invocation of the diagnostics
  std::uint32_t dispersion_columns = DISPERSION_COLUMNS;  ///< columns per invocation of the dispersion's passes
  std::uint32_t dispersion_strip = DISPERSION_STRIP;      ///< and rows of each

  bool operator==(const TuningProfile&) const = default;
  [[nodiscard]] Defines defines() const;
};

struct TuningField {
  std::string_view name;
  std::uint32_t TuningProfile::*value;
  std::span<const std::uint32_t> allowed;  ///< ascending
};
std::span<const TuningField> tuningFields();

/// Returns the profile of the device's class.
TuningProfile tuningProfile(const DeviceInfo& device);

/// Returns the profile that a context on the device uses: that of the file named by SPINDRIFT_TUNING, otherwise that of
/// tuningFile(), otherwise tuningProfile(). Error: that of the named file; a found one that is bad is only logged.
core::Result<TuningProfile> chosenTuning(const DeviceInfo& device);

/// Returns the file that `spindrift-bench --suite tune` writes for this device and version of its driver, in
/// spindrift/tuning of the user's cache folder; empty without such a folder.
std::filesystem::path tuningFile(const DeviceInfo& device);

/// Reads a JSON object with some of the fields; those left out stay as in `base`. Error kInvalidInput names the field,
/// its value and the values allowed.
core::Result<TuningProfile> parseTuning(std::string_view json, TuningProfile base);

/// Writes all fields as JSON, in place of an earlier file. Error: kUnavailable.
core::Result<void> writeTuning(const std::filesystem::path& file, const TuningProfile& profile);

}  // namespace spindrift::gpu
