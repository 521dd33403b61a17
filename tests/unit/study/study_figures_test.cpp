// The trade study's figures are those of this solver and of these fidelity levels.
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <boost/json/parse.hpp>
#include <gtest/gtest.h>

#include <spindrift/core/files.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/study/known_results.h>
#include <spindrift/study_suites/suites.h>

namespace spindrift::study_suites {
namespace {

TEST(StudyFigures, AreOfThisSolver) {
  std::stringstream text;
  text << std::ifstream(SPINDRIFT_SOURCE_DIR "/docs/plots/trade.json").rdbuf();
  const boost::json::object figures = boost::json::parse(text.str()).as_object();
  auto ctx = gpu::Context::create({gpu::DeviceChoice::Kind::kSoftware, 0});
  if (!ctx) GTEST_SKIP() << "no software EGL device here: " << ctx.error().message;
  const std::string measured_on(figures.at("device").as_string());
  if ((*ctx)->device().name != measured_on)
    GTEST_SKIP() << "measured on " << measured_on << ", here is " << (*ctx)->device().name;
  ASSERT_FALSE(figures.at("state_hashes").as_object().empty());
  for (const auto& [scene, hash] : figures.at("state_hashes").as_object()) {
    const auto now = tradeStateHash(**ctx, scene);
    ASSERT_TRUE(now) << now.error().message;
    EXPECT_EQ(*now, hash.as_string()) << scene << ": the solver changed after the study of "
                                      << figures.at("date").as_string() << ": run `./dev study --update`";
  }
}

TEST(StudyFigures, KnownResultsScaleAsTheLevelsOfScenesDo) {
  const auto atLevel = [](const std::string& level) {
    for (const v1::Fidelity each :
         {v1::FIDELITY_DRAFT, v1::FIDELITY_BALANCED, v1::FIDELITY_FINE, v1::FIDELITY_REFERENCE}) {
      if (scene::fidelityName(each) == level)
        return scene::toCore(*scene::loadSceneFile(*core::findScene("pool"), each));
    }
    throw std::invalid_argument(level);
  };
  const core::Scene balanced = atLevel("balanced");
  for (const study::LevelScale& level : study::kLevelScales) {
    const core::Scene scaled = atLevel(level.name);
    EXPECT_DOUBLE_EQ(static_cast<double>(scaled.wave->resolution_count) / balanced.wave->resolution_count, level.cells)
        << level.name;
    // Particles of a layer on the wave.
    EXPECT_NEAR(std::sqrt(static_cast<double>(scaled.particles->count) / balanced.particles->count), level.particles,
                0.01)
        << level.name;
    EXPECT_DOUBLE_EQ(scaled.tick_rate_hz / balanced.tick_rate_hz, level.ticks) << level.name;
  }
}

}  // namespace
}  // namespace spindrift::study_suites
