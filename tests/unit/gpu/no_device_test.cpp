#include <cstdlib>

#include <gmock/gmock.h>

#include <spindrift/gpu/context.h>
#include <spindrift/gpu/device.h>

namespace spindrift::gpu {
namespace {

/// Hides every EGL driver from libglvnd; must run before the first EGL call of the process.
void hideDrivers() {
  setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
  setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent", 1);
}

TEST(NoDevice, NamesTheVariablesThatHideTheDrivers) {
  hideDrivers();
  const auto none = Context::create({});
  if (none) GTEST_SKIP() << "this libEGL is not libglvnd: its drivers cannot be hidden";
  EXPECT_EQ(none.error().code, core::ErrorCode::kNoDevice);
  EXPECT_THAT(none.error().message, testing::HasSubstr("__EGL_VENDOR_LIBRARY_DIRS=/nonexistent"));
  EXPECT_THAT(none.error().message, testing::Not(testing::HasSubstr("\n")));
}

TEST(NoDevice, ErrorNamesTheDriverAndTheVariable) {
  setenv("MESA_GL_VERSION_OVERRIDE", "3.3", 1);
  const auto none = Context::create({.kind = DeviceChoice::Kind::kSoftware});
  if (none || none.error().message.find("it has 3.3") == std::string::npos) GTEST_SKIP() << "this driver is not Mesa's";
  // On zink its own variables stand beside it.
  EXPECT_THAT(none.error().message,
              testing::AllOf(testing::ContainsRegex("MESA_GL_VERSION_OVERRIDE=3\\.3[^)]*\\): unset that"),
                             testing::Not(testing::HasSubstr("apt install"))));
}

TEST(NoDevice, IsListedWithItsReason) {
  hideDrivers();
  const GpuInfo info = collectInfo({});
  if (info.chosen) GTEST_SKIP() << "this libEGL is not libglvnd: its drivers cannot be hidden";
  ASSERT_EQ(info.devices.size(), 1u);
  EXPECT_TRUE(info.devices[0].is_software);
  EXPECT_THAT(info.devices[0].problem, testing::Not(testing::IsEmpty()));
  EXPECT_THAT(info.why, testing::HasSubstr("no usable EGL device"));
}

}  // namespace
}  // namespace spindrift::gpu
