// The recording of one room: what it asks of the room, and what happens while the disk is slow, and when it breaks.
#include "room_recording.h"

#include <condition_variable>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>

#include "recording_test.h"

namespace spindrift::service {
namespace {

using recording::frame;
using recording::kMiB;

constexpr codec::Stream kSurface{v1::LAYER_SURFACE, v1::PACKING_PACKED};

/// Lets a disk stand still.
class Gate {
 public:
  void close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
  }
  void open() {
    {
      const std::lock_guard lock(mutex_);
      is_closed_ = false;
    }
    opened_.notify_all();
  }
  void pass() {
    std::unique_lock lock(mutex_);
    opened_.wait(lock, [this] { return !is_closed_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable opened_;
  bool is_closed_ = false;
};

struct RoomRecordingTest : testing::Test {
  void SetUp() override {
    struct GatedSink final : mcap::Sink {
      GatedSink(std::unique_ptr<mcap::Sink> inner, Gate& its_gate) : sink(std::move(inner)), gate(its_gate) {}
      core::Result<void> append(core::ByteView bytes) override {
        gate.pass();
        return sink->append(bytes);
      }
      std::unique_ptr<mcap::Sink> sink;
      Gate& gate;
    };
    const auto open = [this](const std::filesystem::path& path) -> core::Result<std::unique_ptr<mcap::Sink>> {
      auto sink = disk.opener()(path);
      if (!sink) return sink.error();
      return std::unique_ptr<mcap::Sink>(std::make_unique<GatedSink>(*std::move(sink), gate));
    };
    auto recorder = recording::WaterRecorder::begin(
        {.files = {.folder = "/", .name = "run", .file_max_bytes = std::nullopt, .max_bytes = 1024 * kMiB},
         .max_duration = std::chrono::hours(1)},
        std::chrono::system_clock::now(), open);
    ASSERT_TRUE(recorder);
    recorded = std::make_unique<RoomRecording>(RoomRecordingSetup{.name = "run",
                                                                  .room = "main",
                                                                  .demand = demand,
                                                                  .streams = {kSurface},
                                                                  .level = core::Level::kFull,
                                                                  .max_bytes = 1024 * kMiB},
                                               *std::move(recorder), recording::greeting());
  }
  void TearDown() override { gate.open(); }

  void publish(core::SharedBytes keyframe, core::SharedBytes delta) {
    recorded->publish(kSurface, {.keyframe = std::move(keyframe), .delta = std::move(delta)}, {});
  }
  core::LevelDemand need() const {
    return demand->of(codec::indexOf(kSurface), std::chrono::steady_clock::now())[core::indexOf(core::Level::kFull)];
  }
  /// Waits; false after ten seconds.
  static bool until(const std::function<bool()>& holds) {
    for (int k = 0; k < 1000; ++k) {
      if (holds()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  v1::Recording ended() {
    recorded->end("it was stopped");
    EXPECT_TRUE(until([&] { return !recorded->isRunning(); }));
    return recorded->state();
  }

  recording::MemoryDisk disk;
  Gate gate;
  std::shared_ptr<core::DemandTable> demand = std::make_shared<core::DemandTable>();
  std::unique_ptr<RoomRecording> recorded;
};

TEST_F(RoomRecordingTest, IsOneMoreReaderOfTheRoomUntilItEnds) {
  EXPECT_EQ(need().watcher_count, 1u);
  EXPECT_TRUE(need().wants_keyframe);
  EXPECT_EQ(demand->sessionCount(), 1u);
  publish(nullptr, frame(v1::LAYER_SURFACE, 1, false));
  EXPECT_TRUE(need().wants_keyframe) << "a delta is of no use yet";
  publish(frame(v1::LAYER_SURFACE, 2, true), nullptr);
  EXPECT_FALSE(need().wants_keyframe);
  publish(frame(v1::LAYER_SURFACE, 3, true), frame(v1::LAYER_SURFACE, 3, false));
  const v1::Recording state = ended();
  EXPECT_EQ(state.message_count(), 3u) << "the greeting and two frames";
  EXPECT_EQ(state.skipped_count(), 0u);
  EXPECT_FALSE(state.failed());
  EXPECT_EQ(need().watcher_count, 0u);
  EXPECT_EQ(demand->sessionCount(), 0u);
  publish(frame(v1::LAYER_SURFACE, 4, true), nullptr);
  EXPECT_EQ(need().watcher_count, 0u);
}

TEST_F(RoomRecordingTest, SlowDiskDropsFramesAndTheLayerBeginsAgainWithAKeyframe) {
  publish(frame(v1::LAYER_SURFACE, 1, true), nullptr);
  gate.close();
  const core::SharedBytes delta = frame(v1::LAYER_SURFACE, 2, false, kMiB);
  const std::size_t most_count = RoomRecording::kWaitingMaxBytes / kMiB;
  for (std::size_t k = 0; k < 2 * most_count; ++k) publish(nullptr, delta);
  EXPECT_GT(recorded->state().dropped_count(), 0u);
  EXPECT_FALSE(need().wants_keyframe) << "it would not find room either";
  gate.open();
  const std::uint64_t dropped_count = recorded->state().dropped_count();
  ASSERT_TRUE(until([&] {
    publish(nullptr, frame(v1::LAYER_SURFACE, 3, false));  // of no use without the one before
    return need().wants_keyframe;
  }));
  EXPECT_EQ(recorded->state().dropped_count(), dropped_count) << "what does not follow is not put into the queue";
  publish(frame(v1::LAYER_SURFACE, 4, true), nullptr);
  publish(nullptr, frame(v1::LAYER_SURFACE, 5, false));
  const v1::Recording state = ended();
  EXPECT_FALSE(state.failed());
  EXPECT_EQ(state.skipped_count(), 0u);
  // Greeting and keyframe, the deltas that found room before the first that did not, and the two at the end.
  EXPECT_GE(state.message_count(), 2 + most_count / 2 + 2);
  EXPECT_LE(state.message_count(), 2 + 2 * most_count - state.dropped_count() + 2);
}

TEST_F(RoomRecordingTest, BrokenDiskEndsItWithTheReason) {
  disk.max_bytes = 1000;
  publish(frame(v1::LAYER_SURFACE, 1, true, 2 * kMiB), nullptr);
  ASSERT_TRUE(until([&] { return !recorded->isRunning(); }));
  EXPECT_TRUE(recorded->state().failed());
  EXPECT_EQ(recorded->state().ended(), "the disk is full");
  EXPECT_EQ(recorded->state().message_count(), 0u) << "they were in the chunk that was lost";
  EXPECT_EQ(demand->sessionCount(), 0u);
  bool is_done = false;
  recorded->end("it was stopped", [&] { is_done = true; });
  EXPECT_TRUE(is_done) << "at once";
  EXPECT_EQ(recorded->state().ended(), "the disk is full");
}

}  // namespace
}  // namespace spindrift::service
