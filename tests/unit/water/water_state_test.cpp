// Floaters in the saved water: as a message, and back.
#include <gmock/gmock.h>

#include <spindrift/scene/to_core.h>
#include <spindrift/water/water_state.h>

namespace spindrift::water {
namespace {

using testing::HasSubstr;

/// A free slot, and one floater of each kind with no number at its default.
sim::SavedState savedFloaters() {
  sim::SavedState out;
  out.host.floaters.places.push_back({});
  for (std::uint32_t id = 1; id < static_cast<std::uint32_t>(v1::FloaterKind_ARRAYSIZE); ++id) {
    const core::Floater floater{.kind = scene::toCore(static_cast<v1::FloaterKind>(id)),
                                .x_m = -1.5 * id,
                                .y_m = 0.25,
                                .z_m = 3.0,
                                .heading_deg = 45.0,
                                .size_m = 0.1 * id,
                                .density_ratio = 0.7,
                                .ballast_ratio = -0.5,
                                .velocity_x_mps = 1.0,
                                .velocity_y_mps = -2.0,
                                .velocity_z_mps = 3.0};
    out.host.floaters.places.push_back({id, floater});
  }
  out.host.floaters.next_id = 40;
  return out;
}

TEST(KeptFloaters, ComeBackAsTheyWere) {
  const sim::SavedState saved = savedFloaters();
  v1::WaterState message;
  ASSERT_TRUE(message.ParseFromString(toMessage(saved).SerializeAsString()));
  const auto back = toSavedState(message);
  ASSERT_TRUE(back) << back.error().message;
  const auto& places = back->host.floaters.places;
  ASSERT_EQ(places.size(), 9u);
  for (std::size_t k = 0; k < places.size(); ++k) {
    EXPECT_EQ(places[k].floater_id, k);
    EXPECT_TRUE(places[k].floater == saved.host.floaters.places[k].floater) << "slot " << k;
  }
  EXPECT_EQ(back->host.floaters.next_id, 40u);
  EXPECT_EQ(sim::hashOf(*back), sim::hashOf(saved));
}

TEST(KeptFloaters, OfAnOlderServerAreNoneWithTheFirstNumberFree) {
  v1::WaterState message = toMessage(sim::SavedState{});
  message.clear_next_floater_id();
  const auto back = toSavedState(message);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(back->host.floaters.places.empty());
  EXPECT_EQ(back->host.floaters.next_id, 1u);
}

TEST(KeptFloaters, MoreThanThereCanBeAreDamage) {
  v1::WaterState message = toMessage(sim::SavedState{});
  for (std::uint32_t k = 0; k < core::kMaxFloaters; ++k) message.add_floaters();
  EXPECT_TRUE(toSavedState(message));
  message.add_floaters();
  const auto back = toSavedState(message);
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().code, core::ErrorCode::kInvalidInput);
  EXPECT_THAT(back.error().message, HasSubstr("more floaters than there can be"));
}

TEST(KeptFloaters, OfAnUnknownKindAreCrates) {
  v1::WaterState message = toMessage(savedFloaters());
  message.mutable_floaters(3)->mutable_floater()->set_kind(static_cast<v1::FloaterKind>(77));
  const auto back = toSavedState(message);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->host.floaters.places[3].floater.kind, core::FloaterKind::kCrate);
}

}  // namespace
}  // namespace spindrift::water
