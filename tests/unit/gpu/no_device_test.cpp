#include <cstdlib>

#include <gmock/gmock.h>

#include <spindrift/gpu/context.h>
#include <spindrift/gpu/info.h>

namespace spindrift::gpu {
namespace {

/// Hides every EGL driver from libglvnd; must run before the first EGL call of the process.
void hideDrivers() {
  setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
  setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent", 1);
}

TEST(NoDevice, SaysWhatToInstall) {
  hideDrivers();
  const auto none = Context::create({});
  if (none) GTEST_SKIP() << "this libEGL is not libglvnd: its drivers cannot be hidden";
  EXPECT_EQ(none.error().code, core::ErrorCode::kNoDevice);
  EXPECT_THAT(none.error().message, testing::HasSubstr("apt install libegl1 libegl-mesa0 libgl1-mesa-dri"));
  EXPECT_THAT(none.error().message, testing::Not(testing::HasSubstr("\n")));
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
