#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/water/scene_catalog.h>

#include "temporary_folder.h"

namespace spindrift::water {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(SceneCatalog, ListsSceneFilesInOrderAndNothingElse) {
  const test::TemporaryFolder folder;
  for (const char* name : {"pond.textproto", "lake.textproto", "notes.txt", "my pool.textproto", "deep/sea.textproto",
                           ".textproto", "wave_only-2.textproto"}) {
    folder.write(name, "wave {}\n");
  }
  std::filesystem::create_directory(folder.path() / "folder.textproto");
  const SceneCatalog catalog(folder.path());
  EXPECT_THAT(catalog.names(), ElementsAre("lake", "pond", "wave_only-2"));
  EXPECT_TRUE(catalog.has("pond"));
  EXPECT_FALSE(catalog.has("sea"));
  EXPECT_FALSE(catalog.has("../pond"));
}

TEST(SceneCatalog, LoadsAListedSceneAsItIsNowUnderItsListedName) {
  const test::TemporaryFolder folder;
  folder.write("pond.textproto", "name: 'other' wave { depth_m: 1 }\n");
  const SceneCatalog catalog(folder.path());
  folder.write("pond.textproto", "name: 'other' wave { depth_m: 2 }\n");
  const auto scene = catalog.load("pond");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->name(), "pond");
  EXPECT_EQ(scene->wave().depth_m(), 2.0);
}

TEST(SceneCatalog, ListsAFurtherFileInPlaceOfTheFoldersOwn) {
  const test::TemporaryFolder folder, elsewhere;
  folder.write("pond.textproto", "wave { depth_m: 1 }\n");
  elsewhere.write("mine.textproto", "wave { depth_m: 2 }\n");
  SceneCatalog catalog(folder.path());
  catalog.add("lake", elsewhere.path() / "mine.textproto");
  catalog.add("pond", elsewhere.path() / "mine.textproto");
  catalog.add("a b", elsewhere.path() / "mine.textproto");
  EXPECT_THAT(catalog.names(), ElementsAre("lake", "pond"));
  EXPECT_EQ(catalog.load("lake")->name(), "lake");
  EXPECT_EQ(catalog.load("pond")->wave().depth_m(), 2.0);
}

TEST(SceneCatalog, LoadsNothingThatItDoesNotList) {
  const test::TemporaryFolder folder;
  const SceneCatalog catalog(folder.path());
  folder.write("late.textproto", "wave {}\n");
  const auto scene = catalog.load("late");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, core::ErrorCode::kUnavailable);
  EXPECT_FALSE(catalog.load("../late"));
}

TEST(SceneCatalog, SaysWhatIsWrongWithAScene) {
  const test::TemporaryFolder folder;
  folder.write("bad.textproto", "wave { depth_m: 200 }\n");
  const auto scene = SceneCatalog(folder.path()).load("bad");
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error().message, HasSubstr("wave.depth_m: 200 m"));
}

TEST(SceneCatalog, IsEmptyWithoutAFolderAndBoundWithAFullOne) {
  EXPECT_TRUE(SceneCatalog(std::filesystem::path()).names().empty());
  EXPECT_TRUE(SceneCatalog("/nonexistent").names().empty());
  const test::TemporaryFolder folder;
  for (std::size_t i = 0; i < kCatalogMaxCount + 5; ++i)
    folder.write("s" + std::to_string(1000 + i) + ".textproto", "wave {}");
  const SceneCatalog catalog(folder.path());
  EXPECT_EQ(catalog.names().size(), kCatalogMaxCount);
  EXPECT_EQ(catalog.names().front(), "s1000");
}

}  // namespace
}  // namespace spindrift::water
