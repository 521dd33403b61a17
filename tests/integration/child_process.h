// Runs a program and reads its output, with a bound on every wait.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "ws_client.h"

namespace spindrift::test {

class ChildProcess {
 public:
  /// Starts `program` with `arguments`, this process's environment plus `extra_environment` ("NAME=value"), and an
  /// empty standard input. `passed_descriptor` >= 0 becomes descriptor 3 of the program. Throws std::runtime_error on
  /// failure.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
               const std::vector<std::string>& extra_environment = {}, int passed_descriptor = -1);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();  ///< kills it if it still runs

  /// Reads until standard output contains a whole line that begins with `prefix`. Returns the line, or nullopt after
  /// kPatience or at the end of the output.
  std::optional<std::string> waitForLine(const std::string& prefix);
  void signal(int number) const;
  pid_t processId() const { return pid_; }
  /// Reads both outputs to the end. Returns the exit code, 128 + the signal that ended the process, or nullopt after
  /// `timeout`.
  std::optional<int> wait(std::chrono::milliseconds timeout = kPatience);

  const std::string& out() const { return out_; }
  const std::string& err() const { return err_; }

 private:
  /// Reads until `deadline`; false once both outputs have ended or the time is over.
  bool readSome(std::chrono::steady_clock::time_point deadline);

  pid_t pid_ = -1;
  int out_pipe_ = -1;
  int err_pipe_ = -1;
  std::string out_;
  std::string err_;
};

}  // namespace spindrift::test
