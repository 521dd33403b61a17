#include <map>
#include <thread>

#include <gmock/gmock.h>

#include <spindrift/rooms/command_queue.h>

#include "commands.h"

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
using test::changeScene;
using test::reset;
using test::setParameter;
using test::splash;
using testing::ElementsAre;

CommandQueue::TimePoint at(std::chrono::milliseconds ms) {
  return CommandQueue::TimePoint{} + 1h + ms;
}

Command from(std::uint64_t session_id, std::uint64_t command_id, v1::Command message) {
  return {.sender = {.session_id = session_id}, .message = test::numbered(command_id, std::move(message))};
}

class CommandQueueTest : public testing::Test {
 protected:
  void push(CommandQueue& queue, Command command, std::chrono::milliseconds ms = 0ms) {
    const auto full = queue.tryPush(std::move(command), at(ms));
    ASSERT_FALSE(full) << *full;
  }
  /// The command ids of the next batch; empty without a batch.
  static std::vector<std::uint64_t> next(CommandQueue& queue, const CommandQueue::Allowed& allowed = {}) {
    return idsOf(queue.next(allowed).value_or(CommandQueue::Batch{}));
  }
  static std::vector<std::uint64_t> idsOf(const CommandQueue::Batch& batch) {
    std::vector<std::uint64_t> out;
    for (const Command& command : batch) out.push_back(command.id());
    return out;
  }

  CommandQueue queue_;
};

TEST(CommandTraits, EveryCommandOfTheWireHasItsOwn) {
  const google::protobuf::OneofDescriptor& actions = *v1::Command::descriptor()->FindOneofByName("action");
  for (int i = 0; i < actions.field_count(); ++i) {
    v1::Command command;
    (void)v1::Command::GetReflection()->MutableMessage(&command, actions.field(i));
    const auto& name = actions.field(i)->name();
    const bool is_play = name.find("boat") != std::string::npos || name.find("floater") != std::string::npos ||
                         name.find("gauge") != std::string::npos || name == "splash" || name == "breaking_wave" ||
                         name == "stroke" || name == "step" || name.find("clock") != std::string::npos;
    const core::Role expected = name == "query" ? core::Role::kViewer
                                : is_play       ? core::Role::kPlayer
                                                : core::Role::kOperator;
    EXPECT_EQ(traitsOf(command).role, expected) << name;
  }
  EXPECT_TRUE(traitsOf(reset()).is_heavy);
  EXPECT_FALSE(traitsOf(splash()).is_heavy);
}

TEST(CommandTraits, ToRemoveAllFloatersTakesAnOperator) {
  EXPECT_EQ(roleFor(test::removeFloater(3)), core::Role::kPlayer);
  EXPECT_EQ(roleFor(test::removeFloaters()), core::Role::kOperator);
  EXPECT_EQ(roleFor(test::holdFloater(0, 0, 0)), core::Role::kPlayer);
}

TEST_F(CommandQueueTest, LanesTakeTurnsAndKeepTheirOrder) {
  for (std::uint64_t k = 1; k <= 3; ++k) push(queue_, from(1, k, splash()));
  push(queue_, from(2, 21, splash()));
  EXPECT_THAT(next(queue_), ElementsAre(1));
  EXPECT_THAT(next(queue_), ElementsAre(21)) << "a sender does not wait behind commands of another";
  EXPECT_THAT(next(queue_), ElementsAre(2));
  EXPECT_THAT(next(queue_), ElementsAre(3));
  EXPECT_THAT(next(queue_), ElementsAre());
  EXPECT_EQ(queue_.size(), 0u);
}

TEST_F(CommandQueueTest, LightCommandsOfOthersContinueWithoutBudget) {
  push(queue_, from(1, 1, reset()));
  push(queue_, from(1, 2, splash()));
  push(queue_, from(2, 21, splash()));
  EXPECT_THAT(next(queue_, {.heavy = false}), ElementsAre(21));
  EXPECT_THAT(next(queue_, {.heavy = false}), ElementsAre()) << "2 was sent after the reset and stays after it";
  EXPECT_THAT(next(queue_), ElementsAre(1));
  EXPECT_THAT(next(queue_), ElementsAre(2));
}

TEST_F(CommandQueueTest, EqualResetsOfAnySendersAreCarriedOutOnce) {
  for (std::uint64_t k = 1; k <= 50; ++k) push(queue_, from(1, k, reset()));
  push(queue_, from(2, 100, splash()));
  push(queue_, from(2, 101, reset()));
  push(queue_, from(3, 102, reset()));
  const auto batch = queue_.next({});
  ASSERT_TRUE(batch);
  EXPECT_EQ(batch->size(), 51u) << "all but 101, which has a splash before it";
  EXPECT_THAT(next(queue_), ElementsAre(100));
  EXPECT_THAT(next(queue_), ElementsAre(101));
}

TEST_F(CommandQueueTest, SuccessiveValuesForOneParameterAreReturnedTogether) {
  push(queue_, from(1, 1, setParameter("wave.depth_m", 1)));
  push(queue_, from(1, 2, setParameter("wave.depth_m", 2)));
  push(queue_, from(1, 3, setParameter("wave.damping_per_s", 0.1)));
  push(queue_, from(1, 4, setParameter("wave.depth_m", 3)));
  EXPECT_THAT(next(queue_), ElementsAre(1, 2));
  EXPECT_THAT(next(queue_), ElementsAre(3));
  EXPECT_THAT(next(queue_), ElementsAre(4));
}

