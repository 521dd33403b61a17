#include <array>
#include <csignal>

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <spindrift/state/folders.h>

#include "temporary_folder.h"

namespace spindrift::state {
namespace {

using testing::HasSubstr;

TEST(FolderLock, IsTakenOnceAtATime) {
  const test::TemporaryFolder folder;
  const auto place = folder.path() / "state";
  {
    const auto lock = lockFolder(place);
    ASSERT_TRUE(lock) << lock.error().message;
    const auto second = lockFolder(place);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, core::ErrorCode::kUnavailable);
    EXPECT_THAT(second.error().message, HasSubstr(place.string()));
    EXPECT_THAT(second.error().message, HasSubstr("process " + std::to_string(::getpid()) + ":"));
  }
  EXPECT_TRUE(lockFolder(place));
}

TEST(FolderLock, MovesWithItsObject) {
  const test::TemporaryFolder folder;
  FolderLock kept;
  {
    auto lock = lockFolder(folder.path());
    ASSERT_TRUE(lock);
    kept = std::move(*lock);
  }
  EXPECT_FALSE(lockFolder(folder.path()));
  kept.reset();
  EXPECT_TRUE(lockFolder(folder.path()));
}

TEST(FolderLock, EndsWithAKilledProcess) {
  const test::TemporaryFolder folder;
  std::array<int, 2> taken{};
  ASSERT_EQ(::pipe(taken.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const auto lock = lockFolder(folder.path());
    const char answer = lock ? 'y' : 'n';
    if (::write(taken[1], &answer, 1) == 1) ::pause();
    ::_exit(1);
  }
  char answer = 0;
  ASSERT_EQ(::read(taken[0], &answer, 1), 1);
  EXPECT_EQ(answer, 'y');
  EXPECT_THAT(lockFolder(folder.path()).error().message, HasSubstr("process " + std::to_string(child) + ":"));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(lockFolder(folder.path()));
  ::close(taken[0]);
  ::close(taken[1]);
}

TEST(FolderLock, AFolderThatCannotBeUsedIsNamed) {
  const test::TemporaryFolder folder;
  folder.write("file", "");
  EXPECT_THAT(lockFolder(folder.path() / "file").error().message, HasSubstr("file"));
}

}  // namespace
}  // namespace spindrift::state
