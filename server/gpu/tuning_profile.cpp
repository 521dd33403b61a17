#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include <boost/json.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/files.h>
#include <spindrift/gpu/device.h>
#include <spindrift/gpu/tuning_profile.h>

#include "program_store.h"

namespace spindrift::gpu {
namespace {

using P = TuningProfile;

// Groups have at most 256 invocations, which every device allows (kNeededLimits); smaller ones than POOL_GROUP would
// leave out particles of a pool, and longer scans than POOL_SCAN_BLOCK cells. More columns than four reach around small
// grids twice.
constexpr std::array<std::uint32_t, 3> kParticleGroups = {POOL_GROUP, 128, 256};
constexpr std::array<std::uint32_t, 2> kWaveGroupsX = {32, 64};
constexpr std::array<std::uint32_t, 3> kWaveGroupsY = {1, 2, 4};
constexpr std::array<std::uint32_t, 3> kScanItems = {4, 8, POOL_SCAN_BLOCK / (4 * SCAN_RUNS_GROUP)};
constexpr std::array<std::uint32_t, 4> kReduceItems = {8, 16, 32, 64};
constexpr std::array<std::uint32_t, 2> kColumns = {2, 4};
constexpr std::array<std::uint32_t, 5> kStrips = {4, 8, 16, 32, 64};
constexpr std::array<TuningField, 7> kFields = {{{"particle_group", &P::particle_group, kParticleGroups},
                                                 {"wave_group_x", &P::wave_group_x, kWaveGroupsX},
                                                 {"wave_group_y", &P::wave_group_y, kWaveGroupsY},
                                                 {"scan_items", &P::scan_items, kScanItems},
                                                 {"reduce_items", &P::reduce_items, kReduceItems},
                                                 {"dispersion_columns", &P::dispersion_columns, kColumns},
                                                 {"dispersion_strip", &P::dispersion_strip, kStrips}}};
constexpr std::size_t kMaxFileBytes = 4096;

core::Result<TuningProfile> readTuning(const std::filesystem::path& file, const TuningProfile& base) {
  auto text = core::readText(file, kMaxFileBytes, "a tuning profile", "`spindrift-bench --suite tune` writes one");
  auto profile = text ? parseTuning(*text, base) : core::Result<TuningProfile>(text.error());
  if (!profile) return core::Error{profile.error().code, file.string() + ": " + profile.error().message};
  return profile;
}

}  // namespace

std::span<const TuningField> tuningFields() {
  return kFields;
}

Defines TuningProfile::defines() const {
  Defines out;
  for (const TuningField& field : kFields) {
    std::string name(field.name);
    std::ranges::transform(name, name.begin(), [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; });
    out.emplace_back(std::move(name), std::to_string(this->*field.value));
  }
  return out;
}

TuningProfile tuningProfile(const DeviceInfo& device) {
  if (device.is_software) return {};
  // Found on an NVIDIA H200 (docs/performance.md, On a GPU); no other vendor's device has been measured.
  return {.reduce_items = 16, .dispersion_columns = 2, .dispersion_strip = 4};
}

core::Result<TuningProfile> chosenTuning(const DeviceInfo& device) {
  const TuningProfile base = tuningProfile(device);
  const char* const named = std::getenv("SPINDRIFT_TUNING");
  if (named && *named) return readTuning(named, base);
  const std::filesystem::path found = tuningFile(device);
  std::error_code error;
  if (found.empty() || !std::filesystem::exists(found, error)) return base;
  auto profile = readTuning(found, base);
  if (profile) {
    spdlog::debug("{}: tuning profile of {}", device.name, found.string());
    return profile;
  }
  spdlog::warn("{}; it is not used: remove it, or write it again with `spindrift-bench --suite tune`",
               profile.error().message);
  return base;
}

std::filesystem::path tuningFile(const DeviceInfo& device) {
  const std::filesystem::path folder = ProgramStore::userFolder("tuning");
  if (folder.empty()) return {};
  std::string name;
  for (const char c : device.vendor + " " + device.name + " " + device.gl_version) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.';
    if (is_plain || (!name.empty() && name.back() != '-')) name += is_plain ? c : '-';
  }
  return folder / (name.substr(0, 200) + ".json");
}

core::Result<TuningProfile> parseTuning(std::string_view json, TuningProfile base) {
  boost::system::error_code error;
  const boost::json::value parsed = boost::json::parse(json, error);
  if (error) return core::invalid("a tuning profile is a JSON object: " + error.message());
  if (!parsed.is_object()) return core::invalid("a tuning profile is a JSON object, this is something else");
  for (const auto& [key, value] : parsed.get_object()) {
    const std::string_view name(key.data(), key.size());
    const auto field = std::ranges::find(kFields, name, &TuningField::name);
    if (field == kFields.end()) {
      std::vector<std::string_view> names;
      for (const TuningField& each : kFields) names.push_back(each.name);
      return core::invalid(
          fmt::format("a tuning profile has no field \"{}\"; it has {}", name, fmt::join(names, ", ")));
    }
    const auto* const number = value.if_int64();
    if (!number || std::ranges::find(field->allowed, *number) == field->allowed.end())
      return core::invalid(
          fmt::format("{}: {} is not one of {}", name, boost::json::serialize(value), fmt::join(field->allowed, ", ")));
    base.*field->value = static_cast<std::uint32_t>(*number);
  }
  return base;
}

core::Result<void> writeTuning(const std::filesystem::path& file, const TuningProfile& profile) {
  std::string text = "{";
  for (const TuningField& field : kFields)
    text += fmt::format("{}\n  \"{}\": {}", text == "{" ? "" : ",", field.name, profile.*field.value);
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  const std::filesystem::path fresh = file.string() + ".new";
  if (std::ofstream out(fresh); !(out << text << "\n}\n" << std::flush))
    return core::unavailable(fresh.string() + " cannot be written");
  std::filesystem::rename(fresh, file, error);
  if (error) return core::unavailable(file.string() + " cannot be replaced: " + error.message());
  return {};
}

}  // namespace spindrift::gpu
