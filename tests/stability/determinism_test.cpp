// The same scene, seed and commands give the same bits: with another number of the rasteriser's threads, another order
// of the work groups, scratch buffers full of NaN before each tick, and a device that is seven fences behind.
#include <array>
#include <cstdio>
#include <ostream>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <spindrift/gpu/context.h>

namespace spindrift {
namespace {

/// Returns the output of state_hash for a scene, with this many threads of llvmpipe and the given test modes
/// (gpu::Checks).
std::string hashOf(const std::string& scene, int ticks, int threads, const std::string& checks = "barriers") {
  const std::string command = "SPINDRIFT_GPU_CHECKS=" + checks + " LP_NUM_THREADS=" + std::to_string(threads) +
                              " '" SPINDRIFT_STATE_HASH "' '" SPINDRIFT_SOURCE_DIR "/server/scenes/" + scene +
                              ".textproto' " + std::to_string(ticks) + " 2>/dev/null";
  std::FILE* out = popen(command.c_str(), "r");
  if (!out) return "popen failed";
  std::array<char, 64> line{};
  const char* read = std::fgets(line.data(), line.size(), out);
  const int status = pclose(out);
  if (!read || !WIFEXITED(status) || WEXITSTATUS(status) != 0) return "exit status " + std::to_string(status);
  return line.data();
}

struct Run {
  const char* scene;
  int ticks;
};

/// Names the test in reports; without it GoogleTest prints the bytes of a pointer, which differ from run to run.
void PrintTo(const Run& run, std::ostream* out) {
  *out << run.scene;
}

class Determinism : public ::testing::TestWithParam<Run> {
 protected:
  void SetUp() override {
    if (auto ctx = gpu::Context::create({gpu::DeviceChoice::Kind::kSoftware, 0}); !ctx)
      GTEST_SKIP() << "no software EGL device here: " << ctx.error().message;
  }
};

/// Three runs, each in a process of its own. To find which condition a hash depends on, repeat one with fewer.
TEST_P(Determinism, IsIndependentOfThreadsWorkGroupOrderScratchAndLag) {
  const auto [scene, ticks] = GetParam();
  const std::string plain = hashOf(scene, ticks, 1);
  ASSERT_EQ(plain.size(), 17u) << plain;
  EXPECT_EQ(hashOf(scene, ticks, 2, "barriers,shuffle=1013,lag=7"), plain);
  EXPECT_EQ(hashOf(scene, ticks, 4, "barriers,shuffle=7,poison"), plain);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Determinism,
                         testing::Values(Run{"pool", 40}, Run{"splash", 90}, Run{"harbor", 90}, Run{"dam_break", 30},
                                         Run{"open_water", 60}, Run{"splash_particles", 30}, Run{"flume", 90},
                                         Run{"flotsam", 30}),
                         [](const auto& run) { return std::string(run.param.scene); });

}  // namespace
}  // namespace spindrift