TEST_F(CommandQueueTest, ValuesAreReturnedOneByOneIfTheyMayNotBeJoined) {
  push(queue_, from(1, 1, setParameter("wave.depth_m", 1)));
  push(queue_, from(1, 2, setParameter("wave.depth_m", 2)));
  EXPECT_TRUE(queue_.isBusyWith({.session_id = 1}));
  EXPECT_FALSE(queue_.isBusyWith({.session_id = 2}));
  EXPECT_THAT(next(queue_, {.joined_values = false}), ElementsAre(1));
  EXPECT_THAT(next(queue_, {.joined_values = false}), ElementsAre(2));
  EXPECT_FALSE(queue_.isBusyWith({.session_id = 1}));
}

TEST_F(CommandQueueTest, SceneChangesWaitForTheOneUnderWay) {
  push(queue_, from(1, 1, changeScene("pond")));
  push(queue_, from(1, 2, splash()));
  const auto under_way = queue_.next({});
  ASSERT_TRUE(under_way);
  queue_.hold(*under_way);
  push(queue_, from(2, 21, changeScene("sea")));
  push(queue_, from(3, 31, changeScene("pond")));
  push(queue_, from(4, 41, splash()));
  EXPECT_THAT(next(queue_, {.scene_change = false}), ElementsAre(41));
  EXPECT_THAT(next(queue_, {.scene_change = false}), ElementsAre()) << "2 was sent for the new scene";
  EXPECT_THAT(idsOf(queue_.takeEqual(changeScene("pond"))), ElementsAre(31));
  queue_.release(*under_way);
  EXPECT_THAT(next(queue_, {.scene_change = false}), ElementsAre(2));
  EXPECT_THAT(next(queue_), ElementsAre(21));
}

TEST_F(CommandQueueTest, RefusesBeyondEachBoundAndSaysWhich) {
  CommandQueue queue({.max_count = 5, .lane_max_count = 3, .lane_heavy_max_count = 2});
  push(queue, from(1, 1, reset()));
  push(queue, from(1, 2, reset()));
  const auto heavy = queue.tryPush(from(1, 3, reset()), at(0ms));
  ASSERT_TRUE(heavy);
  EXPECT_THAT(*heavy, testing::HasSubstr("your limit of 2 waiting resets"));
  push(queue, from(1, 4, splash()));
  const auto lane = queue.tryPush(from(1, 5, splash()), at(0ms));
  ASSERT_TRUE(lane);
  EXPECT_THAT(*lane, testing::HasSubstr("your limit of 3 waiting commands"));
  push(queue, from(2, 6, splash()));
  push(queue, from(3, 7, splash()));
  const auto all = queue.tryPush(from(4, 8, splash()), at(0ms));
  ASSERT_TRUE(all);
  EXPECT_THAT(*all, testing::HasSubstr("full (5 commands)"));
}

TEST_F(CommandQueueTest, HeavyCommandsThatWaitTooLongAreDropped) {
  push(queue_, from(1, 1, reset()), 0ms);
  push(queue_, from(1, 2, splash()), 0ms);
  push(queue_, from(2, 21, reset()), 900ms);
  EXPECT_THAT(idsOf(queue_.takeExpired(at(1000ms))), ElementsAre());
  EXPECT_THAT(idsOf(queue_.takeExpired(at(1001ms))), ElementsAre(1));
  EXPECT_THAT(next(queue_, {.heavy = false}), ElementsAre(2));
}

TEST_F(CommandQueueTest, DrainTakesEverything) {
  push(queue_, from(1, 1, reset()));
  push(queue_, from(2, 2, splash()));
  EXPECT_EQ(queue_.drain().size(), 2u);
  EXPECT_EQ(queue_.size(), 0u);
  push(queue_, from(1, 3, splash()));
  EXPECT_THAT(next(queue_), ElementsAre(3));
}

TEST_F(CommandQueueTest, ReturnsEveryCommandOnceWithManyProducers) {
  constexpr std::uint64_t kProducers = 4;
  constexpr std::uint64_t kCommands = 2000;
  std::vector<std::jthread> producers;
  for (std::uint64_t session = 1; session <= kProducers; ++session) {
    producers.emplace_back([this, session] {
      for (std::uint64_t k = 1; k <= kCommands; ++k) {
        while (queue_.tryPush(from(session, k, splash()), at(0ms))) std::this_thread::yield();  // full
      }
    });
  }
  std::map<std::uint64_t, std::uint64_t> last_id;
  for (std::uint64_t taken = 0; taken < kProducers * kCommands;) {
    const auto batch = queue_.next({});
    if (!batch) continue;
    for (const Command& command : *batch) {
      ASSERT_EQ(command.id(), ++last_id[command.sender.session_id]) << "in order, each once";
      ++taken;
    }
  }
  EXPECT_EQ(queue_.size(), 0u);
}

}  // namespace
}  // namespace spindrift::rooms
