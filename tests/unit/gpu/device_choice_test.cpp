#include <gmock/gmock.h>

#include <spindrift/gpu/device.h>

namespace spindrift::gpu {
namespace {

using Kind = DeviceChoice::Kind;

TEST(DeviceChoice, ReadsWordsAndIndices) {
  ASSERT_TRUE(parseDeviceChoice("auto"));
  EXPECT_EQ(parseDeviceChoice("auto")->kind, Kind::kAuto);
  ASSERT_TRUE(parseDeviceChoice("software"));
  EXPECT_EQ(parseDeviceChoice("software")->kind, Kind::kSoftware);
  for (const int index : {0, 1, 1023}) {
    const auto choice = parseDeviceChoice(std::to_string(index));
    ASSERT_TRUE(choice);
    EXPECT_EQ(choice->kind, Kind::kIndex);
    EXPECT_EQ(choice->index, index);
  }
}

TEST(DeviceChoice, ReadsDrmFilesAndUuids) {
  const auto nameOf = [](const std::string& text) {
    const auto choice = parseDeviceChoice(text);
    return choice && choice->kind == Kind::kName ? choice->name : "(no name)";
  };
  EXPECT_EQ(nameOf("/dev/dri/renderD128"), "/dev/dri/renderD128");
  EXPECT_EQ(nameOf("/dev/../dev/null"), "/dev/null") << "links are resolved where the file exists";
  const std::string uuid = "01234567-89ab-cdef-0123-456789abcdef";
  EXPECT_EQ(nameOf(uuid), uuid);
  EXPECT_EQ(nameOf("GPU-01234567-89AB-CDEF-0123-456789ABCDEF"), uuid) << "as nvidia-smi writes it";
}

TEST(DeviceChoice, RefusesAnythingElseByName) {
  for (const char* text : {"", "Auto", "-1", "1024", "1x", " 1", "0x1", "99999999999999999999", "gpu", "dev/dri/card0",
                           "GPU-0", "01234567-89ab-cdef-0123-456789abcdeg", "0123456789abcdef0123456789abcdef"}) {
    const auto choice = parseDeviceChoice(text);
    ASSERT_FALSE(choice) << text;
    EXPECT_EQ(choice.error().code, core::ErrorCode::kInvalidInput);
    EXPECT_THAT(choice.error().message, testing::HasSubstr("\"" + std::string(text) + "\""));
  }
}

}  // namespace
}  // namespace spindrift::gpu
