// The uniform blocks that C++ fills and shaders read: size and offset of each member in the driver's layout.
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <shared/bindings.h>
#include <shared/boats.h>
#include <shared/event_uniforms.h>
#include <shared/maker_uniforms.h>
#include <shared/sea_uniforms.h>
#include <shared/sim_uniforms.h>

#include "shader_defines.h"
#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

class SharedBlocks : public OnDevice {
 protected:
  gpu::BlockLayout block(const char* shader, const char* name, const core::Scene& scene) {
    const auto program = gpu::Program::create(*ctx_, shader, shaderDefines(scene));
    if (!program) throw std::runtime_error(program.error().message);
    const auto blocks = program->blocks();
    const auto found = blocks.find(name);
    if (found == blocks.end()) throw std::runtime_error(std::string(shader) + " has no block " + name);
    return found->second;
  }

  /// Offset of a member, with any prefix that the driver adds to its name ("SimUniforms.dt_s", "splashes[0].gain_m").
  static std::optional<std::uint32_t> offsetOf(const gpu::BlockLayout& block, const std::string& member) {
    for (const auto& [name, offset] : block.offsets) {
      if (name == member || name.ends_with("." + member)) return offset;
    }
    return std::nullopt;
  }

  /// The members of a shared header in order: in C++ and std140 each scalar is 4 bytes after the one before.
  static std::vector<std::string> members(const char* header, const std::string& after) {
    std::ifstream in(std::filesystem::path(SPINDRIFT_SOURCE_DIR) / "shaders/shared" / header);
    std::vector<std::string> out;
    bool is_inside = false;
    for (std::string line; std::getline(in, line);) {
      is_inside = is_inside || line.find(after) != std::string::npos;
      if (is_inside && line.starts_with("};")) break;
      // Matches "  float NAME;  // ..." or "  uint NAME;". Without std::regex, because g++ 12 warns inside it with
      // sanitizers.
      std::istringstream words(line);
      std::string type, name;
      if (!is_inside || !(words >> type >> name) || (type != "float" && type != "uint")) continue;
      out.push_back(name.substr(0, name.find(';')));
    }
    return out;
  }
};

TEST_F(SharedBlocks, SimUniformsHaveTheLayoutOfTheDriver) {
  const gpu::BlockLayout sim = block("sph/integrate.comp", "SimUniforms", smallScene());
  EXPECT_EQ(sim.binding, static_cast<std::uint32_t>(SIM_UNIFORMS));
  EXPECT_EQ(sim.size_bytes, sizeof(shared::SimUniforms));
  const auto names = members("sim_uniforms.h", "struct SimUniforms");
  ASSERT_EQ(names.size(), sizeof(shared::SimUniforms) / 4);
  for (std::size_t k = 0; k < names.size(); ++k) EXPECT_EQ(offsetOf(sim, names[k]), 4 * k) << names[k];
}

TEST_F(SharedBlocks, EventUniformsHaveTheLayoutOfTheDriver) {
  const gpu::BlockLayout events = block("wave/splash.comp", "EventUniforms", smallScene());
  EXPECT_EQ(events.binding, static_cast<std::uint32_t>(EVENT_UNIFORMS));
  EXPECT_EQ(events.size_bytes, sizeof(shared::EventUniforms));
  EXPECT_EQ(offsetOf(events, "splash_count"), offsetof(shared::EventUniforms, splash_count));
  EXPECT_EQ(offsetOf(events, "crest_count"), offsetof(shared::EventUniforms, crest_count));
  EXPECT_EQ(offsetOf(events, "calm_count"), offsetof(shared::EventUniforms, calm_count));
  const auto names = members("event_uniforms.h", "struct EventUniform");
  ASSERT_EQ(names.size(), sizeof(shared::EventUniform) / 4);
  for (std::size_t k = 0; k < names.size(); ++k) {
    EXPECT_EQ(offsetOf(events, "splashes[0]." + names[k]), 4 * k) << names[k];
    EXPECT_EQ(offsetOf(events, "crests[0]." + names[k]), offsetof(shared::EventUniforms, crests) + 4 * k) << names[k];
  }
}

