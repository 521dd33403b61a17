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

  std::unique_ptr<ChildProcess> launch() {
    static const char* const kSync[] = {"never", "snapshots", "always"};
    static const char* const kInterval[] = {"0.7", "10"};
    return std::make_unique<ChildProcess>(SPINDRIFT_PROGRAM, std::vector<std::string>{"serve",
                                                                                      "--device",
                                                                                      "software",
                                                                                      "--port",
                                                                                      "0",
                                                                                      "--scene",
                                                                                      pool_,
                                                                                      "--room",
                                                                                      "tank=" + tank_,
                                                                                      "--room",
                                                                                      "sea=" + sea_,
                                                                                      "--state-dir",
                                                                                      stateFolder(),
                                                                                      "--grace-s",
                                                                                      "600",
                                                                                      "--sync",
                                                                                      kSync[below(3)],
                                                                                      "--snapshot-every-s",
                                                                                      kInterval[below(2)],
                                                                                      "--address-share",
                                                                                      "1"});
  }

  /// False without a usable device.
  bool start() {
    const auto begin = Clock::now();
    child_ = launch();
    const auto line = child_->waitForLine("Spindrift is ready: http://127.0.0.1:");
    if (!line) {
      const auto exit_code = child_->wait();
      EXPECT_EQ(exit_code, 3) << "the server did not come up: " << child_->err();
      return false;
    }
    port_ = static_cast<std::uint16_t>(std::stoul(line->substr(line->rfind(':') + 1)));
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

  fs::path copyOfState(const std::string& name) {
    fs::path copy = folder().path() / name;
    fs::remove_all(copy);
    fs::copy(stateFolder(), copy, fs::copy_options::recursive);
    return copy;
  }

  /// Checks what the killed server has left behind, and notes what a restarted one must have.
  void checkFiles() {
    const fs::path newest = copyOfState("newest");
    const fs::path older = copyOfState("older");
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
      const auto from_newest = restoredRoom(**newest_store, name, device_);
      const auto from_older =
          restoredRoom(**older_store, name, device_, from_newest && *from_newest ? (*from_newest)->tick() : 0);
      ASSERT_TRUE(from_newest && from_older)
          << "from the newest snapshot: " << (from_newest ? "restored" : from_newest.error().message)
          << "\nfrom the older one: " << (from_older ? "restored" : from_older.error().message);
      EXPECT_EQ(from_newest->has_value(), from_older->has_value());
      if (!*from_newest || !*from_older) {
        ADD_FAILURE() << "its files cannot be used";
        continue;
      }
      EXPECT_THAT(differences(**from_newest, **from_older), testing::IsEmpty());
      ++totals_.hash_count;
      expected_[name] = **from_newest;
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
    struct Promise {
      std::uint32_t person_id;
      std::set<std::uint32_t> boats;
    };
    std::vector<Promise> promises;
    for (const Player& player : players_)
      promises.push_back(
          {player.promisedPersonId(), ledger_.sureBoats(player.room(), player.opening(), player.promisedPersonId())});
    ledger_.beginRound();
    const auto rooms = ledger_.rooms();
    for (std::size_t k = 0; k < players_.size(); ++k) {
      Player& player = players_[k];
      SCOPED_TRACE(fmt::format("player {} in room {}", k + 1, player.room()));
      const auto fact = rooms.find(player.room());
      const bool is_gone = fact == rooms.end() || fact->second.state != RoomFact::State::kOpen ||
                           fact->second.opening != player.opening();
      if (is_gone && player.room() != "main" && player.room() != "tank") continue;
      ASSERT_TRUE(player.connect(port_, ledger_));
      const v1::Welcome welcome = player.client().welcome();
      const auto people = player.client().waitFor([&](const v1::ServerMessage& message) {
        return message.has_people() && std::ranges::any_of(message.people().people(), [&](const v1::Person& person) {
                 return person.person_id() == welcome.person_id();
               });
      });
      ASSERT_TRUE(people);
      std::set<std::uint32_t> boats;
      for (const v1::Person& person : people->people().people())
        if (person.person_id() == welcome.person_id()) boats.insert(person.boat_ids().begin(), person.boat_ids().end());
      for (const std::uint32_t boat_id : boats)
        ledger_.claim({player.room(), player.opening(), welcome.person_id(), boat_id, 0});
      if (promises[k].person_id == 0 || is_gone) continue;
      EXPECT_TRUE(welcome.resumed());
      EXPECT_EQ(welcome.person_id(), promises[k].person_id);
      for (const std::uint32_t boat_id : promises[k].boats) EXPECT_TRUE(boats.contains(boat_id)) << "boat " << boat_id;
      for (const v1::KeptPerson& kept : expected_[player.room()].people().people()) {
        if (kept.person_id() != welcome.person_id()) continue;
        EXPECT_THAT(boats, testing::ElementsAreArray(kept.boat_ids())) << "boats as they were kept";
      }
      ++totals_.resumed_count;
      totals_.boat_count += promises[k].boats.size();
    }
  }

  /// A server that is killed before it is ready changes nothing.
  void killAtStart() {
    child_ = launch();
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
  std::unique_ptr<ChildProcess> child_;
  std::uint16_t port_ = 0;
  std::map<std::string, v1::KeptState> expected_;
  std::map<std::string, std::uint64_t> last_generation_;
  std::size_t checked_count_ = 0;
  Totals totals_;
  const Clock::time_point begin_ = Clock::now();
};

TEST_F(StateKill, RestartLosesNothingAcknowledged) {
  const std::uint64_t rounds = variableOr("SPINDRIFT_KILLS", kKillCount);
  if (!start()) GTEST_SKIP() << "no device";
  for (std::uint64_t round = 1; round <= rounds; ++round) {
    SCOPED_TRACE(fmt::format("round {}", round));
    ASSERT_NO_FATAL_FAILURE(checkRestart());
    ASSERT_NO_FATAL_FAILURE(checkPeople());
    playUntilKilled();
    ASSERT_NO_FATAL_FAILURE(checkFiles());
    countCommands();
    if (HasFailure()) break;
    if (below(6) == 0) killAtStart();
    ASSERT_TRUE(start());
  }
  if (HasFailure()) return;
  ASSERT_NO_FATAL_FAILURE(checkRestart());
  ASSERT_NO_FATAL_FAILURE(checkPeople());

  child_->signal(SIGTERM);
  EXPECT_EQ(child_->wait(), 0) << child_->err();
  ASSERT_TRUE(start());
  child_->signal(SIGTERM);
  EXPECT_EQ(child_->wait(), 0) << child_->err();
  for (const auto& [name, state] : expected_) {
    EXPECT_THAT(child_->err(), testing::ContainsRegex("room " + name +
                                                      ": continues at tick [0-9]+ of scene [a-z_]+, 0 ticks and 0 "
                                                      "records after its snapshot"));
  }
}

}  // namespace
}  // namespace spindrift::test
