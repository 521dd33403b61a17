// What of a room's messages is recorded, and what each file begins with.
#include <spindrift/recording/water_recorder.h>

#include "recording_test.h"

namespace spindrift::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct WaterRecorderTest : testing::Test {
  std::unique_ptr<WaterRecorder> begin(bool is_for_foxglove = false) {
    auto recorder =
        WaterRecorder::begin({.files = {.folder = "/", .name = "run", .file_max_bytes = kMiB, .max_bytes = 10 * kMiB},
                              .max_duration = std::chrono::seconds(60),
                              .is_for_foxglove = is_for_foxglove},
                             now, disk.opener());
    EXPECT_TRUE(recorder);
    return *std::move(recorder);
  }
  static core::SharedBytes state(const std::string& path, double value) {
    v1::ServerMessage out;
    out.mutable_parameter_changed()->set_path(path);
    out.mutable_parameter_changed()->set_value(value);
    return codec::serialized(out);
  }

  MemoryDisk disk;
  WaterRecorder::WallClock::time_point now{std::chrono::seconds(1'000'000)};
};

TEST_F(WaterRecorderTest, LayersGreetingAndStateAreRecordedAndPeopleAreNot) {
  const auto recorder = begin();
  v1::ServerMessage people;
  people.mutable_people()->add_people()->set_name("Ada");
  v1::ServerMessage answer;
  answer.mutable_ack()->set_command_id(1);
  v1::ServerMessage unknown;
  unknown.mutable_frame()->set_layer(static_cast<v1::Layer>(99));
  ASSERT_TRUE(recorder->take(*frame(v1::LAYER_SURFACE, 1, true), now)) << "before the greeting: ignored";
  for (const auto& message :
       {greeting(), frame(v1::LAYER_SURFACE, 2, true), state("gravity_mps2", 3), codec::serialized(people),
        codec::serialized(answer), codec::serialized(unknown), core::share({0xff, 0xff})})
    ASSERT_TRUE(recorder->take(*message, now));
  EXPECT_EQ(recorder->counts().message_count, 3u);
  EXPECT_EQ(recorder->counts().malformed_count, 1u);
  ASSERT_TRUE(recorder->finish());
  for (const char* const part :
       {"/spindrift/surface", "/spindrift/greeting", "/spindrift/state", "spindrift.v1.ServerMessage", "harbor"})
    EXPECT_TRUE(disk.contains("run_0001.mcap", part)) << part;
  EXPECT_FALSE(disk.contains("run_0001.mcap", "Ada"));
}

TEST_F(WaterRecorderTest, NewFileBeginsWithWhatDescribesTheRoomNow) {
  const auto recorder = begin();
  for (const auto& message :
       {greeting("old"), state("a", 1), greeting("splash"), state("a", 2), state("a", 3), state("b", 4)})
    ASSERT_TRUE(recorder->take(*message, now));
  std::uint64_t tick = 0;
  while (!recorder->takeKeyframeWish())
    ASSERT_TRUE(recorder->take(*frame(v1::LAYER_SURFACE, ++tick, true, 100'000), now));
  EXPECT_FALSE(recorder->takeKeyframeWish());
  EXPECT_EQ(recorder->counts().message_count, 6 + tick + 3) << "greeting, a and b again";
  EXPECT_THAT(recorder->files(), ElementsAre("run_0001.mcap", "run_0002.mcap"));
  ASSERT_TRUE(recorder->finish());
  EXPECT_TRUE(disk.contains("run_0002.mcap", "splash"));
  EXPECT_EQ(recorder->counts().skipped_count, 0u);
}

TEST_F(WaterRecorderTest, BoundsEndTheRecording) {
  const auto timed = begin();
  ASSERT_TRUE(timed->review(now + std::chrono::seconds(59)));
  EXPECT_FALSE(timed->end());
  ASSERT_TRUE(timed->review(now + std::chrono::seconds(60)));
  EXPECT_THAT(timed->end().value(), HasSubstr("60 s"));
  disk.files.clear();
  const auto large = begin();
  ASSERT_TRUE(large->take(*greeting(), now));
  for (std::uint64_t tick = 0; !large->end(); ++tick)
    ASSERT_TRUE(large->take(*frame(v1::LAYER_SURFACE, tick, true, 100'000), now));
  EXPECT_THAT(large->end().value(), HasSubstr("10485760 bytes"));
  ASSERT_TRUE(large->finish());
}

TEST_F(WaterRecorderTest, FullDiskIsAnError) {
  disk.max_bytes = 100'000;
  const auto recorder = begin();
  ASSERT_TRUE(recorder->take(*greeting(), now));
  ASSERT_TRUE(recorder->take(*frame(v1::LAYER_SURFACE, 1, true, 100'000), now));
  const auto reviewed = recorder->review(now + std::chrono::seconds(2));
  ASSERT_FALSE(reviewed);
  EXPECT_EQ(reviewed.error().message, "the disk is full");
}

TEST_F(WaterRecorderTest, TimesOfTheWireMayBeAnything) {
  const auto recorder = begin();
  ASSERT_TRUE(recorder->take(*greeting(), now));
  for (const double time_s : {-1.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    v1::ServerMessage message;
    message.mutable_diagnostics()->set_time_s(time_s);
    ASSERT_TRUE(recorder->take(*codec::serialized(message), now));
  }
  EXPECT_EQ(recorder->counts().message_count, 4u);
}

TEST_F(WaterRecorderTest, FoxglovesSchemasAreAddedOnRequest) {
  const auto recorder = begin(true);
  ASSERT_TRUE(recorder->take(*greeting(), now));
  v1::ServerMessage diagnostics;
  diagnostics.mutable_diagnostics()->set_gauges_time_s(2.0);
  diagnostics.mutable_diagnostics()->add_gauges()->set_name("pier");
  ASSERT_TRUE(recorder->take(*codec::serialized(diagnostics), now));
  EXPECT_EQ(recorder->counts().message_count, 4u) << "greeting, diagnostics, the same and a gauge for Foxglove";
  ASSERT_TRUE(recorder->take(*frame(v1::LAYER_SURFACE, 1, true), now));
  EXPECT_EQ(recorder->counts().message_count, 5u);
  EXPECT_EQ(recorder->counts().skipped_count, 1u) << "a layer that is damaged";
  ASSERT_TRUE(recorder->finish());
  EXPECT_TRUE(disk.contains("run_0001.mcap", "spindrift.v1.GaugeReading"));
}

}  // namespace
}  // namespace spindrift::recording