TEST_F(SharedBlocks, BoatControlsHaveTheLayoutOfTheDriver) {
  core::Scene scene = smallScene();
  scene.boats.emplace();
  const gpu::BlockLayout boats = block("bodies/kick.comp", "BoatControls", scene);
  EXPECT_EQ(boats.binding, static_cast<std::uint32_t>(BOAT_CONTROLS));
  EXPECT_EQ(boats.size_bytes, sizeof(shared::BoatControls));
  EXPECT_EQ(offsetOf(boats, "boat_control[0]"), 0u);
  EXPECT_EQ(offsetOf(boats, "boat_place_count"), offsetof(shared::BoatControls, place_count));
}

TEST_F(SharedBlocks, SeaUniformsHaveTheLayoutOfTheDriver) {
  core::Scene scene = smallScene();
  setBoundaries(*scene.wave, core::WaveBoundary::kAbsorb);
  const gpu::BlockLayout sea = block("wave/incident_sea.comp", "SeaUniforms", scene);
  EXPECT_EQ(sea.binding, static_cast<std::uint32_t>(SEA_UNIFORMS));
  EXPECT_EQ(sea.size_bytes, sizeof(shared::SeaUniforms));
  EXPECT_EQ(offsetOf(sea, "sea_wave_count"), offsetof(shared::SeaUniforms, wave_count));
  EXPECT_EQ(offsetOf(sea, "sea_block_count"), offsetof(shared::SeaUniforms, block_count));
  const auto names = members("sea_uniforms.h", "struct SeaWaveUniform");
  ASSERT_EQ(names.size(), sizeof(shared::SeaWaveUniform) / 4);
  for (std::size_t k = 0; k < names.size(); ++k)
    EXPECT_EQ(offsetOf(sea, "sea_waves[0]." + names[k]), 4 * k) << names[k];
}

TEST_F(SharedBlocks, MakerUniformsHaveTheLayoutOfTheDriver) {
  core::Scene scene = smallScene();
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.wave_makers = {core::WaveMaker{}};
  const gpu::BlockLayout maker = block("wave/maker.comp", "MakerUniforms", scene);
  EXPECT_EQ(maker.binding, static_cast<std::uint32_t>(MAKER_UNIFORMS));
  EXPECT_LE(maker.size_bytes, sizeof(shared::MakerUniforms));
  EXPECT_EQ(offsetOf(maker, "maker_side"), offsetof(shared::MakerUniforms, maker_side));
  EXPECT_EQ(offsetOf(maker, "maker_flow_m2ps"), offsetof(shared::MakerUniforms, maker_flow_m2ps));
  EXPECT_EQ(offsetOf(maker, "maker_elevation_m"), offsetof(shared::MakerUniforms, maker_elevation_m));
  EXPECT_EQ(offsetOf(maker, "maker_absorbing_mps"), offsetof(shared::MakerUniforms, maker_absorbing_mps));
  EXPECT_EQ(offsetOf(maker, "maker_depth_m"), offsetof(shared::MakerUniforms, maker_depth_m));
}

TEST_F(SharedBlocks, TheFollowerWritesTheFirstMembersOfTheSimUniforms) {
  core::Scene scene = smallScene();
  scene.particles->patch_scale = 0.5;
  scene.coupling->patch_follow = core::PatchFollow::kEvent;
  const gpu::BlockLayout movable = block("coupling/follow.comp", "MovableUniforms", scene);
  EXPECT_TRUE(movable.is_storage);
  const auto names = members("sim_uniforms.h", "struct SimUniforms");
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(offsetOf(movable, names.at(k)), 4 * k) << names[k];
}

}  // namespace
}  // namespace spindrift::sim
