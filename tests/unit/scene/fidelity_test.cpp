// The effect of the fidelity levels on a scene's numbers.
#include <string>

#include <gtest/gtest.h>

#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>

namespace spindrift::scene {
namespace {

v1::Scene parsed(const std::string& text, std::optional<v1::Fidelity> fidelity = std::nullopt) {
  auto scene = parseSceneText(text, "pool.textproto", fidelity);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? *std::move(scene) : v1::Scene();
}

const std::string kPool =
    "wave { resolution_count: 192 side_m: 16 } particles { count: 6000 layers_count: 3 } coupling {}";

TEST(Fidelity, BalancedIsTheSceneAsItIsWritten) {
  const v1::Scene scene = parsed(kPool);
  EXPECT_EQ(scene.fidelity(), v1::FIDELITY_BALANCED);
  EXPECT_EQ(scene.wave().resolution_count(), 192u);
  EXPECT_EQ(scene.particles().count(), 6000u);
  EXPECT_EQ(scene.tick_rate_hz(), 60.0);
  EXPECT_EQ(parsed(kPool, v1::FIDELITY_BALANCED).SerializeAsString(), scene.SerializeAsString());
}

TEST(Fidelity, RisesInEveryNumberFromDraftToReference) {
  v1::Scene before = parsed(kPool, v1::FIDELITY_DRAFT);
  for (const auto level : {v1::FIDELITY_BALANCED, v1::FIDELITY_FINE, v1::FIDELITY_REFERENCE}) {
    const v1::Scene scene = parsed(kPool, level);
    EXPECT_GT(scene.wave().resolution_count(), before.wave().resolution_count());
    EXPECT_EQ(scene.wave().resolution_count() % 16, 0u);
    EXPECT_GT(scene.particles().count(), before.particles().count());
    EXPECT_EQ(scene.particles().layers_count(), 3.0) << "a band on the surface gets thinner instead";
    EXPECT_GE(scene.tick_rate_hz(), before.tick_rate_hz());
    EXPECT_LE(scene.stream().surface_quantum_m(), before.stream().surface_quantum_m());
    before = scene;
  }
}

TEST(Fidelity, TakesTheStencilThatIsMoreAccurateAtEveryLevel) {
  for (const auto level : {v1::FIDELITY_DRAFT, v1::FIDELITY_BALANCED, v1::FIDELITY_FINE, v1::FIDELITY_REFERENCE})
    EXPECT_EQ(parsed(kPool, level).wave().stencil(), v1::STENCIL_FIVE_POINT) << fidelityName(level);
  EXPECT_EQ(parsed("fidelity: FIDELITY_FINE wave { stencil: STENCIL_NINE_POINT }").wave().stencil(),
            v1::STENCIL_NINE_POINT)
      << "a scene may choose";
}

TEST(Fidelity, KeepsTheCellsThatRipplesNeed) {
  const std::string tray = "wave { resolution_count: 160 side_m: 0.45 surface_tension_npm: 0.0728 }";
  EXPECT_EQ(parsed(tray, v1::FIDELITY_DRAFT).wave().resolution_count(), 160u);
  EXPECT_EQ(parsed(tray, v1::FIDELITY_FINE).wave().resolution_count(), 240u);
}

TEST(Fidelity, KeepsWhatTheSceneChose) {
  const v1::Scene scene = parsed(
      "fidelity: FIDELITY_REFERENCE wave { stencil: STENCIL_FIVE_POINT } particles { iterations_count: 3 }\n"
      "coupling { lattice_count: 3 } stream { surface_quantum_m: 0.01 }");
  EXPECT_EQ(scene.fidelity(), v1::FIDELITY_REFERENCE);
  EXPECT_EQ(scene.wave().stencil(), v1::STENCIL_FIVE_POINT);
  EXPECT_EQ(scene.particles().iterations_count(), 3u);
  EXPECT_EQ(scene.coupling().lattice_count(), 3u);
  EXPECT_EQ(scene.stream().surface_quantum_m(), 0.01);
}

TEST(Fidelity, LeavesFloatersAsTheyAre) {
  const std::string text = "wave {} floaters { capacity_count: 20 floaters { size_m: 0.5 } }";
  const std::string floaters = parsed(text, v1::FIDELITY_BALANCED).floaters().SerializeAsString();
  for (const auto level : {v1::FIDELITY_DRAFT, v1::FIDELITY_FINE, v1::FIDELITY_REFERENCE})
    EXPECT_EQ(parsed(text, level).floaters().SerializeAsString(), floaters) << fidelityName(level);
}

TEST(Fidelity, FillsABoxWithMoreLayersAndMakesDropsSmaller) {
  const v1::Scene box = parsed("particles { count: 1000 layers_count: 10 box_side_m: 2 }", v1::FIDELITY_REFERENCE);
  EXPECT_EQ(box.particles().layers_count(), 22.0);
  EXPECT_EQ(box.particles().count(), 10648u) << "as deep as before";
  const v1::Scene spray =
      parsed("wave {} particles { count: 1000 } coupling { mode: COUPLING_MODE_TWO_WAY droplet_spacing_m: 0.2 }",
             v1::FIDELITY_REFERENCE);
  EXPECT_EQ(spray.particles().count(), 10648u);
  EXPECT_NEAR(spray.coupling().droplet_spacing_m(), 0.2 / 2.2, 0.006) << "rounded to whole centimetres";
}

TEST(Fidelity, StaysInsideTheRanges) {
  const v1::Scene fine =
      parsed("tick_rate_hz: 200 wave { resolution_count: 2000 } particles { count: 4000000 }", v1::FIDELITY_REFERENCE);
  EXPECT_EQ(fine.wave().resolution_count(), 2048u);
  EXPECT_EQ(fine.particles().count(), 4194240u);
  EXPECT_EQ(fine.tick_rate_hz(), 240.0);
  const v1::Scene coarse = parsed("wave { resolution_count: 32 } particles { count: 1 }", v1::FIDELITY_DRAFT);
  EXPECT_EQ(coarse.wave().resolution_count(), 32u);
  EXPECT_GE(coarse.particles().count(), 1u);
}

TEST(Fidelity, HasNames) {
  for (const auto level : {v1::FIDELITY_DRAFT, v1::FIDELITY_BALANCED, v1::FIDELITY_FINE, v1::FIDELITY_REFERENCE})
    EXPECT_EQ(parseFidelity(fidelityName(level)), level);
  EXPECT_EQ(parseFidelity("Draft"), v1::FIDELITY_DRAFT);
  EXPECT_FALSE(parseFidelity(""));
  EXPECT_FALSE(parseFidelity("unspecified"));
  EXPECT_FALSE(parseFidelity("best"));
}

TEST(Fidelity, AWrongNumberIsAnErrorAtEveryLevel) {
  const auto scene = parseSceneText("wave { resolution_count: 5000 }", "pool.textproto", v1::FIDELITY_REFERENCE);
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message.find("wave.resolution_count"), std::string::npos) << scene.error().message;
}

TEST(Fidelity, ALevelFindsCellsThatFitTheWidthOrRoundsTheWidthToItsCells) {
  const auto cellsAt = [](const std::string& wave, v1::Fidelity fidelity) {
    const auto scene = parseSceneText("wave { " + wave + " }", "flume.textproto", fidelity);
    EXPECT_TRUE(scene) << scene.error().message;
    return waveCellsOf(scene->wave());
  };
  const std::string flume = "resolution_count: 400 side_m: 40 width_m: 1";
  EXPECT_EQ(cellsAt(flume, v1::FIDELITY_DRAFT).count, (core::CellCounts{200, 5}));
  EXPECT_EQ(cellsAt(flume, v1::FIDELITY_BALANCED).count, (core::CellCounts{400, 10}));
  EXPECT_EQ(cellsAt(flume, v1::FIDELITY_FINE).count, (core::CellCounts{600, 15}));
  EXPECT_EQ(cellsAt(flume, v1::FIDELITY_REFERENCE).count, (core::CellCounts{1000, 25}));
  const std::string odd = "resolution_count: 37 side_m: 7.4 width_m: 22.6";
  for (const v1::Fidelity fidelity : kFidelities) {
    const core::WaveCells cells = cellsAt(odd, fidelity);
    EXPECT_NEAR(cells.width_m, 22.6, 0.5 * cells.cell_m);
    EXPECT_DOUBLE_EQ(cells.width_m, cells.count.z * cells.cell_m);
    EXPECT_EQ(cells.length_m, 7.4);
  }
  const core::WaveCells most = cellsAt("resolution_count: 4000 side_m: 40 width_m: 2", v1::FIDELITY_REFERENCE);
  EXPECT_LE(most.count.total(), core::kWaveMaxCellCount);
  EXPECT_LE(most.count.x, core::kWaveMaxSideCount);
}

TEST(Fidelity, LevelsAreInOrder) {
  EXPECT_FALSE(coarserThan(v1::FIDELITY_DRAFT));
  EXPECT_EQ(finerThan(v1::FIDELITY_DRAFT), v1::FIDELITY_BALANCED);
  EXPECT_EQ(finerThan(v1::FIDELITY_UNSPECIFIED), v1::FIDELITY_FINE) << "BALANCED";
  EXPECT_EQ(coarserThan(v1::FIDELITY_REFERENCE), v1::FIDELITY_FINE);
  EXPECT_FALSE(finerThan(v1::FIDELITY_REFERENCE));
  EXPECT_LT(rankOf(v1::FIDELITY_DRAFT), rankOf(v1::FIDELITY_BALANCED));
}

TEST(Fidelity, KeepsTheLiveParametersThatNoLevelChooses) {
  const std::string text =
      "wave { resolution_count: 64 } particles { count: 4000 } coupling {} boats { boats { x_m: 1 } }";
  v1::Scene from = parsed(text);
  from.mutable_wave()->set_damping_per_s(0.75);
  from.mutable_wave()->set_depth_m(2.5);
  from.mutable_particles()->set_viscosity_pas(12.0);
  from.mutable_particles()->set_count(999);
  from.mutable_boats()->mutable_boats(0)->set_x_m(3.0);
  const v1::Scene fine = parsed(text, v1::FIDELITY_FINE);
  v1::Scene to = fine;
  keepParameters(from, to);
  EXPECT_EQ(to.wave().damping_per_s(), 0.75);
  EXPECT_EQ(to.wave().depth_m(), 2.5);
  EXPECT_EQ(to.particles().viscosity_pas(), 12.0);
  EXPECT_EQ(to.particles().count(), fine.particles().count()) << "of the level";
  EXPECT_EQ(to.particles().iterations_count(), fine.particles().iterations_count());
  EXPECT_EQ(to.wave().resolution_count(), 96u) << "fixed while a room runs";
  EXPECT_EQ(to.boats().boats(0).x_m(), 1.0) << "where the scene starts them";
}

}  // namespace
}  // namespace spindrift::scene
