// The trade study's figures are those of this solver.
#include <fstream>
#include <sstream>

#include <boost/json/parse.hpp>
#include <gtest/gtest.h>

#include <spindrift/study_suites/suites.h>

namespace spindrift::study_suites {
namespace {

TEST(StudyFigures, AreOfThisSolver) {
  std::stringstream text;
  text << std::ifstream(SPINDRIFT_SOURCE_DIR "/server/study/plots/trade.json").rdbuf();
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

}  // namespace
}  // namespace spindrift::study_suites
