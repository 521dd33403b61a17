// Runs the program `spindrift` in tests. SPINDRIFT_PROGRAM is its path.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "child_process.h"
#include "temporary_folder.h"

namespace spindrift::test {

struct Outcome {
  int exit_code = -1;  ///< -1: did not end in time
  std::string out;
  std::string err;
};

inline Outcome runProgram(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {},
                          const std::string& program = SPINDRIFT_PROGRAM,
                          std::chrono::milliseconds patience = kPatience) {
  ChildProcess child(program, arguments, environment);
  const auto exit_code = child.wait(patience);
  return {exit_code.value_or(-1), child.out(), child.err()};
}

/// Hides every EGL driver from libglvnd.
inline std::vector<std::string> withoutDevices() {
  return {"__EGL_VENDOR_LIBRARY_DIRS=/nonexistent", "__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent"};
}

inline std::string shippedScene(const std::string& name) {
  return std::string(SPINDRIFT_SOURCE_DIR "/server/scenes/") + name + ".textproto";
}

inline auto lineCount(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

/// Checks for exactly one line on standard error, in the program's form, with each of `words`, and nothing on standard
/// output.
inline void expectOneErrorLine(const Outcome& outcome, int exit_code, const std::vector<std::string>& words) {
  EXPECT_EQ(outcome.exit_code, exit_code);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, testing::StartsWith("spindrift: "));
  EXPECT_EQ(lineCount(outcome.err), 1) << outcome.err;
  for (const std::string& word : words) EXPECT_THAT(outcome.err, testing::HasSubstr(word));
}

class ProgramTest : public testing::Test {
 protected:
  /// Writes a scene file in this test's folder and returns its path.
  std::string scene(const std::string& text, const std::string& name = "scene.textproto") const {
    folder_.write(name, text);
    return (folder_.path() / name).string();
  }
  /// Small enough for any machine.
  std::string smallScene() const {
    return scene("wave { resolution_count: 32 side_m: 8 depth_m: 1 }\n", "small.textproto");
  }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
};

}  // namespace spindrift::test
