// kill -9 of the server that runs the rooms of a cluster, at random moments under load: another server continues with
// them, nothing that clients behind an edge had acknowledged is lost, and the rooms are what snapshot and log give,
// bit for bit. SPINDRIFT_CLUSTER_KILLS is the number of kills, SPINDRIFT_KILL_SEED their random seed,
// SPINDRIFT_KILL_KEEP a new folder for the files of a failed test.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <spdlog/spdlog.h>

#include "cluster_fixture.h"
#include "kept_check.h"
#include "kill_load.h"
#include "kill_scenes.h"

namespace spindrift::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kKillCount = 4;
/// The last one is opened over REST.
const std::vector<std::string> kRooms{"main", "tank", "sea", "extra"};
const std::vector<std::string> kScenesOfRooms{"kill_pool", "kill_tank", "kill_sea", "kill_pool"};

class ClusterKill : public ClusterTest {
 protected:
  struct Totals {
    std::size_t kill_count = 0;
    std::size_t acknowledged_count = 0;
    std::size_t unknown_count = 0;  ///< neither acknowledged nor rejected
    std::size_t in_log_count = 0;
    std::size_t before_snapshot_count = 0;
    std::size_t record_count = 0;  ///< carried out again for the comparisons
    std::size_t room_count = 0;    ///< that continued at another server as the test restored them, twice
    std::size_t person_count = 0;
    std::size_t boat_count = 0;
    double longest_takeover_s = 0.0;  ///< from the kill to the last room's first snapshot elsewhere
  };

  void SetUp() override {
    ClusterTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    spdlog::set_level(spdlog::level::warn);
    folder_.write("kill_pool.textproto", kPool);
    folder_.write("kill_tank.textproto", kTank);
    folder_.write("kill_sea.textproto", kSea);
    device_.kind = gpu::DeviceChoice::Kind::kSoftware;
    random_.seed(static_cast<std::mt19937::result_type>(variableOr("SPINDRIFT_KILL_SEED", 1)));
    for (std::uint32_t k = 0; k < 5; ++k) players_.emplace_back(k + 1, kRooms[k % kRooms.size()]);
  }

  void TearDown() override {
    if (totals_.kill_count > 0) printSummary();
    const char* const keep = std::getenv("SPINDRIFT_KILL_KEEP");
    if (keep != nullptr && HasFailure()) fs::copy(folder_.path(), keep, fs::copy_options::recursive);
  }

