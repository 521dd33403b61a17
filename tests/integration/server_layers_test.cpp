// Two-way coupling, boats and changing counts, from a client's view.
#include <algorithm>
#include <cstring>

#include <spindrift/codec/frame_decoder.h>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

constexpr const char* kHarbour = R"(
  wave { resolution_count: 64 side_m: 12 depth_m: 1 }
  particles { count: 2000 headroom_m: 3 max_speed_mps: 5 sound_speed_mps: 2 viscosity_pas: 10 }
  coupling { mode: COUPLING_MODE_TWO_WAY droplet_spacing_m: 0.15 emission_ratio: 2 }
  foam { surface: true }
  boats { boats { x_m: -3 length_m: 2 beam_m: 0.8 height_m: 0.5 density_ratio: 0.4 } }
  stream { frame_rate_hz: 60 }
)";

class Harbour : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kHarbour}}; }
};

class Pool : public ServerTest {};

TEST_F(Harbour, SendsParticlesOnlyWhereWaterBroke) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_PARTICLES);
  const auto calm = one.nextFrame(v1::LAYER_PARTICLES);
  ASSERT_TRUE(calm);
  EXPECT_EQ(calm->particles_fixed12().count(), 0u);
  EXPECT_TRUE(codec::decodeParticles(*calm)) << "a frame without particles is valid";
  ASSERT_TRUE(one.apply(splash(0.85)));
  const auto broken = one.waitFor([](const v1::ServerMessage& m) {
    return m.has_frame() && m.frame().layer() == v1::LAYER_PARTICLES && m.frame().particles_fixed12().count() > 5;
  });
  ASSERT_TRUE(broken);
  const auto samples = codec::decodeParticles(broken->frame());
  ASSERT_TRUE(samples) << samples.error().message;
  EXPECT_GT(*std::max_element(samples->foam.begin(), samples->foam.end()), 100) << "spray is white";
  one.subscribe(v1::LAYER_DIAGNOSTICS);
  const auto diagnostics =
      one.waitFor([](const v1::ServerMessage& m) { return m.has_diagnostics() && m.diagnostics().emitted_m3() > 0; });
  ASSERT_TRUE(diagnostics);
  EXPECT_EQ(diagnostics->diagnostics().volume_error_units(), 0);
  EXPECT_EQ(diagnostics->diagnostics().boat_count(), 1u);
}

TEST_F(Harbour, SendsFoamOfBreakingWater) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_FOAM);
  const auto calm = one.nextFrame(v1::LAYER_FOAM);
  ASSERT_TRUE(calm);
  EXPECT_EQ(calm->foam_fixed8().resolution_count(), 32u);
  ASSERT_TRUE(one.apply(splash(0.85)));
  EXPECT_TRUE(one.waitFor([](const v1::ServerMessage& m) {
    if (!m.has_frame() || m.frame().layer() != v1::LAYER_FOAM || !codec::decodeFoam(m.frame())) return false;
    return std::ranges::any_of(m.frame().payload(), [](char byte) { return static_cast<unsigned char>(byte) > 100; });
  }));
}

TEST_F(Harbour, MovesASteeredBoatForAllClients) {
  ScriptedClient helm = client();
  ScriptedClient shore = client();
  shore.subscribe(v1::LAYER_BODIES);
  const auto first = shore.nextFrame(v1::LAYER_BODIES);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->bodies_fixed28().count(), 1u);
  EXPECT_TRUE(codec::decodeBodies(*first));
  ASSERT_TRUE(helm.apply(controlBoat(1, 1.0, 0.0)));
  const auto xOf = [](const v1::LayerFrame& frame) {
    std::int32_t x_mm = 0;
    std::memcpy(&x_mm, frame.payload().data() + 4, sizeof x_mm);
    return x_mm / 1000.0;
  };
  EXPECT_TRUE(shore.waitFor([&](const v1::ServerMessage& m) {
    return m.has_frame() && m.frame().layer() == v1::LAYER_BODIES && xOf(m.frame()) > -2.0;
  })) << "from x = -3 m toward +x";
}

TEST_F(Pool, TakesAnotherNumberOfParticlesWhileItRuns) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  two.subscribe(v1::LAYER_PARTICLES);
  ASSERT_TRUE(two.nextFrame(v1::LAYER_PARTICLES));
  const auto applied = one.apply(setParameter("particles.count", 2048));
  ASSERT_TRUE(applied);
  const auto told = two.waitFor(v1::ServerMessage::kParameterChanged);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->parameter_changed().path(), "particles.count");
  EXPECT_EQ(told->parameter_changed().value(), 2048.0);
  EXPECT_EQ(told->parameter_changed().applied_tick(), *applied);
  EXPECT_TRUE(two.waitFor([](const v1::ServerMessage& m) {
    return m.has_frame() && m.frame().layer() == v1::LAYER_PARTICLES && m.frame().particles_fixed12().count() > 1500 &&
           codec::decodeParticles(m.frame());
  }));
  const v1::Reject refused = one.rejected(setParameter("particles.count", 5'000'000));
  EXPECT_EQ(refused.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(refused.field(), "particles.count");
  EXPECT_THAT(refused.message(), HasSubstr("4194240"));
  EXPECT_THAT(refused.message(), HasSubstr("5000000"));
}

TEST_F(Harbour, KeepsTheSizeOfItsPool) {
  ScriptedClient one = client();
  const v1::Reject refused = one.rejected(setParameter("particles.count", 4000));
  EXPECT_EQ(refused.reason(), v1::REJECT_REASON_NEEDS_RESTART);
  EXPECT_THAT(refused.message(), HasSubstr("pool"));
}

}  // namespace
}  // namespace spindrift::test
