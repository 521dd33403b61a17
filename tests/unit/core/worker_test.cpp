#include <future>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <spindrift/core/worker.h>

namespace spindrift::core {
namespace {

int nicenessOf(Worker& worker) {
  std::promise<int> found;
  worker.push([&found](bool) { found.set_value(getpriority(PRIO_PROCESS, 0)); });
  return found.get_future().get();
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
  {
    Worker worker(0);
    std::promise<void> begun;
    std::promise<void> release;
    worker.push([&](bool runs) {
      begun.set_value();
      release.get_future().wait();
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
