// Runs the program `spindrift` in tests. SPINDRIFT_PROGRAM is its path.
#pragma once

#include <algorithm>
#include <csignal>
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
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  /// `serve` with the small scene on the software device and a free port, unless `more` says otherwise.
  std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all = {"serve"};
    const auto setDefault = [&](const std::string& flag, const std::string& value) {
      if (std::ranges::find(more, flag) == more.end()) all.insert(all.end(), {flag, value});
    };
    setDefault("--scene", smallScene());
    setDefault("--device", "software");
    setDefault("--port", "0");
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Starts a server with arguments(more) and waits until it is ready. False without a usable device: the test is then
  /// skipped.
  bool serve(const std::vector<std::string>& more = {}, const std::vector<std::string>& environment = {}) {
    return start(SPINDRIFT_PROGRAM, arguments(more), environment);
  }
  /// The same with all arguments of a program that becomes the server.
  bool start(const std::string& program, const std::vector<std::string>& all,
             const std::vector<std::string>& environment = {}) {
    child_ = std::make_unique<ChildProcess>(program, all, environment);
    const auto line = child_->waitForLine("Spindrift is ready: http://127.0.0.1:");
    if (!line) {
      EXPECT_EQ(child_->wait(), 3) << "not ready: " << child_->err();
      return false;
    }
    port_ = static_cast<std::uint16_t>(std::stoul(line->substr(line->rfind(':') + 1)));
    return true;
  }
  /// Ends the server; returns its log.
  std::string stop(int signal = SIGTERM) {
    child_->signal(signal);
    EXPECT_EQ(child_->wait(), 0) << child_->err();
    return child_->err();
  }

  std::unique_ptr<ChildProcess> child_;
  std::uint16_t port_ = 0;

 private:
  TemporaryFolder folder_;
};

}  // namespace spindrift::test
