// ChangeScene over a real connection: all clients get a new greeting; layers and ticks continue.
#include <thread>

#include "server_fixture.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Scenes : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kStillWave}, {"other", kStillWave}}; }
  water::SceneCatalog scenes() const override {
    folder_.write("pond.textproto",
                  "wave { resolution_count: 48 side_m: 4 depth_m: 0.5 }\nstream { frame_rate_hz: 60 }");
    folder_.write("box.textproto",
                  "particles { count: 200 layers_count: 4 box_side_m: 1 headroom_m: 1\n"
                  "  boundary_x: BOUNDARY_WALL boundary_z: BOUNDARY_WALL }");
    folder_.write("quay.textproto", "wave { resolution_count: 48 side_m: 16 depth_m: 1 }\nboats { boats { x_m: -4 } }");
    folder_.write("flume.textproto", "wave { resolution_count: 48 side_m: 12 width_m: 2 depth_m: 1 }");
    folder_.write("broken.textproto", "wave { depth_m: 200 }\nparticles { count: 0 }\n");
    folder_.write("impossible.textproto", "particles { count: 10 }\n");
    return water::SceneCatalog(folder_.path());
  }

  /// Changes the scene as soon as the room allows it; returns the tick of its Ack.
  static std::optional<std::uint64_t> changeTo(ScriptedClient& client, const std::string& name) {
    for (int i = 0; i < 50; ++i) {
      const v1::ServerMessage answer = client.ask(changeScene(name));
      if (answer.has_ack()) return answer.ack().applied_tick();
      if (answer.reject().reason() != v1::REJECT_REASON_BUSY) {
        ADD_FAILURE() << answer.ShortDebugString();
        return std::nullopt;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return std::nullopt;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Scenes, AreListedInTheGreeting) {
  EXPECT_THAT(client().greeting().scenes(), ElementsAre("box", "broken", "flume", "impossible", "pond", "quay"));
}

TEST_F(Scenes, ClientOfWire10IsRefusedInARectangle) {
  ScriptedClient old = person({.minor = 0});
  ASSERT_NE(old.welcome().role(), v1::ROLE_UNSPECIFIED) << "squares are what version 1.0 knows";
  ScriptedClient newer = client();
  ASSERT_TRUE(changeTo(newer, "flume"));
  // The change closes the session that would misread the frames, and a new one is not let in.
  EXPECT_TRUE(old.ws().waitClosed());
  EXPECT_EQ(old.ws().closeCode(), 1008);
  EXPECT_THAT(old.ws().closeReason(), HasSubstr("12 x 2 m, and wire version 1.0 knows squares only"));
  ScriptedClient another = person({.minor = 0});
  EXPECT_TRUE(another.ws().waitClosed());
  EXPECT_THAT(another.ws().closeReason(), HasSubstr("update the client to 1.1"));
  const v1::ServerMessage answer = newer.ask(setSpeed(1.0));
  EXPECT_TRUE(answer.has_ack()) << answer.ShortDebugString();
}

TEST_F(Scenes, OnlyTheAnswerToASpawnNamesABoat) {
  ScriptedClient one = client();
  ASSERT_TRUE(changeTo(one, "quay"));
  EXPECT_NE(one.ask(spawnBoat(0, 0)).ack().boat_id(), 0u);
  for (const v1::Command& command : {setSpeed(2.0), removeBoat(1), setParameter("wave.damping_per_s", 0.1)}) {
    const v1::ServerMessage answer = one.ask(command);
    ASSERT_TRUE(answer.has_ack()) << answer.ShortDebugString();
    EXPECT_EQ(answer.ack().boat_id(), 0u) << command.ShortDebugString();
  }
  EXPECT_NE(one.ask(spawnBoat(0, 4)).ack().boat_id(), 0u);
  v1::ServerMessage changed = one.ask(changeScene("pond"));
  while (changed.has_reject() && changed.reject().reason() == v1::REJECT_REASON_BUSY) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // scenes change at most once per second
    changed = one.ask(changeScene("pond"));
  }
  ASSERT_TRUE(changed.has_ack()) << changed.ShortDebugString();
  EXPECT_EQ(changed.ack().boat_id(), 0u);
}

TEST_F(Scenes, ChangeSendsAGreetingToAllClients) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  ScriptedClient elsewhere = client("other");
  two.subscribe(v1::LAYER_SURFACE);
  const auto before = two.nextFrame(v1::LAYER_SURFACE);
  ASSERT_TRUE(before);
  EXPECT_EQ(before->surface_fixed16().resolution_count(), 32u);

  const auto applied = changeTo(one, "pond");
  ASSERT_TRUE(applied);
  EXPECT_GT(*applied, before->tick());
  for (ScriptedClient* each : {&one, &two}) {
    const auto greeting = each->waitFor(v1::ServerMessage::kGreeting);
    ASSERT_TRUE(greeting);
    EXPECT_EQ(greeting->greeting().scene().name(), "pond");
    EXPECT_EQ(greeting->greeting().session_id(), each->greeting().session_id());
    EXPECT_EQ(greeting->greeting().scenes_size(), 6);
  }
  const auto frame = two.waitFor(
      [](const v1::ServerMessage& m) { return m.has_frame() && m.frame().surface_fixed16().resolution_count() == 48; });
  ASSERT_TRUE(frame) << "the subscription continues";
  EXPECT_GE(frame->frame().tick(), *applied);
  EXPECT_LT(frame->frame().time_s(), 1.0 + static_cast<double>(frame->frame().tick() - *applied) / 60.0);
  EXPECT_FALSE(elsewhere.hasReceived(v1::ServerMessage::kGreeting));
  EXPECT_EQ(client("other").greeting().scene().name(), "other");
}

