#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/scene/fidelity.h>

#include "temporary_folder.h"

namespace spindrift::scene {
namespace {

using testing::HasSubstr;

TEST(FidelityErrors, InvalidFileIsNamed) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(loadFidelityErrors(folder.path())->scenes_size(), 0) << "a folder without the file";
  folder.write(kFidelityErrorsFile, "measured_on: \"2026-11-25\"\nscene {}");
  auto errors = loadFidelityErrors(folder.path());
  ASSERT_FALSE(errors);
  EXPECT_THAT(errors.error().message, HasSubstr("fidelity_errors.txtpb:2:1: "));
  for (const char* ratios : {"[1, 1, 1]", "[1, 1, 1, 1, 1]", "[1, 1, 1, nan]", "[1, -1, 1, 1]"}) {
    folder.write(kFidelityErrorsFile, std::string("scenes { name: 'pond' error_ratios: ") + ratios + " }");
    errors = loadFidelityErrors(folder.path());
    ASSERT_FALSE(errors) << ratios;
    EXPECT_THAT(errors.error().message, HasSubstr("scene 'pond' needs 4 errors of 0 or more")) << ratios;
  }
}

TEST(FidelityErrors, OfTheShippedScenesBelongToThem) {
  const std::filesystem::path shipped = SPINDRIFT_SOURCE_DIR "/server/scenes";
  const auto errors = loadFidelityErrors(shipped);
  ASSERT_TRUE(errors) << errors.error().message;
  EXPECT_THAT(errors->measured_on(), testing::MatchesRegex("[0-9]{4}-[0-9]{2}-[0-9]{2}"));
  EXPECT_GE(errors->scenes_size(), 9);
  for (const v1::FidelityErrorsOfScene& scene : errors->scenes())
    EXPECT_TRUE(std::filesystem::exists(shipped / (scene.name() + ".textproto"))) << scene.name();
}

}  // namespace
}  // namespace spindrift::scene
