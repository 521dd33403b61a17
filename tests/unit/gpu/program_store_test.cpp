// Compiled programs on disk: what is kept, what is not used, and how much.
#include "program_store.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "log_capture.h"
#include "temporary_folder.h"

namespace spindrift::gpu {
namespace {

using test::LogCapture;
using testing::HasSubstr;
namespace fs = std::filesystem;

ProgramStore::Binary binaryOf(char value, std::size_t size_bytes) {
  return {.format = 7, .bytes = std::vector<std::byte>(size_bytes, static_cast<std::byte>(value))};
}

class ProgramStoreTest : public testing::Test {
 protected:
  void SetUp() override { store_.save("key", binaryOf('a', 1000)); }

  [[nodiscard]] std::string content() const {
    std::ifstream file(store_.fileOf("key"), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Writes another content; the program must not be used, for this reason, and saving it must replace the file.
  void expectRefused(const std::string& bytes, const std::string& reason) {
    std::ofstream(store_.fileOf("key"), std::ios::binary | std::ios::trunc) << bytes;
    const LogCapture log;
    EXPECT_FALSE(store_.load("key"));
    EXPECT_THAT(log.text(), HasSubstr(reason));
    store_.save("key", binaryOf('b', 10));
    const auto loaded = store_.load("key");
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->bytes, binaryOf('b', 10).bytes);
  }
  [[nodiscard]] std::size_t fileCount() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder()), {}));
  }
  [[nodiscard]] fs::path folder() const { return folder_.path() / "programs"; }

  test::TemporaryFolder folder_;
  ProgramStore store_{folder()};
};

TEST_F(ProgramStoreTest, ReturnsWhatWasSavedUnderTheKeyOnly) {
  const auto loaded = store_.load("key");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->format, 7u);
  EXPECT_EQ(loaded->bytes, binaryOf('a', 1000).bytes);
  EXPECT_FALSE(store_.load("kez"));
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(ProgramStoreTest, TruncatedFilesAreReplaced) {
  const std::string whole = content();
  for (const std::size_t size_bytes :
       {std::size_t{0}, std::size_t{7}, std::size_t{39}, std::size_t{40}, std::size_t{500}, whole.size() - 1})
    expectRefused(whole.substr(0, size_bytes), "truncated");
}

TEST_F(ProgramStoreTest, EveryChangedByteIsFound) {
  const std::string whole = content();
  for (const std::size_t at : {std::size_t{0}, std::size_t{8}, std::size_t{23}, std::size_t{24}, std::size_t{31},
                               std::size_t{36}, std::size_t{40}, whole.size() - 1}) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x41);
    expectRefused(changed, "is not used");
  }
}

TEST_F(ProgramStoreTest, ForeignFilesAreReplaced) {
  store_.save("other", binaryOf('c', 10));
  std::ifstream other(store_.fileOf("other"), std::ios::binary);
  expectRefused({std::istreambuf_iterator<char>(other), {}}, "another program or driver");
  expectRefused(std::string(100, 'x'), "not such a file");
}

TEST_F(ProgramStoreTest, TheOldestFilesGoWhenTheBoundIsReached) {
  ProgramStore small(folder(), 3000);
  fs::last_write_time(store_.fileOf("key"), fs::file_time_type::clock::now() - std::chrono::hours(1));
  small.save("second", binaryOf('b', 1000));
  EXPECT_TRUE(small.load("key"));
  small.save("third", binaryOf('c', 1000));
  EXPECT_FALSE(small.load("key"));
  EXPECT_TRUE(small.load("second"));
  EXPECT_TRUE(small.load("third"));
  small.save("too large", binaryOf('d', 5000));
  EXPECT_EQ(fileCount(), 0u);
}

TEST_F(ProgramStoreTest, SeveralProcessesLeaveWholeFilesOnly) {
  std::vector<pid_t> children;
  for (char value = 'a'; value < 'd'; ++value) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      bool is_fine = true;
      for (int round = 0; round < 100; ++round) {
        store_.save("shared", binaryOf(value, 5000));
        const auto loaded = store_.load("shared");
        is_fine = is_fine && loaded && loaded->bytes.size() == 5000 && loaded->bytes.front() == loaded->bytes.back();
      }
      ::_exit(is_fine ? 0 : 1);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(fileCount(), 2u);
}

TEST_F(ProgramStoreTest, AFolderThatCannotBeWrittenIsSaidOnce) {
  std::ofstream(folder_.path() / "file") << "x";
  ProgramStore store(folder_.path() / "file" / "programs");
  const LogCapture log;
  store.save("key", binaryOf('a', 10));
  const std::string said = log.text();
  EXPECT_THAT(said, HasSubstr("cannot be written"));
  store.save("key", binaryOf('a', 10));
  EXPECT_EQ(log.text(), said);
  EXPECT_FALSE(store.load("key"));
}

TEST(ProgramStore, IsInTheUsersCacheFolderOrNowhere) {
  ::setenv("HOME", "/home/somebody", 1);
  ::setenv("XDG_CACHE_HOME", "/var/cache/own", 1);
  EXPECT_EQ(ProgramStore::userFolder("programs"), "/var/cache/own/spindrift/programs");
  ::setenv("XDG_CACHE_HOME", "relative", 1);
  EXPECT_EQ(ProgramStore::userFolder("programs"), "/home/somebody/.cache/spindrift/programs");
  ::unsetenv("XDG_CACHE_HOME");
  ::unsetenv("HOME");
  const LogCapture log;
  EXPECT_TRUE(ProgramStore::userFolder("programs").empty());
  EXPECT_TRUE(ProgramStore::userFolder("programs").empty());
  EXPECT_THAT(log.text(), HasSubstr("neither XDG_CACHE_HOME nor HOME"));
  EXPECT_FALSE(ProgramStore(ProgramStore::userFolder("programs")).load("key"));
}

}  // namespace
}  // namespace spindrift::gpu
