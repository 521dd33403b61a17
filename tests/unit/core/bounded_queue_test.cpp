#include <atomic>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include <spindrift/core/bounded_queue.h>

namespace spindrift::core {
namespace {

TEST(BoundedQueue, KeepsArrivalOrder) {
  BoundedQueue<int> queue(3);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(queue.tryPush(int{i}));
  EXPECT_EQ(queue.drain(), (std::vector{0, 1, 2}));
  EXPECT_EQ(queue.size(), 0u);
}

TEST(BoundedQueue, RefusesWhenFullAndLeavesTheValueAlone) {
  BoundedQueue<std::unique_ptr<int>> queue(1);
  ASSERT_TRUE(queue.tryPush(std::make_unique<int>(1)));
  auto kept = std::make_unique<int>(2);
  EXPECT_FALSE(queue.tryPush(std::move(kept)));
  ASSERT_TRUE(kept);  // NOLINT: refused values are not moved from
  EXPECT_EQ(*kept, 2);
  (void)queue.drain();
  EXPECT_TRUE(queue.tryPush(std::move(kept)));
}

TEST(BoundedQueue, LosesAndInventsNothingWithManyProducers) {
  BoundedQueue<int> queue(64);
  std::atomic<int> accepted{0};
  std::vector<std::thread> producers;
  for (int p = 0; p < 4; ++p) {
    producers.emplace_back([&] {
      for (int i = 0; i < 5000; ++i) accepted += queue.tryPush(int{i}) ? 1 : 0;
    });
  }
  std::size_t received = 0;
  std::atomic<bool> done{false};
  std::thread joiner([&] {
    for (auto& producer : producers) producer.join();
    done = true;
  });
  while (!done) {
    EXPECT_LE(queue.size(), queue.capacity());
    received += queue.drain().size();
  }
  joiner.join();
  received += queue.drain().size();
  EXPECT_EQ(received, static_cast<std::size_t>(accepted));
}

}  // namespace
}  // namespace spindrift::core
