// kill -9 of the program at random moments under load: nothing that it acknowledged is lost, and what its logs repeat
// is what was, bit for bit. SPINDRIFT_KILLS is the number of kills, SPINDRIFT_KILL_SEED their random seed,
// SPINDRIFT_KILL_KEEP a new folder for the files of a failed test.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <thread>

#include <boost/json.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <spdlog/spdlog.h>

#include "kept_check.h"
#include "kill_load.h"
#include "kill_scenes.h"
#include "program_fixture.h"

namespace spindrift::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kKillCount = 6;
const std::vector<std::string> kFixedRooms{"main", "tank", "sea"};
const std::vector<std::string> kOtherRooms{"extra0", "extra1"};

double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

class StateKill : public ProgramTest {
 protected:
  struct Totals {
    std::size_t kill_count = 0;
    std::size_t start_kill_count = 0;  ///< kills before the server was ready
    std::size_t acknowledged_count = 0;
    std::size_t in_log_count = 0;
    std::size_t before_snapshot_count = 0;
    std::size_t closed_count = 0;        ///< of rooms that were closed afterwards, or whose closing was not answered
    std::size_t hash_count = 0;          ///< rooms restored from the newest and from an older snapshot
    std::size_t program_hash_count = 0;  ///< rooms that the restarted program has as the test restored them
    std::size_t record_count = 0;        ///< carried out again for the comparisons
    std::size_t resumed_count = 0;
    std::size_t boat_count = 0;
    double longest_start_s = 0.0;
  };

  void SetUp() override {
    spdlog::set_level(spdlog::level::warn);
    device_.kind = gpu::DeviceChoice::Kind::kSoftware;
    pool_ = scene(kPool, "kill_pool.textproto");
    tank_ = scene(kTank, "kill_tank.textproto");
    sea_ = scene(kSea, "kill_sea.textproto");
    random_.seed(static_cast<std::mt19937::result_type>(variableOr("SPINDRIFT_KILL_SEED", 1)));
    for (std::uint32_t k = 0; k < 4; ++k) players_.emplace_back(k + 1, k < 2 ? "main" : k == 2 ? "tank" : "");
    for (std::size_t k = 0; k < kFixedRooms.size(); ++k)
      ledger_.setRoom(kFixedRooms[k], RoomFact::State::kOpen, kKillScenes[k]);
  }

  void TearDown() override {
    if (totals_.kill_count > 0) printSummary(seconds(Clock::now() - begin_));
    const char* const keep = std::getenv("SPINDRIFT_KILL_KEEP");
    if (keep != nullptr && HasFailure()) fs::copy(folder().path(), keep, fs::copy_options::recursive);
  }

  [[nodiscard]] fs::path stateFolder() const { return folder().path() / "state"; }
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
  std::chrono::milliseconds after(int low_ms, int high_ms) {
    return std::chrono::milliseconds(std::uniform_int_distribution(low_ms, high_ms)(random_));
  }

  std::vector<std::string> kept() {
    static const char* const kSync[] = {"never", "snapshots", "always"};
    static const char* const kInterval[] = {"0.7", "10"};
    return arguments({"--scene", pool_, "--room", "tank=" + tank_, "--room", "sea=" + sea_,      //
                      "--state-dir", stateFolder(), "--grace-s", "600", "--address-share", "1",  //
                      "--sync", kSync[below(3)], "--snapshot-every-s", kInterval[below(2)]});
  }
  /// False without a usable device.
  bool startKept() {
    const auto begin = Clock::now();
    if (!start(SPINDRIFT_PROGRAM, kept())) return false;
    totals_.longest_start_s = std::max(totals_.longest_start_s, seconds(Clock::now() - begin));
    return true;
  }

  void playUntilKilled() {
    std::atomic<bool> is_over = false;
    {
      std::vector<std::jthread> threads;
      for (Player& player : players_)
        threads.emplace_back([&, random = std::mt19937(random_())] { player.play(port_, ledger_, random, is_over); });
      threads.emplace_back(
          [&, random = std::mt19937(random_())] { openAndCloseRooms(port_, kOtherRooms, ledger_, random, is_over); });
      std::this_thread::sleep_for(after(100, 2500));
      kill();
      is_over = true;
    }
    ++totals_.kill_count;
  }
  void kill() {
    child_->signal(SIGKILL);
    EXPECT_EQ(child_->wait(), 128 + SIGKILL) << child_->err();
  }