TEST_F(Scenes, SubscriptionSurvivesASceneWithoutTheLayer) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  one.subscribe(v1::LAYER_PARTICLES);
  one.subscribe(v1::LAYER_DIAGNOSTICS);
  ASSERT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  const auto box = changeTo(one, "box");
  ASSERT_TRUE(box);
  const auto particles = one.nextFrame(v1::LAYER_PARTICLES);
  ASSERT_TRUE(particles) << "a layer asked for before the room had it";
  EXPECT_GE(particles->tick(), *box);
  EXPECT_TRUE(codec::decodeParticles(*particles));
  const auto greeting = one.waitFor(v1::ServerMessage::kGreeting);
  ASSERT_TRUE(greeting);
  EXPECT_THAT(greeting->greeting().layers(), ElementsAre(v1::LAYER_PARTICLES, v1::LAYER_DIAGNOSTICS));

  const auto pond = changeTo(one, "pond");
  ASSERT_TRUE(pond);
  EXPECT_GT(*pond, *box);
  const auto surface = one.waitFor([&](const v1::ServerMessage& m) {
    return m.has_frame() && m.frame().layer() == v1::LAYER_SURFACE && m.frame().tick() >= *pond;
  });
  ASSERT_TRUE(surface);
  EXPECT_TRUE(codec::decodeSurface(surface->frame()));
  EXPECT_TRUE(
      one.waitFor([&](const v1::ServerMessage& m) { return m.has_diagnostics() && m.diagnostics().tick() > *pond; }));
}

TEST_F(Scenes, UnknownSceneIsRejected) {
  ScriptedClient one = client();
  for (const char* name : {"sea", "../main", ""}) {
    const v1::Reject reject = one.rejected(changeScene(name));
    EXPECT_EQ(reject.reason(), v1::REJECT_REASON_UNKNOWN_SCENE) << name;
    EXPECT_EQ(reject.field(), "change_scene.name");
  }
  EXPECT_TRUE(one.runFor(5));
}

TEST_F(Scenes, InvalidSceneIsRejectedWithTheReason) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  const v1::Reject broken = one.rejected(changeScene("broken"));
  EXPECT_EQ(broken.reason(), v1::REJECT_REASON_UNKNOWN_SCENE);
  EXPECT_THAT(broken.message(), HasSubstr("wave.depth_m: 200 m"));
  EXPECT_EQ(broken.message().find('\n'), std::string::npos);
  const v1::Reject impossible = one.rejected(changeScene("impossible"));
  EXPECT_EQ(impossible.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_THAT(impossible.message(), HasSubstr("particles.count"));
  EXPECT_FALSE(one.hasReceived(v1::ServerMessage::kGreeting));
  EXPECT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  EXPECT_TRUE(one.runFor(5));
}

TEST_F(Scenes, KeepThePauseAndTheSpeed) {
  ScriptedClient one = client();
  ASSERT_TRUE(one.apply(setSpeed(0.5)));
  ASSERT_TRUE(one.apply(setPaused(true)));
  const auto applied = changeTo(one, "pond");
  ASSERT_TRUE(applied);
  const auto greeting = one.waitFor(v1::ServerMessage::kGreeting);
  ASSERT_TRUE(greeting);
  EXPECT_TRUE(greeting->greeting().room_state().paused());
  EXPECT_EQ(greeting->greeting().room_state().speed(), 0.5);
  EXPECT_EQ(one.apply(setSpeed(0.5)), applied) << "the tick stands still";
}

