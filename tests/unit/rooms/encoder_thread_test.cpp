// The encoder thread with a receiver that is slower than the rooms: which rooms' frames are encoded, and how many.
#include <array>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <spindrift/rooms/encoder_thread.h>

namespace spindrift::rooms {
namespace {

using testing::ElementsAre;

/// A receiver that holds the encoder thread at each published frame until the test lets it continue.
class HeldOutlet final : public FrameOutlet {
 public:
  void publish(const std::string& room, codec::Stream, const codec::EncodedFrame&, const core::FrameLevels&) override {
    std::unique_lock lock(mutex_);
    published_.push_back(room);
    changed_.notify_all();
    changed_.wait(lock, [&] { return permitted_count_ >= published_.size(); });
  }

  /// Waits until the encoder thread holds its frame number `count`, counted from 1.
  void waitForHeld(std::size_t count) {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(changed_.wait_for(lock, std::chrono::seconds(30), [&] { return published_.size() >= count; }));
  }
  /// Lets the encoder thread publish this many frames in all.
  void permit(std::size_t count) {
    const std::lock_guard lock(mutex_);
    permitted_count_ = count;
    changed_.notify_all();
  }
  /// The rooms of the published frames, in order.
  std::vector<std::string> published() {
    const std::lock_guard lock(mutex_);
    return published_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> published_;
  std::size_t permitted_count_ = 0;
};

core::FrameView frame() {
  static const std::array<std::uint32_t, 2> kWords{};
  core::FrameView out;
  out.at(core::Level::kFull).surface = core::SurfaceView{{2, 2}, 1.0, 1.0, 0.001, kWords};
  return out;
}

struct EncoderThreadTest : testing::Test {
  HeldOutlet outlet;
  const std::shared_ptr<core::DemandTable> demand = std::make_shared<core::DemandTable>();
  EncoderThread encoder{outlet, 1};

  void SetUp() override {
    const codec::Stream surface = codec::streamOf(v1::LAYER_SURFACE, v1::PACKING_PLAIN);
    demand->set(codec::indexOf(surface), this, core::DemandTable::Need{});
  }
  void TearDown() override { outlet.permit(1'000'000); }
};

TEST_F(EncoderThreadTest, EveryRoomGetsItsShareWhenTheEncoderIsTooSlow) {
  const std::array<std::string, 3> rooms = {"a", "b", "c"};
  constexpr std::size_t kFrameCount = 30;
  for (const std::string& room : rooms) encoder.submit(room, demand, frame());
  for (std::size_t count = 1; count <= kFrameCount; ++count) {
    ASSERT_NO_FATAL_FAILURE(outlet.waitForHeld(count));
    for (const std::string& room : rooms) encoder.submit(room, demand, frame());
    if (count < kFrameCount) outlet.permit(count);
  }
  std::map<std::string, int> counts;
  for (const std::string& room : outlet.published()) ++counts[room];
  for (const std::string& room : rooms) {
    EXPECT_GE(counts[room], 9) << room;
    EXPECT_EQ(encoder.frameCounts(room).encoded_count, static_cast<std::uint64_t>(counts[room])) << room;
    EXPECT_GT(encoder.frameCounts(room).replaced_count, 15u) << room;
  }
}

TEST_F(EncoderThreadTest, ANewerFrameTakesThePlaceOfItsRoomInTheQueue) {
  encoder.submit("busy", demand, frame());
  ASSERT_NO_FATAL_FAILURE(outlet.waitForHeld(1));
  for (const char* room : {"z", "m", "a", "z"}) encoder.submit(room, demand, frame());
  outlet.permit(4);
  ASSERT_NO_FATAL_FAILURE(outlet.waitForHeld(4));
  EXPECT_THAT(outlet.published(), ElementsAre("busy", "z", "m", "a"));
  EXPECT_EQ(encoder.frameCounts("z").replaced_count, 1u);
  EXPECT_EQ(encoder.frameCounts("m").replaced_count, 0u);
}

TEST_F(EncoderThreadTest, AForgottenRoomLeavesTheQueue) {
  encoder.submit("busy", demand, frame());
  ASSERT_NO_FATAL_FAILURE(outlet.waitForHeld(1));
  encoder.submit("closed", demand, frame());
  encoder.submit("open", demand, frame());
  encoder.forget("closed");
  outlet.permit(2);
  ASSERT_NO_FATAL_FAILURE(outlet.waitForHeld(2));
  EXPECT_THAT(outlet.published(), ElementsAre("busy", "open"));
  EXPECT_EQ(encoder.frameCounts("closed").encoded_count, 0u);
}

struct TwoEncoderThreads : EncoderThreadTest {
  EncoderThread two{outlet, 2};
};

TEST_F(TwoEncoderThreads, ARoomThatTakesLongDoesNotHoldUpTheOthers) {
  two.submit("long", demand, frame());
  ASSERT_NO_FATAL_FAILURE(outlet.waitForHeld(1));
  two.submit("long", demand, frame());  // waits: a room is encoded by one thread at a time
  two.submit("other", demand, frame());
  ASSERT_NO_FATAL_FAILURE(outlet.waitForHeld(2));
  EXPECT_THAT(outlet.published(), ElementsAre("long", "other"));
  EXPECT_EQ(two.frameCounts("long").encoded_count, 1u);
  outlet.permit(3);
  ASSERT_NO_FATAL_FAILURE(outlet.waitForHeld(3));
  EXPECT_THAT(outlet.published(), ElementsAre("long", "other", "long"));
}

}  // namespace
}  // namespace spindrift::rooms
