// Two hundred clients on one server: every client gets frames, every command is answered, and nothing is encoded twice.
#include <spindrift/bench/scene_crowd.h>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

class Crowd : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", R"(
      wave { resolution_count: 128 side_m: 16 depth_m: 1.5 }
      particles { count: 2048 layers_count: 2 headroom_m: 2 }
      coupling {}
      foam {}
      boats { capacity_count: 4 boats { x_m: 3 z_m: 0 } }
      stream { frame_rate_hz: 20 }
    )"}};
  }
  void adjust(service::WaterServerOptions& options) const override { options.network.max_session_count = 512; }

  /// Number of packed frames of a layer encoded so far.
  std::uint64_t encodedCount(v1::Layer layer) const {
    std::uint64_t count = 0;
    const rooms::EncoderThread::Costs costs = encoder().costs();
    for (const auto& level : costs[codec::indexOf(codec::streamOf(layer, v1::PACKING_PACKED))])
      count += level.frame_count;
    return count;
  }
};

TEST_F(Crowd, AllTwoHundredGetFramesAndEveryCommandIsAnswered) {
  auto scene = scene::parseSceneText(rooms()[0].scene, "main");
  ASSERT_TRUE(scene);
  const auto url = net::ClientUrl::parse("ws://127.0.0.1:" + std::to_string(server().port()) + "/ws");
  std::uint64_t encoded_before = 0;
  std::uint64_t encoded_after = 0;
  const bench::CrowdReport crowd = bench::runCrowd(
      *url, bench::sceneCrowd(*scene, 200, 6.0), [&] { encoded_before = encodedCount(v1::LAYER_SURFACE); },
      [&] { encoded_after = encodedCount(v1::LAYER_SURFACE); });
  EXPECT_EQ(crowd.connected_count, 200u);
  EXPECT_EQ(crowd.lost_count, 0u);
  EXPECT_EQ(crowd.unanswered_count, 0u);
  EXPECT_GE(crowd.answers_ms.size(), 100u);
  EXPECT_GE(crowd.median_frames, 3u);
  EXPECT_GE(2 * crowd.fewest_frames, crowd.median_frames) << "a client gets too few frames";
  // A frame that was in flight when the measurement began may arrive within it.
  EXPECT_LE(crowd.most_frames, encoded_after - encoded_before + 2) << "encoded once, whatever the number of clients";
  EXPECT_EQ(server().networkStats().evicted_session_count, 0u);
}

}  // namespace
}  // namespace spindrift::test
