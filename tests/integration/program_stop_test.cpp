// SIGTERM while rooms are being opened.
#include <csignal>
#include <filesystem>
#include <future>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "program_fixture.h"

namespace spindrift::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::AnyOf;
using testing::HasSubstr;

class StopWhileRoomsOpen : public ProgramTest {
 protected:
  /// Asks for a room in a thread of its own.
  std::future<HttpAnswer> openRoom(int number) const {
    return std::async(std::launch::async, [port = port_, number] {
      return httpRequest(port, "POST", "/api/v1/rooms", "Content-Type: application/json\r\n",
                         fmt::format(R"({{"name": "r{}", "scene": "splash"}})", number));
    });
  }
};

/// A file of shaders that cannot be opened while the object lives (for at most fs.lease-break-time, 45 s): a build that
/// does not end. It holds a lease (fcntl(2), F_SETLEASE), which keeps others that open the file waiting.
class EndlessFile {
 public:
  explicit EndlessFile(const fs::path& file) : descriptor_(::open(file.c_str(), O_RDWR | O_CLOEXEC)) {
    std::signal(SIGIO, SIG_IGN);  // the kernel's notice that somebody waits
    is_leased_ = ::fcntl(descriptor_, F_SETLEASE, F_WRLCK) == 0;
  }
  EndlessFile(const EndlessFile&) = delete;
  EndlessFile& operator=(const EndlessFile&) = delete;
  ~EndlessFile() { ::close(descriptor_); }

  /// False where the file system has no leases.
  [[nodiscard]] bool isLeased() const { return is_leased_; }
  /// Waits until somebody opens the file.
  [[nodiscard]] bool waitForReader() const {
    for (const auto end = std::chrono::steady_clock::now() + kPatience; std::chrono::steady_clock::now() < end;) {
      if (::fcntl(descriptor_, F_GETLEASE) != F_WRLCK) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

 private:
  const int descriptor_;
  bool is_leased_ = false;
};

TEST_F(StopWhileRoomsOpen, LongBuildDelaysNeitherAnswersNorTheEnd) {
  const fs::path shaders = folder().path() / "shaders";
  fs::copy(fs::path(SPINDRIFT_SOURCE_DIR) / "shaders", shaders, fs::copy_options::recursive);
  if (!serve({"--shader-dir", shaders.string(), "--audit-log", path("audit.jsonl")})) GTEST_SKIP() << "no device";
  const EndlessFile endless(shaders / "sph" / "force.comp");  // the room that runs has no particles
  if (!endless.isLeased()) GTEST_SKIP() << "the file system of " << shaders << " has no leases";
  std::vector<std::future<HttpAnswer>> answers;
  for (int k = 0; k < 3; ++k) answers.push_back(openRoom(k));
  ASSERT_TRUE(endless.waitForReader());
  EXPECT_EQ(httpRequest(port_, "GET", "/healthz").status, 200U);
  stop();
  for (auto& answer : answers) {
    const HttpAnswer got = answer.get();
    EXPECT_EQ(got.status, 503U) << got.body;
    EXPECT_THAT(got.body, HasSubstr("end"));
  }
  EXPECT_THAT(child_->err(), HasSubstr("the water of a room was still being built: the program ends without it"));
  EXPECT_THAT(child_->err(), HasSubstr("room main: ")) << "the summary";
}

TEST_F(StopWhileRoomsOpen, EveryRequestIsAnswered) {
  for (int round = 0; round < 6; ++round) {
    if (!serve({"--state-dir", path("state"), "--max-rooms", "32"})) GTEST_SKIP() << "no device";
    std::vector<std::future<HttpAnswer>> answers;
    for (int k = 0; k < 4; ++k) answers.push_back(openRoom(10 * round + k));
    // From before the requests are read to in the middle of the builds.
    std::this_thread::sleep_for(40ms * round);
    stop();
    for (auto& answer : answers) {
      const HttpAnswer got = answer.get();
      // 0: the server listened no more when the connection was made, or closed it before it had read the request.
      EXPECT_THAT(got.status, AnyOf(0U, 201U, 503U)) << got.body;
    }
  }
}

}  // namespace
}  // namespace spindrift::test
