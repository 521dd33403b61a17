// The tuning profile by class of device, and from a file.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/gpu/device.h>

#include "log_capture.h"
#include "temporary_folder.h"

namespace spindrift::gpu {
namespace {

using test::LogCapture;
using ::testing::HasSubstr;

DeviceInfo rasteriser() {
  DeviceInfo info;
  info.vendor = "Mesa";
  info.name = "llvmpipe (LLVM 15.0.6, 256 bits)";
  info.gl_version = "4.5 (Core Profile) Mesa 22.3.6";
  info.is_software = true;
  return info;
}

std::string errorOf(std::string_view json) {
  const auto profile = parseTuning(json, {});
  return profile ? "" : profile.error().message;
}

TEST(TuningProfileOfADevice, IsThatOfItsClass) {
  DeviceInfo info = rasteriser();
  EXPECT_EQ(tuningProfile(info), TuningProfile());
  info.is_software = false;
  const TuningProfile gpu = tuningProfile(info);
  EXPECT_EQ(gpu.dispersion_columns, 2u);
  EXPECT_EQ(gpu.dispersion_strip, 4u);
  EXPECT_EQ(gpu.reduce_items, 16u);
  EXPECT_EQ(gpu.particle_group, 64u);
}

TEST(TuningProfileOfADevice, HasAllowedValuesInEachClass) {
  DeviceInfo info;
  for (info.is_software = false;; info.is_software = true) {
    for (const TuningField& field : tuningFields())
      EXPECT_THAT(field.allowed, ::testing::Contains(tuningProfile(info).*field.value)) << field.name;
    if (info.is_software) break;
  }
}

TEST(TuningFile, ChangesTheFieldsThatItNames) {
  const auto profile = parseTuning(R"({"particle_group": 128, "scan_items": 4})", {.reduce_items = 16});
  ASSERT_TRUE(profile) << profile.error().message;
  EXPECT_EQ(*profile, (TuningProfile{.particle_group = 128, .scan_items = 4, .reduce_items = 16}));
}

TEST(TuningFile, WithABadFieldIsRefusedWithFieldValueAndBound) {
  EXPECT_EQ(errorOf(R"({"particle_group": 100})"), "particle_group: 100 is not one of 64, 128, 256");
  EXPECT_EQ(errorOf(R"({"dispersion_strip": -4})"), "dispersion_strip: -4 is not one of 4, 8, 16, 32, 64");
  EXPECT_EQ(errorOf(R"({"scan_items": 4294967300})"), "scan_items: 4294967300 is not one of 4, 8, 16");
  EXPECT_EQ(errorOf(R"({"wave_group_x": "64"})"), "wave_group_x: \"64\" is not one of 32, 64");
  EXPECT_EQ(errorOf(R"({"wave_group_y": null})"), "wave_group_y: null is not one of 1, 2, 4");
  EXPECT_THAT(errorOf(R"({"lanes": 8})"), HasSubstr("no field \"lanes\"; it has particle_group, wave_group_x"));
  EXPECT_THAT(errorOf("particle_group: 64"), HasSubstr("is a JSON object"));
  EXPECT_THAT(errorOf("[1]"), HasSubstr("is a JSON object"));
  EXPECT_THAT(errorOf(""), HasSubstr("is a JSON object"));
}

class WrittenTuning : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
    ::unsetenv("SPINDRIFT_TUNING");
  }
  void TearDown() override {
    ::unsetenv("XDG_CACHE_HOME");
    ::unsetenv("SPINDRIFT_TUNING");
  }
  static void write(const std::filesystem::path& file, std::string_view text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }

  test::TemporaryFolder folder_;
};

TEST_F(WrittenTuning, IsChosenForThisDeviceAndDriver) {
  const TuningProfile fast{.particle_group = 256, .wave_group_y = 2, .dispersion_strip = 8};
  DeviceInfo info = rasteriser();
  EXPECT_EQ(*chosenTuning(info), TuningProfile());
  ASSERT_TRUE(writeTuning(tuningFile(info), {}));
  ASSERT_TRUE(writeTuning(tuningFile(info), fast)) << "in place of an earlier one";
  EXPECT_EQ(*chosenTuning(info), fast);
  EXPECT_EQ(tuningFile(info).filename(), "Mesa-llvmpipe-LLVM-15.0.6-256-bits-4.5-Core-Profile-Mesa-22.3.6.json");
  info.gl_version = "4.5 (Core Profile) Mesa 23.0.0";
  EXPECT_EQ(*chosenTuning(info), TuningProfile());
}

TEST_F(WrittenTuning, ThatIsBadIsLoggedAndNotUsed) {
  write(tuningFile(rasteriser()), R"({"scan_items": 5})");
  const LogCapture log;
  EXPECT_EQ(*chosenTuning(rasteriser()), TuningProfile());
  EXPECT_THAT(log.text(), HasSubstr("scan_items: 5 is not one of 4, 8, 16; it is not used"));
}

TEST_F(WrittenTuning, NamedByTheEnvironmentComesFirstAndMustBeGood) {
  ASSERT_TRUE(writeTuning(tuningFile(rasteriser()), {.particle_group = 256}));
  const auto named = folder_.path() / "own.json";
  ::setenv("SPINDRIFT_TUNING", named.c_str(), 1);
  EXPECT_THAT(chosenTuning(rasteriser()).error().message, HasSubstr("own.json"));
  write(named, R"({"particle_group": 128})");
  EXPECT_EQ(chosenTuning(rasteriser())->particle_group, 128u);
  write(named, R"({"particle_group": 1})");
  EXPECT_EQ(chosenTuning(rasteriser()).error().message,
            named.string() + ": particle_group: 1 is not one of 64, 128, 256");
  write(named, std::string(5000, ' '));
  EXPECT_THAT(chosenTuning(rasteriser()).error().message, HasSubstr("4096"));
}

TEST_F(WrittenTuning, ThatCannotBeWrittenIsAnError) {
  write(folder_.path() / "file", "no folder");
  EXPECT_FALSE(writeTuning(folder_.path() / "file" / "tuning.json", {}));
}

}  // namespace
}  // namespace spindrift::gpu
