#include <filesystem>

#include <gtest/gtest.h>

#include <spindrift/scene/scene_loader.h>

namespace spindrift::scene {
namespace {

std::filesystem::path sceneFolder() {
  return std::filesystem::path(SPINDRIFT_SOURCE_DIR) / "server" / "scenes";
}

TEST(ShippedScenes, AllLoadAndHaveATitleAndDescription) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(sceneFolder())) {
    if (entry.path().extension() != ".textproto") continue;
    ++count;
    const auto scene = loadSceneFile(entry.path());
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->name(), entry.path().stem().string());
    EXPECT_FALSE(scene->title().empty()) << entry.path();
    EXPECT_FALSE(scene->description().empty()) << entry.path();
  }
  EXPECT_GE(count, 14u);
}

TEST(ShippedScenes, TheDefaultHasEveryPartAndKeepsSomethingHappening) {
  const auto scene = loadSceneFile(sceneFolder() / "harbor.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_TRUE(scene->has_wave() && scene->has_particles() && scene->has_coupling() && scene->has_foam() &&
              scene->has_boats() && scene->has_storm());
  EXPECT_GT(scene->obstacles_size(), 0);
  EXPECT_GT(scene->beaches_size(), 0);
  bool repeating_splash = false;
  bool repeating_wave = false;
  for (const v1::TimedEvent& event : scene->events()) {
    repeating_splash |= event.every_s() > 0 && event.effect().has_splash();
    repeating_wave |= event.every_s() > 0 && event.effect().has_breaking_wave();
  }
  EXPECT_TRUE(repeating_splash);
  EXPECT_TRUE(repeating_wave);
}

TEST(ShippedScenes, ThatShowOneEventRepeatIt) {
  const auto scene = loadSceneFile(sceneFolder() / "dam_break.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_GT(scene->restart_after_s(), 0.0);
  for (const auto& entry : std::filesystem::directory_iterator(sceneFolder())) {
    if (entry.path().extension() != ".textproto") continue;
    const auto shipped = loadSceneFile(entry.path());
    ASSERT_TRUE(shipped) << shipped.error().message;
    for (const v1::TimedEvent& event : shipped->events()) {
      EXPECT_TRUE(event.every_s() > 0 || shipped->restart_after_s() > 0)
          << entry.path() << " has an event that is over";
    }
  }
}

TEST(ShippedScenes, TheSinglePartScenesHaveASinglePart) {
  const auto waves = loadSceneFile(sceneFolder() / "wave_only.textproto");
  ASSERT_TRUE(waves) << waves.error().message;
  EXPECT_TRUE(waves->has_wave() && !waves->has_particles());
  const auto particles = loadSceneFile(sceneFolder() / "particles_only.textproto");
  ASSERT_TRUE(particles) << particles.error().message;
  EXPECT_TRUE(particles->has_particles() && !particles->has_wave());
}

}  // namespace
}  // namespace spindrift::scene
