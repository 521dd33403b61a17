// Fingers of several people in one water: everybody feels them, everybody sees whose they are.
#include <set>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

class ServerStrokes : public WaveServerTest {};

/// Returns the next list of fingers that `wanted` accepts; empty if none comes.
std::optional<v1::Strokes> fingersWhen(ScriptedClient& client, const std::function<bool(const v1::Strokes&)>& wanted) {
  while (const auto message = client.waitFor(v1::ServerMessage::kStrokes)) {
    if (wanted(message->strokes())) return message->strokes();
  }
  return std::nullopt;
}

TEST_F(ServerStrokes, MoveTheWaterForAllAndShowWhoseFingerItIs) {
  ScriptedClient draws = client();
  ScriptedClient watches = client();
  watches.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(draws.apply(stroke(5, 0.0, -1.0, 0.5)));
  ASSERT_TRUE(draws.apply(stroke(5, 0.4, 1.0, 0.5)));
  const auto seen =
      fingersWhen(watches, [](const v1::Strokes& s) { return s.fingers_size() == 1 && s.fingers(0).x_m() > 0; });
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->fingers(0).person_id(), draws.welcome().person_id());
  EXPECT_EQ(seen->fingers(0).stroke_id(), 5u);
  EXPECT_NEAR(seen->fingers(0).z_m(), 0.5, 1e-9);
  EXPECT_GT(seen->time_s(), 0.0);
  bool rises = false;
  for (int k = 0; k < 200 && !rises; ++k) {
    const auto frame = watches.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    rises = maxElevation_m(*frame) > 0.005;
  }
  EXPECT_TRUE(rises);
  ASSERT_TRUE(draws.apply(stroke(5, 0.45, 1.0, 0.5, true)));
  EXPECT_TRUE(fingersWhen(watches, [](const v1::Strokes& s) { return s.fingers_size() == 0; }));
}

TEST_F(ServerStrokes, OfTwoPeopleWithTheSameNumberAreTwo) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  ASSERT_TRUE(one.apply(stroke(1, 0.0, -2.0, 0.0)));
  v1::Command forged = stroke(1, 0.0, 2.0, 0.0);
  forged.mutable_stroke()->set_person_id(one.welcome().person_id());
  ASSERT_TRUE(two.apply(forged));
  const auto seen = fingersWhen(one, [](const v1::Strokes& s) { return s.fingers_size() == 2; });
  ASSERT_TRUE(seen);
  std::set<std::uint32_t> people;
  for (const v1::Finger& finger : seen->fingers()) people.insert(finger.person_id());
  EXPECT_EQ(people, (std::set{one.welcome().person_id(), two.welcome().person_id()}));
}

TEST_F(ServerStrokes, OfAClientThatVanishesAreLifted) {
  ScriptedClient watches = client();
  {
    ScriptedClient draws = client();
    ASSERT_TRUE(draws.apply(stroke(1, 0.0, 0.0, 0.0)));
    ASSERT_TRUE(fingersWhen(watches, [](const v1::Strokes& s) { return s.fingers_size() == 1; }));
  }
  EXPECT_TRUE(fingersWhen(watches, [](const v1::Strokes& s) { return s.fingers_size() == 0; }));
}

TEST_F(ServerStrokes, MoreFingersThanAPersonHasAreRejected) {
  ScriptedClient draws = client();
  for (std::uint32_t k = 0; k < 10; ++k) ASSERT_TRUE(draws.apply(stroke(k, 0.0, 0.1 * k, 0.0)));
  const v1::Reject rejected = draws.rejected(stroke(10, 0.0, 0.0, 0.0));
  EXPECT_EQ(rejected.reason(), v1::REJECT_REASON_BUSY);
  EXPECT_THAT(rejected.message(), HasSubstr("10 strokes of one person"));
}

}  // namespace
}  // namespace spindrift::test
