// Logs and snapshots of older versions: their state hashes cover less, and are compared as they were meant.
#include <array>
#include <stdexcept>

#include <gmock/gmock.h>

#include <spindrift/history/replay.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/water/room_water.h>
#include <spindrift/water/water_state.h>

#include "commands.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

const gpu::DeviceChoice kDevice{gpu::DeviceChoice::Kind::kSoftware, 0};

class RecordedHash : public testing::Test {
 protected:
  std::unique_ptr<water::RoomWater> make(const std::string& text) {
    auto scene = scene::parseSceneText(text, "pond");
    if (!scene) throw std::runtime_error(scene.error().message);
    auto water = water::Water::create(kDevice, *std::move(scene));
    if (!water) return nullptr;
    return std::make_unique<water::RoomWater>(*std::move(water));
  }

  static constexpr const char* kPond = "wave { resolution_count: 32 side_m: 12 depth_m: 1 } boats { boats { x_m: 2 } }";
  TemporaryFolder folder_;
};

TEST_F(RecordedHash, OfVersion0IsThatOfTheProgramThatWroteIt) {
  const auto water = make("wave { resolution_count: 32 side_m: 8 depth_m: 1 }");
  if (!water) GTEST_SKIP() << "no device";
  sim::StateCopy state = water->sim().copyState();
  state.elevation_m.at(0) = 0.25;
  state.flow_m2ps.at(1) = -1.5f;
  water->sim().setState(state);
  const auto hash = water::recordedHash(water->sim(), 0);
  ASSERT_TRUE(hash) << hash.error().message;
  // Calculated apart from the program: 64-bit FNV-1a over the elevations as doubles and the flow as floats.
  EXPECT_EQ(*hash, 0x6140c5df6308d515ull);
}

TEST_F(RecordedHash, AnOlderLogIsComparedByItsOwnDefinition) {
  const auto water = make(kPond);
  if (!water) GTEST_SKIP() << "no device";
  const auto written = [&](std::uint32_t version, std::uint32_t hashed_as) {
    const auto room = make(kPond);
    v1::RecordHeader header;
    *header.mutable_scene() = room->scene();
    header.set_state_hash_version(version);
    auto log = history::CommandLogWriter::create(folder_.path() / std::to_string(version * 10 + hashed_as), header);
    EXPECT_TRUE(log) << log.error().message;
    const auto write = [&](v1::Record record) {
      record.set_tick(room->tick());
      (*log)->write(std::move(record));
    };
    v1::Record command;
    *command.mutable_command() = splash(0.3);
    EXPECT_FALSE(room->apply(command.command()));
    write(command);
    for (int tick = 0; tick < 10; ++tick) room->step();
    v1::Record hash;
    hash.set_state_hash(*water::recordedHash(room->sim(), hashed_as));
    write(hash);
    return (*log)->file();
  };
  const auto replayed = [&](std::uint32_t version, std::uint32_t hashed_as) {
    auto log = history::CommandLogReader::open(written(version, hashed_as));
    EXPECT_TRUE(log) << log.error().message;
    return history::replayLog(kDevice, **log);
  };
  for (const std::uint32_t version : {0u, 1u}) {
    const auto outcome = replayed(version, version);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->hash_count, 1u);
    EXPECT_FALSE(outcome->difference) << "version " << version;
    const auto mixed = replayed(version, 1 - version);
    ASSERT_TRUE(mixed) << mixed.error().message;
    EXPECT_TRUE(mixed->difference) << "version " << version;
  }
  const auto newer = replayed(7, 1);
  ASSERT_FALSE(newer);
  EXPECT_THAT(newer.error().message, HasSubstr("state hashes are of version 7"));
}

TEST_F(RecordedHash, AnOlderSnapshotIsRestoredAndOneThatDiffersIsRefused) {
  const auto before = make(kPond);
  if (!before) GTEST_SKIP() << "no device";
  before->bind();
  ASSERT_FALSE(before->apply(splash(0.3)));
  for (int tick = 0; tick < 5; ++tick) before->step();
  v1::KeptState state;
  before->save(state);
  EXPECT_EQ(state.state_hash_version(), water::kStateHashVersion);
  v1::KeptState older = state;
  older.clear_state_hash_version();
  older.set_state_hash(*water::recordedHash(before->sim(), 0));
  // As version 0 wrote them: the buffers of checkpoints first.
  older.mutable_water()->mutable_buffers()->SwapElements(0, older.water().buffers_size() - 1);

  const auto after = make(kPond);
  after->bind();
  const auto restored = after->restore(older);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(after->sim().stateHash(), state.state_hash()) << "and nothing else is lost";

  const auto refusal = [&](const v1::KeptState& kept) {
    const auto done = after->restore(kept);
    return done ? std::string() : done.error().message;
  };
  older.set_state_hash(older.state_hash() ^ 1);
  EXPECT_THAT(refusal(older), HasSubstr("is damaged: its hash is"));
  older.set_state_hash_version(7);
  EXPECT_THAT(refusal(older), HasSubstr("state hashes are of version 7"));
  // What the hash of version 0 did not cover.
  state.mutable_water()->set_next_boat_id(9);
  EXPECT_THAT(refusal(state), HasSubstr("is damaged: its hash is"));
}

}  // namespace
}  // namespace spindrift::test
