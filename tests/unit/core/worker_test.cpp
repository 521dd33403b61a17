#include <future>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <spindrift/core/worker.h>

namespace spindrift::core {
namespace {

int nicenessOf(Worker& worker) {
  const auto found = std::make_shared<std::promise<int>>();
  worker.push([found](bool) { found->set_value(getpriority(PRIO_PROCESS, 0)); });
  return found->get_future().get();
}

TEST(Worker, RunsPiecesAtThePriorityThatHoldsWhenTheyBegin) {
  const int own = getpriority(PRIO_PROCESS, 0);
  Worker worker(0);
  EXPECT_EQ(nicenessOf(worker), own);
  worker.setNiceness(19);
  EXPECT_EQ(nicenessOf(worker), 19);
  EXPECT_EQ(getpriority(PRIO_PROCESS, 0), own) << "the other threads keep theirs";
}

TEST(Worker, CallsWaitingPiecesWithoutRunningThemWhenItEnds) {
  std::vector<bool> ran;
  std::promise<void> begun;
  std::promise<void> release;
  {
    Worker worker(0);
    worker.push([&, released = release.get_future().share()](bool runs) {
      begun.set_value();
      released.wait();
      ran.push_back(runs);
    });
    worker.push([&](bool runs) { ran.push_back(runs); });
    begun.get_future().wait();
    worker.end();
    release.set_value();
  }
  EXPECT_EQ(ran, (std::vector<bool>{true, false}));
}

}  // namespace
}  // namespace spindrift::core
