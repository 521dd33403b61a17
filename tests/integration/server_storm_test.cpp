// Hostile clients of every role beside other clients, which keep their connections, frames and answers.
// SPINDRIFT_STORM_SECONDS makes the run long, with another seed each time (or that of SPINDRIFT_STORM_SEED), and then
// checks the times that a quiet machine with two cores keeps.
#include <cstdlib>
#include <ctime>

#include <fmt/format.h>

#include "server_fixture.h"
#include "storm.h"

namespace spindrift::test {
namespace {

const char* longStorm_s() {
  return std::getenv("SPINDRIFT_STORM_SECONDS");
}

class Storm : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kHarborLike}, {"other", kStillWave}}; }
  water::SceneCatalog scenes() const override { return water::SceneCatalog(SPINDRIFT_SOURCE_DIR "/server/scenes"); }

  static constexpr const char* kHarborLike = R"(
    wave { resolution_count: 128 side_m: 24 depth_m: 1.5 }
    particles { count: 4096 layers_count: 2 headroom_m: 2 }
    coupling {}
    foam {}
    boats { capacity_count: 8 boats { x_m: 3 z_m: 0 } }
    stream { frame_rate_hz: 30 }
  )";

  StormOptions options(std::vector<Attacker> attackers, double seconds) {
    StormOptions out;
    out.port = server().port();
    out.rooms = {"main", "other"};
    out.attackers = std::move(attackers);
    out.duration = std::chrono::duration<double>(longStorm_s() ? std::atof(longStorm_s()) : seconds);
    return out;
  }

  static void expectNobodyElseNoticed(const std::string& name, const StormReport& storm) {
    const auto quantile = [&](double ratio) {
      return storm.answers_s.empty()
                 ? 0.0
                 : storm.answers_s[static_cast<std::size_t>(ratio * static_cast<double>(storm.answers_s.size() - 1))];
    };
    fmt::print(
        "{}: {} messages, {} attackers' connections closed; bystanders: {} lost, at least {} frames, longest gap "
        "{:.3f} s, {} answers, median {:.3f} s, p99 {:.3f} s, longest {:.3f} s\n",
        name, storm.attack_count, storm.attackers_closed_count, storm.lost_count, storm.fewest_frames,
        storm.longest_gap_s, storm.answers_s.size(), quantile(0.5), quantile(0.99), quantile(1.0));
    EXPECT_EQ(storm.lost_count, 0u) << storm.first_loss;
    EXPECT_EQ(storm.unanswered_count, 0u);
    EXPECT_GT(storm.fewest_frames, 0u);
    EXPECT_FALSE(storm.answers_s.empty());
    if (!longStorm_s()) return;  // no bounds on time for a loaded machine
    EXPECT_LE(storm.longest_gap_s, 0.5);
    EXPECT_LE(quantile(0.99), 0.3);
  }
};

TEST_F(Storm, BurstsOfStateCloseNoSession) {
  const auto storm = runStorm(options({{Attack::kSpeedBursts}, {Attack::kSpeedBursts}, {Attack::kBoats}}, 4.0));
  expectNobodyElseNoticed("bursts", storm);
}

TEST_F(Storm, ResetsDoNotDisturbBystanders) {
  const auto storm = runStorm(options({{Attack::kResets}, {Attack::kResets}}, 3.0));
  expectNobodyElseNoticed("resets", storm);
}

TEST_F(Storm, ScenesAreBuiltBesideTheWater) {
  const auto storm = runStorm(options({{Attack::kScenes}, {Attack::kScenes}}, 4.0));
  expectNobodyElseNoticed("scenes", storm);
}

TEST_F(Storm, ParametersDoNotDisturbOtherClients) {
  const auto storm = runStorm(options({{Attack::kParameters}, {Attack::kParticleCount}}, 4.0));
  expectNobodyElseNoticed("parameters", storm);
}

class StormOfEveryRole : public Storm {
 protected:
  static constexpr const char* kViewer = "token-of-some-viewer";
  static constexpr const char* kPlayer = "token-of-some-player";
  static constexpr const char* kOperator = "token-of-some-operator";

  void adjust(service::WaterServerOptions& options) const override {
    auto access = access::Access::parse(fmt::format("viewer {}\nplayer {}\noperator {}\n", kViewer, kPlayer, kOperator),
                                        "tokens", core::Role::kViewer);
    ASSERT_TRUE(access) << access.error().message;
    options.access.access = *access;
  }
};

TEST_F(StormOfEveryRole, BystandersKeepFramesAndAnswers) {
  std::vector<Attacker> attackers;
  for (const char* token : {"", kViewer, kPlayer, kOperator, kOperator})
    attackers.push_back({Attack::kEverything, token});
  for (const Attack attack : {Attack::kSpeedBursts, Attack::kResets, Attack::kScenes, Attack::kParameters,
                              Attack::kBoats, Attack::kConnections, Attack::kBytes})
    attackers.push_back({attack, kOperator});
  auto chosen = options(std::move(attackers), 6.0);
  chosen.bystander_token = kPlayer;
  const char* const seed = std::getenv("SPINDRIFT_STORM_SEED");
  chosen.seed = seed            ? static_cast<std::uint32_t>(std::atoll(seed))
                : longStorm_s() ? static_cast<std::uint32_t>(std::time(nullptr))
                                : 1;
  fmt::print("seed {}\n", chosen.seed);
  expectNobodyElseNoticed("everything", runStorm(chosen));
}

}  // namespace
}  // namespace spindrift::test