  /// Checks what the killed server has left behind, and notes what a restarted one must have.
  void checkFiles() {
    const fs::path newest = copyOf(stateFolder(), "newest");
    const fs::path older = copyOf(stateFolder(), "older");
    removeNewestSnapshots(older);
    auto newest_store = history::StateStore::open({.folder = newest});
    auto older_store = history::StateStore::open({.folder = older});
    ASSERT_TRUE(newest_store && older_store);
    const auto names = (*newest_store)->rooms();
    ASSERT_TRUE(names);
    for (const auto& [name, fact] : ledger_.rooms()) {
      if (fact.state == RoomFact::State::kUnknown || neverOpened(name)) continue;
      EXPECT_EQ(std::ranges::count(*names, name), fact.state == RoomFact::State::kOpen ? 1 : 0) << name;
    }
    expected_.clear();
    for (const std::string& name : *names) {
      SCOPED_TRACE("room " + name);
      if (neverOpened(name)) continue;
      checkCommands(**older_store, name);
      const auto restored = restoredTwice(**newest_store, **older_store, name, device_);
      if (!restored) continue;
      ++totals_.hash_count;
      expected_[name] = *restored;
      last_generation_[name] = lastGeneration(stateFolder(), name);
    }
  }

  /// A room whose opening was not answered before the kill leaves a log without a snapshot.
  [[nodiscard]] bool neverOpened(const std::string& room) const {
    return ledger_.rooms()[room].state != RoomFact::State::kOpen && snapshotNumbers(stateFolder(), room).empty();
  }

  void checkCommands(history::StateStore& store, const std::string& room) {
    const RoomFact fact = ledger_.rooms()[room];
    auto place = store.place(room);
    ASSERT_TRUE(place) << place.error().message;
    // Of a room whose closing was not answered nothing may be there.
    if (fact.state == RoomFact::State::kUnknown && !place->kept) return;
    ASSERT_TRUE(place->kept);
    const KeptCommands found = findAll(ledger_.commands(), room, fact.opening, *place->kept);
    EXPECT_THAT(found.lost, testing::IsEmpty());
    totals_.in_log_count += found.in_log_count;
    totals_.before_snapshot_count += found.before_snapshot_count;
    checked_count_ += found.checkedCount();
    totals_.record_count += place->kept->records.size();
  }

  void countCommands() {
    std::size_t acknowledged = 0;
    for (const SentCommand& sent : ledger_.commands())
      acknowledged += sent.state == SentCommand::State::kAcknowledged ? 1 : 0;
    totals_.acknowledged_count += acknowledged;
    totals_.closed_count += acknowledged - std::exchange(checked_count_, 0);
  }

  /// Checks that the restarted server has what the files promise.
  void checkRestart() {
    for (const auto& [name, state] : expected_) {
      SCOPED_TRACE("room " + name);
      // The first snapshot of the new program; a slow machine may have replaced it already.
      for (const std::uint64_t number : snapshotNumbers(stateFolder(), name)) {
        if (number != last_generation_[name] + 1) continue;
        const auto written = readSnapshot(stateFolder(), name, number);
        if (!written) continue;
        EXPECT_THAT(differences(state, *written), testing::IsEmpty()) << "between this process and the program";
        ++totals_.program_hash_count;
      }
    }
    const HttpAnswer list = httpRequest(port_, "GET", "/api/v1/rooms");
    ASSERT_EQ(list.status, 200U);
    std::map<std::string, std::string> scenes;
    const boost::json::value parsed = boost::json::parse(list.body);
    for (const auto& room : parsed.at("rooms").as_array())
      scenes[std::string(room.at("name").as_string())] = std::string(room.at("scene").as_string());
    for (const auto& [name, fact] : ledger_.rooms()) {
      const bool is_there = scenes.contains(name);
      if (!expected_.empty()) {
        EXPECT_EQ(is_there, expected_.contains(name)) << name;
      }
      if (fact.state == RoomFact::State::kUnknown) {
        // Without an answer both are right. What there is now counts from here on.
        ledger_.setRoom(name, is_there ? RoomFact::State::kOpen : RoomFact::State::kClosed,
                        is_there && fact.opening == 0 ? scenes[name] : "");
        continue;
      }
      EXPECT_EQ(is_there, fact.state == RoomFact::State::kOpen) << name;
      if (is_there && !expected_.empty()) {
        EXPECT_EQ(scenes[name], expected_[name].scene().name()) << name;
      }
    }
  }

