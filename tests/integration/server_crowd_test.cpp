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

  /// Frames encoded and offered up to a time.
  struct Counts {
    std::uint64_t surface = 0;  ///< encoded frames of the packed surface
    std::uint64_t encoded = 0;  ///< of all streams and levels
    std::uint64_t offered = 0;  ///< to all sessions
  };
  Counts counts() const {
    Counts out;
    const std::size_t surface = codec::indexOf(codec::streamOf(v1::LAYER_SURFACE, v1::PACKING_PACKED));
    const rooms::EncoderThread::Costs costs = encoder().costs();
    for (std::size_t stream = 0; stream < costs.size(); ++stream) {
      for (const auto& level : costs[stream]) {
        out.encoded += level.frame_count;
        if (stream == surface) out.surface += level.frame_count;
      }
    }
    out.offered = offeredFrameCount();
    return out;
  }
};

TEST_F(Crowd, TwoHundredClientsGetFramesAndAnswers) {
  auto scene = scene::parseSceneText(rooms()[0].scene, "main");
  ASSERT_TRUE(scene);
  const auto url = net::ClientUrl::parse("ws://127.0.0.1:" + std::to_string(server().port()) + "/ws");
  Counts before;
  Counts after;
  const bench::CrowdReport crowd = bench::runCrowd(
      *url, bench::sceneCrowd(*scene, 200, 6.0), [&] { before = counts(); }, [&] { after = counts(); });
  EXPECT_EQ(crowd.connected_count, 200u);
  EXPECT_EQ(crowd.lost_count, 0u);
  EXPECT_EQ(crowd.unanswered_count, 0u);
  EXPECT_GE(crowd.answers_ms.size(), 100u);
  EXPECT_GE(crowd.median_frames, 3u);
  EXPECT_GE(2 * crowd.fewest_frames, crowd.median_frames) << "a client gets too few frames";
  const std::uint64_t encoded_count = after.encoded - before.encoded;
  // A frame that was in flight when the measurement began may arrive within it.
  EXPECT_LE(crowd.most_frames, after.surface - before.surface + 2) << "a client gets a frame twice";
  // Each frame goes to all two hundred clients; frames encoded twice would be half as many as the clients were given.
  // In thirds, because on a busy machine frames are on their way between the two counts.
  EXPECT_GE(encoded_count, 3u);
  EXPECT_LE(3 * 200 * encoded_count, 4 * (after.offered - before.offered) + 3 * 200 * 4 * kWaitingFrames)
      << "encoded once, whatever the number of clients";
  EXPECT_EQ(server().networkStats().evicted_session_count, 0u);
}

}  // namespace
}  // namespace spindrift::test
