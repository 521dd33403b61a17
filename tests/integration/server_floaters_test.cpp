// Objects in the water over a real connection: what all clients see of them, and who may do what.
#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

constexpr const char* kCove = R"(
  wave { resolution_count: 32 side_m: 16 depth_m: 2 }
  obstacles { rock { x_m: 5 } }
  floaters { capacity_count: 3 floaters { x_m: -4 kind: FLOATER_KIND_BALL } }
  stream { frame_rate_hz: 60 }
)";
constexpr const char* kOperatorToken = "operator-operator-1";

/// Guests are players.
class Floaters : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kCove}}; }
  void adjust(service::WaterServerOptions& options) const override {
    auto access =
        access::Access::parse(std::string("operator ") + kOperatorToken + "\n", "tokens", core::Role::kPlayer);
    ASSERT_TRUE(access) << access.error().message;
    options.access.access = *std::move(access);
  }
};
class NoFloaters : public WaveServerTest {};

/// Returns the objects of the next frame that `wanted` accepts; empty if none comes.
std::vector<codec::FloaterSample> floatersWhen(
    ScriptedClient& client, const std::function<bool(const std::vector<codec::FloaterSample>&)>& wanted) {
  while (const auto frame = client.nextFrame(v1::LAYER_FLOATERS)) {
    auto floaters = codec::decodeFloaters(*frame);
    if (!floaters) {
      ADD_FAILURE() << floaters.error().message;
      break;
    }
    if (wanted(*floaters)) return *std::move(floaters);
  }
  ADD_FAILURE() << "no such frame came";
  return {};
}

std::vector<std::uint32_t> idsOf(const std::vector<codec::FloaterSample>& floaters) {
  std::vector<std::uint32_t> out;
  for (const codec::FloaterSample& floater : floaters) out.push_back(floater.floater_id);
  return out;
}

TEST_F(Floaters, OfTheSceneAreInTheFirstFrame) {
  ScriptedClient one = client();
  EXPECT_THAT(one.greeting().layers(), ElementsAre(v1::LAYER_SURFACE, v1::LAYER_FLOATERS, v1::LAYER_DIAGNOSTICS));
  EXPECT_GE(one.greeting().version().minor(), 6u);
  one.subscribe(v1::LAYER_FLOATERS);
  const auto floaters = floatersWhen(one, [](const auto& all) { return !all.empty(); });
  ASSERT_THAT(idsOf(floaters), ElementsAre(1u));
  EXPECT_EQ(floaters[0].kind, v1::FLOATER_KIND_BALL);
  EXPECT_DOUBLE_EQ(floaters[0].size_m, 0.6);
  EXPECT_NEAR(floaters[0].position_m[0], -4.0, 0.1);
}

TEST_F(Floaters, DroppedByOneAreSeenAndHeldByAnother) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  two.subscribe(v1::LAYER_FLOATERS);
  const v1::ServerMessage spawned = one.ask(spawnFloater(0, 4));
  ASSERT_TRUE(spawned.has_ack()) << spawned.reject().message();
  const std::uint32_t id = spawned.ack().floater_id();
  EXPECT_GT(id, 1u);
  EXPECT_EQ(spawned.ack().boat_id(), 0u);
  const auto isIn = [id](const auto& all) { return std::ranges::count(all, id, &codec::FloaterSample::floater_id); };
  EXPECT_EQ(floatersWhen(two, [&](const auto& all) { return isIn(all) == 1; }).size(), 2u);
  EXPECT_EQ(one.ask(splash(0.1)).ack().floater_id(), 0u) << "the id belongs to one answer only";

  ASSERT_TRUE(two.apply(holdFloater(id, 2, 4)));
  const auto held = floatersWhen(two, [&](const auto& all) {
    const auto at = std::ranges::find(all, id, &codec::FloaterSample::floater_id);
    return at != all.end() && at->is_held;
  });
  EXPECT_EQ(held.size(), 2u);

  ASSERT_TRUE(two.apply(removeFloater(id)));
  EXPECT_THAT(idsOf(floatersWhen(two, [&](const auto& all) { return isIn(all) == 0; })), ElementsAre(1u));
}

TEST_F(Floaters, BeyondTheCapacityReplaceTheOldest) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_FLOATERS);
  ASSERT_TRUE(one.apply(spawnFloater(0, 4)));
  v1::Command stone = spawnFloater(0, -4);
  stone.mutable_spawn_floater()->mutable_floater()->set_kind(v1::FLOATER_KIND_STONE);
  ASSERT_TRUE(one.apply(stone));
  EXPECT_TRUE(one.apply(spawnFloater(2, 4))) << "in place of the stone";
  EXPECT_TRUE(one.apply(spawnFloater(-2, 4))) << "in place of the oldest that is not the scene's own";
  const auto hasNewest = [](const auto& all) {
    return std::ranges::count(all, 5u, &codec::FloaterSample::floater_id) == 1;
  };
  EXPECT_THAT(idsOf(floatersWhen(one, hasNewest)), UnorderedElementsAre(1u, 4u, 5u));
}

TEST_F(Floaters, UnknownIdsAreRejectedAndNamed) {
  ScriptedClient one = client();
  const v1::Reject hold = one.rejected(holdFloater(77, 0, 0));
  EXPECT_EQ(hold.reason(), v1::REJECT_REASON_UNKNOWN_FLOATER);
  EXPECT_EQ(hold.field(), "hold_floater.floater_id");
  EXPECT_THAT(hold.message(), HasSubstr("77"));
  const v1::Reject remove = one.rejected(removeFloater(77));
  EXPECT_EQ(remove.reason(), v1::REJECT_REASON_UNKNOWN_FLOATER);
  EXPECT_EQ(remove.field(), "remove_floater.floater_id");
  EXPECT_EQ(one.rejected(spawnFloater(5, 0)).field(), "spawn_floater.floater.x_m") << "in a rock";
}

TEST_F(Floaters, OnlyAnOperatorRemovesAllAtOnce) {
  ScriptedClient player = client();
  EXPECT_EQ(player.rejected(removeFloaters()).reason(), v1::REJECT_REASON_FORBIDDEN);
  ScriptedClient chief = person({.token = kOperatorToken});
  chief.subscribe(v1::LAYER_FLOATERS);
  EXPECT_EQ(chief.rejected(removeFloater(0)).reason(), v1::REJECT_REASON_UNKNOWN_FLOATER)
      << "a forgotten id is not all";
  ASSERT_TRUE(chief.apply(removeFloaters()));
  EXPECT_TRUE(floatersWhen(chief, [](const auto& all) { return all.empty(); }).empty());
}

TEST_F(NoFloaters, ARoomWithoutThemRejectsTheirCommands) {
  ScriptedClient one = client();
  for (const v1::Command& command : {spawnFloater(0, 0), holdFloater(1, 0, 0), removeFloater(1)}) {
    const v1::Reject reject = one.rejected(command);
    EXPECT_EQ(reject.reason(), v1::REJECT_REASON_ABSENT_PART);
    EXPECT_THAT(reject.message(), HasSubstr("no floaters"));
  }
}

}  // namespace
}  // namespace spindrift::test