  [[nodiscard]] fs::path stateFolder() const { return folder_.path() / "state"; }
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }

  Member startServer(const std::string& name) {
    static const char* const kSync[] = {"never", "snapshots", "always"};
    static const char* const kInterval[] = {"0.7", "10"};
    // A member that is started again waits for its own line in the log.
    fs::remove(folder_.path() / (name + ".log"));
    return start(fmt::format("serve --device software --scene '{}' --room 'tank={}' --room 'sea={}' --state-dir '{}' "
                             "--grace-s 600 --sync {} --snapshot-every-s {} --address-share 1",
                             scene("kill_pool"), scene("kill_tank"), scene("kill_sea"), stateFolder().string(),
                             kSync[below(3)], kInterval[below(2)]),
                 name);
  }

  void startCluster() {
    running_ = startServer("s1");
    edge_ = edge("e1", "--address-share 1");
    ASSERT_NE(edge_.port, 0);
    ASSERT_EQ(post(edge_.port, "/api/v1/rooms", R"({"name": "extra", "scene": "kill_pool"})").status, 201u);
    for (std::size_t k = 0; k < kRooms.size(); ++k)
      ledger_.setRoom(kRooms[k], RoomFact::State::kOpen, kScenesOfRooms[k]);
    waiting_ = startServer("s2");
    ASSERT_TRUE(eventually([&] { return metric(edge_.port, "cluster_servers") == 2; }));
  }

  /// Waits until a command through the edge reaches every room.
  void waitForRooms() {
    for (const std::string& room : kRooms) {
      const bool is_reached = eventually([&] {
        const auto answer = post(edge_.port, "/api/v1/rooms/" + room + "/commands",
                                 R"({"command_id": 1, "remove_boat": {"boat_id": 999}})");
        return answer.body.find("REJECT_REASON_UNKNOWN_BOAT") != std::string::npos;
      });
      ASSERT_TRUE(is_reached) << "room " << room << edge_.process->log();
    }
  }

  /// Connects the players as the same people; checks that they are known and own what they were promised. Begins a
  /// new round.
  void checkPeople() {
    std::vector<Belongings> promises;
    for (const Player& player : players_) promises.push_back(player.promised(ledger_));
    ledger_.beginRound();
    for (std::size_t k = 0; k < players_.size(); ++k) {
      Player& player = players_[k];
      SCOPED_TRACE(fmt::format("player {} in room {}", k + 1, player.room()));
      const Belongings found = player.comeBack(edge_.port, ledger_);
      ASSERT_NE(found.person_id, 0u) << edge_.process->log();
      if (promises[k].person_id == 0) continue;
      expectKept(player, promises[k], found);
      ++totals_.person_count;
      totals_.boat_count += promises[k].boats.size();
    }
  }

  /// Plays, kills the server of the rooms, and keeps what it left behind. The other server stands still until that is
  /// done, so it has touched nothing of it.
  void playUntilKilled() {
    std::atomic<bool> is_over = false;
    std::vector<std::jthread> threads;
    for (Player& player : players_)
      threads.emplace_back(
          [&, random = std::mt19937(random_())] { player.play(edge_.port, ledger_, random, is_over); });
    std::this_thread::sleep_for(std::chrono::milliseconds(100 + below(2400)));
    waiting_.process->signal(SIGSTOP);
    running_.process->signal(SIGKILL);
    killed_ = Clock::now();
    is_over = true;
    EXPECT_EQ(running_.process->wait(), 128 + SIGKILL);
    newest_ = copyOf(stateFolder(), "newest");
    waiting_.process->signal(SIGCONT);
    ++totals_.kill_count;
  }

  /// Waits for the first snapshot of each room by its new server. Reads all rooms in turn: a room that is there early
  /// removes its first snapshot after two more, which may be before another room is there.
  std::map<std::string, v1::KeptState> statesElsewhere() {
    std::map<std::string, v1::KeptState> out;
    const bool are_there = eventually([&] {
      for (const std::string& room : kRooms) {
        if (out.contains(room)) continue;
        if (auto state = readSnapshot(stateFolder(), room, lastGeneration(newest_, room) + 1))
          out[room] = *std::move(state);
      }
      return out.size() == kRooms.size();
    });
    EXPECT_TRUE(are_there) << out.size() << " of " << kRooms.size() << " rooms: " << waiting_.process->log();
    totals_.longest_takeover_s =
        std::max(totals_.longest_takeover_s, std::chrono::duration<double>(Clock::now() - killed_).count());
    return out;
  }

  /// Compares the rooms of the new server with what the files of the killed one give, and these with what was
  /// acknowledged.
  void checkRooms(const std::map<std::string, v1::KeptState>& elsewhere) {
    const fs::path older = copyOf(newest_, "older");
    removeNewestSnapshots(older);
    auto newest_store = history::StateStore::open({.folder = newest_});
    auto older_store = history::StateStore::open({.folder = older});
    ASSERT_TRUE(newest_store && older_store);
    const auto facts = ledger_.rooms();
    for (const std::string& room : kRooms) {
      SCOPED_TRACE("room " + room);
      auto place = (*older_store)->place(room);
      ASSERT_TRUE(place) << place.error().message;
      ASSERT_TRUE(place->kept);
      const KeptCommands found = findAll(ledger_.commands(), room, facts.at(room).opening, *place->kept);
      EXPECT_THAT(found.lost, testing::IsEmpty());
      totals_.in_log_count += found.in_log_count;
      totals_.before_snapshot_count += found.before_snapshot_count;
      totals_.record_count += place->kept->records.size();
      place = core::Error{core::ErrorCode::kInternal, "closed"};  // releases the room
      const auto restored = restoredTwice(**newest_store, **older_store, room, device_);
      ASSERT_TRUE(restored);
      ASSERT_TRUE(elsewhere.contains(room));
      EXPECT_THAT(differences(*restored, elsewhere.at(room)), testing::IsEmpty()) << "at the new server";
      ++totals_.room_count;
    }
    for (const SentCommand& sent : ledger_.commands()) {
      totals_.acknowledged_count += sent.state == SentCommand::State::kAcknowledged ? 1 : 0;
      totals_.unknown_count += sent.state == SentCommand::State::kUnanswered ? 1 : 0;
    }
  }

  void printSummary() const {
    std::printf(
        "%zu kills of the server of %zu rooms: of %zu acknowledged commands %zu were found in the logs and %zu are "
        "older than the kept snapshots; of %zu it is not known; %zu rooms continued elsewhere, equal bit for bit to "
        "two restorations with %zu records carried out again; %zu people resumed with %zu boats; at most %.2f s from "
        "the kill to the last room's first snapshot\n",
        totals_.kill_count, kRooms.size(), totals_.acknowledged_count, totals_.in_log_count,
        totals_.before_snapshot_count, totals_.unknown_count, totals_.room_count, totals_.record_count,
        totals_.person_count, totals_.boat_count, totals_.longest_takeover_s);
  }

  gpu::DeviceChoice device_;
  std::mt19937 random_;
  Ledger ledger_;
  std::vector<Player> players_;
  Member running_;  ///< runs all rooms
  Member waiting_;
  Member edge_;
  fs::path newest_;  ///< copy of what the killed server left behind
  Clock::time_point killed_{};
  Totals totals_;
};

TEST_F(ClusterKill, TakeoverLosesNothingAcknowledged) {
  const std::uint64_t kills = variableOr("SPINDRIFT_CLUSTER_KILLS", kKillCount);
  std::string killed_name = "s1";
  std::string other_name = "s2";
  ASSERT_NO_FATAL_FAILURE(startCluster());
  while (totals_.kill_count < kills) {
    SCOPED_TRACE(fmt::format("kill {}", totals_.kill_count + 1));
    ASSERT_NO_FATAL_FAILURE(waitForRooms());
    ASSERT_NO_FATAL_FAILURE(checkPeople());
    playUntilKilled();
    ASSERT_NO_FATAL_FAILURE(checkRooms(statesElsewhere()));
    if (HasFailure()) return;
    running_ = std::move(waiting_);
    waiting_ = startServer(killed_name);
    ASSERT_NE(waiting_.port, 0);
    std::swap(killed_name, other_name);
    ASSERT_TRUE(eventually([&] { return metric(edge_.port, "cluster_servers") == 2; }));
  }
  ASSERT_NO_FATAL_FAILURE(waitForRooms());
  ASSERT_NO_FATAL_FAILURE(checkPeople());
  EXPECT_GT(totals_.in_log_count, 0u);
}

}  // namespace
}  // namespace spindrift::test