TEST_F(Scenes, SecondChangeAtOnceIsBusy) {
  ScriptedClient one = client();
  ASSERT_TRUE(changeTo(one, "pond"));
  EXPECT_EQ(one.rejected(changeScene("pond")).reason(), v1::REJECT_REASON_BUSY);
}

class ShippedScenes : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kStillWave}}; }
  water::SceneCatalog scenes() const override { return water::SceneCatalog(SPINDRIFT_SOURCE_DIR "/server/scenes"); }
};

TEST_F(ShippedScenes, AllRunInOneRoomOneAfterTheOther) {
  ScriptedClient one = client();
  for (const auto layer :
       {v1::LAYER_SURFACE, v1::LAYER_PARTICLES, v1::LAYER_BODIES, v1::LAYER_FOAM, v1::LAYER_FLOATERS})
    one.subscribe(layer);
  for (const std::string name : {"harbor", "splash", "dam_break", "harbor"}) {
    std::optional<std::uint64_t> applied;
    for (int i = 0; i < 100 && !applied; ++i) {
      const v1::ServerMessage answer = one.ask(changeScene(name));
      if (answer.has_ack())
        applied = answer.ack().applied_tick();
      else
        ASSERT_EQ(answer.reject().reason(), v1::REJECT_REASON_BUSY) << name << ": " << answer.reject().message();
      if (!applied) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    ASSERT_TRUE(applied) << name;
    const auto greeting = one.waitFor(v1::ServerMessage::kGreeting);
    ASSERT_TRUE(greeting);
    EXPECT_EQ(greeting->greeting().scene().name(), name);
    const v1::FidelityLevels& levels = greeting->greeting().fidelity_levels();
    ASSERT_EQ(levels.levels_size(), 4) << name;
    for (const v1::FidelityLevel& level : levels.levels()) EXPECT_GT(level.cost_ms_per_s(), 0.0) << name;
    EXPECT_GT(levels.levels(0).error_ratio(), levels.levels(3).error_ratio()) << name;
    // The room sends frames of every layer that the scene has, and they can be decoded.
    for (const int layer : greeting->greeting().layers()) {
      if (layer == v1::LAYER_DIAGNOSTICS) continue;
      const auto frame = one.waitFor([&](const v1::ServerMessage& m) {
        return m.has_frame() && m.frame().layer() == layer && m.frame().tick() >= *applied;
      });
      ASSERT_TRUE(frame) << name << " layer " << layer;
      if (layer == v1::LAYER_SURFACE) {
        EXPECT_TRUE(codec::decodeSurface(frame->frame()));
      }
      if (layer == v1::LAYER_PARTICLES) {
        EXPECT_TRUE(codec::decodeParticles(frame->frame()));
      }
      if (layer == v1::LAYER_FLOATERS) {
        EXPECT_TRUE(codec::decodeFloaters(frame->frame()));
      }
    }
    const auto splashed = one.apply(splash(0.3, 0.3));
    ASSERT_TRUE(splashed) << name;
    EXPECT_GT(*splashed, *applied);
  }
}

TEST_F(Scenes, NeverGiveABoatsNumberToAnother) {
  ScriptedClient one = client();
  const auto boatsAfter = [&](const std::string& scene) {
    EXPECT_TRUE(changeTo(one, scene));
    const auto greeting = one.waitFor(v1::ServerMessage::kGreeting);
    std::vector<std::uint32_t> ids;
    if (!greeting) return ids;
    for (const v1::BoatInfo& boat : greeting->greeting().boat_list().boats()) ids.push_back(boat.boat_id());
    return ids;
  };
  EXPECT_THAT(boatsAfter("quay"), ElementsAre(1u));
  EXPECT_EQ(one.ask(spawnBoat(0, 4)).ack().boat_id(), 2u);
  EXPECT_THAT(boatsAfter("pond"), testing::IsEmpty());
  EXPECT_THAT(boatsAfter("quay"), ElementsAre(3u)) << "also over a scene without boats";
  EXPECT_EQ(one.ask(spawnBoat(0, 4)).ack().boat_id(), 4u);
}

}  // namespace
}  // namespace spindrift::test