  /// Connects the players again and checks who they are and what they own. Begins a new round.
  void checkPeople() {
    std::vector<Belongings> promises;
    for (const Player& player : players_) promises.push_back(player.promised(ledger_));
    ledger_.beginRound();
    const auto rooms = ledger_.rooms();
    for (std::size_t k = 0; k < players_.size(); ++k) {
      Player& player = players_[k];
      SCOPED_TRACE(fmt::format("player {} in room {}", k + 1, player.room()));
      const auto fact = rooms.find(player.room());
      const bool is_gone = fact == rooms.end() || fact->second.state != RoomFact::State::kOpen ||
                           fact->second.opening != player.opening();
      if (is_gone && player.room() != "main" && player.room() != "tank") continue;
      const Belongings found = player.comeBack(port_, ledger_);
      ASSERT_NE(found.person_id, 0u);
      if (promises[k].person_id == 0 || is_gone) continue;
      expectKept(player, promises[k], found);
      for (const v1::KeptPerson& kept : expected_[player.room()].people().people()) {
        if (kept.person_id() != found.person_id) continue;
        EXPECT_THAT(found.boats, testing::ElementsAreArray(kept.boat_ids())) << "boats as they were kept";
      }
      ++totals_.resumed_count;
      totals_.boat_count += promises[k].boats.size();
    }
  }

  /// A server that is killed before it is ready changes nothing.
  void killAtStart() {
    child_ = std::make_unique<ChildProcess>(SPINDRIFT_PROGRAM, kept());
    std::this_thread::sleep_for(after(20, 800));
    kill();
    ++totals_.start_kill_count;
  }

  void printSummary(double run_s) const {
    std::printf(
        "%zu kills under load and %zu while starting in %.0f s: of %zu acknowledged commands %zu were found in the "
        "logs, %zu are older than the kept snapshots, %zu belonged to closed rooms; %zu rooms restored twice and %zu "
        "compared with the restarted program, equal bit for bit, with %zu records carried out again; %zu people "
        "resumed with %zu boats; longest start %.2f s\n",
        totals_.kill_count, totals_.start_kill_count, run_s, totals_.acknowledged_count, totals_.in_log_count,
        totals_.before_snapshot_count, totals_.closed_count, totals_.hash_count, totals_.program_hash_count,
        totals_.record_count, totals_.resumed_count, totals_.boat_count, totals_.longest_start_s);
  }

  gpu::DeviceChoice device_;
  std::string pool_;
  std::string tank_;
  std::string sea_;
  std::mt19937 random_;
  Ledger ledger_;
  std::vector<Player> players_;
  std::map<std::string, v1::KeptState> expected_;
  std::map<std::string, std::uint64_t> last_generation_;
  std::size_t checked_count_ = 0;
  Totals totals_;
  const Clock::time_point begin_ = Clock::now();
};

TEST_F(StateKill, RestartLosesNothingAcknowledged) {
  const std::uint64_t rounds = variableOr("SPINDRIFT_KILLS", kKillCount);
  if (!startKept()) GTEST_SKIP() << "no device";
  for (std::uint64_t round = 1; round <= rounds; ++round) {
    SCOPED_TRACE(fmt::format("round {}", round));
    ASSERT_NO_FATAL_FAILURE(checkRestart());
    ASSERT_NO_FATAL_FAILURE(checkPeople());
    playUntilKilled();
    ASSERT_NO_FATAL_FAILURE(checkFiles());
    countCommands();
    if (HasFailure()) break;
    if (below(6) == 0) killAtStart();
    ASSERT_TRUE(startKept());
  }
  if (HasFailure()) return;
  ASSERT_NO_FATAL_FAILURE(checkRestart());
  ASSERT_NO_FATAL_FAILURE(checkPeople());

  stop();
  ASSERT_TRUE(startKept());
  stop();
  for (const auto& [name, state] : expected_) {
    EXPECT_THAT(child_->err(), testing::ContainsRegex("room " + name +
                                                      ": continues at tick [0-9]+ of scene [a-z_]+, 0 ticks and 0 "
                                                      "records after its snapshot"));
  }
}

}  // namespace
}  // namespace spindrift::test
