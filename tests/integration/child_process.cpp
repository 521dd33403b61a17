#include "child_process.h"

#include <csignal>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace spindrift::test {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> environmentWith(const std::vector<std::string>& extra) {
  std::vector<std::string> all = extra;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const std::string name = text.substr(0, text.find('=') + 1);
    bool is_replaced = false;
    for (const std::string& mine : extra) is_replaced = is_replaced || mine.starts_with(name);
    if (!is_replaced) all.push_back(text);
  }
  return all;
}

/// Appends the available bytes; false at the end of the stream.
bool append(int pipe, std::string& text) {
  char chunk[4096];
  const ssize_t got = ::read(pipe, chunk, sizeof chunk);
  if (got <= 0) return false;
  text.append(chunk, static_cast<std::size_t>(got));
  return true;
}

}  // namespace

ChildProcess::ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
                           const std::vector<std::string>& extra_environment, int passed_descriptor) {
  int out[2];
  int err[2];
  if (::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
  // Last, because the pipes may have number 3 here. It stays open across exec, also if it is number 3 already.
  if (passed_descriptor >= 0) posix_spawn_file_actions_adddup2(&actions, passed_descriptor, 3);
  std::vector<std::string> words = {program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> environment = environmentWith(extra_environment);
  const int failure = ::posix_spawn(&pid_, program.c_str(), &actions, nullptr, pointersTo(words).data(),
                                    pointersTo(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  ::close(out[1]);
  ::close(err[1]);
  out_pipe_ = out[0];
  err_pipe_ = err[0];
  if (failure != 0) throw std::runtime_error(program + ": " + std::strerror(failure));
}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  for (const int pipe : {out_pipe_, err_pipe_}) {
    if (pipe >= 0) ::close(pipe);
  }
}

std::optional<std::string> ChildProcess::waitForLine(const std::string& prefix) {
  const auto deadline = Clock::now() + kPatience;
  do {
    for (std::size_t begin = 0, end = 0; (end = out_.find('\n', begin)) != std::string::npos; begin = end + 1) {
      if (out_.compare(begin, prefix.size(), prefix) == 0) return out_.substr(begin, end - begin);
    }
  } while (readSome(deadline));
  return std::nullopt;
}

void ChildProcess::signal(int number) const {
  if (pid_ > 0) ::kill(pid_, number);
}

std::optional<int> ChildProcess::wait(std::chrono::milliseconds timeout) {
  const auto deadline = Clock::now() + timeout;
  while (readSome(deadline)) {
  }
  // Both outputs end with the process, because it starts no other processes.
  if (pid_ <= 0 || out_pipe_ >= 0 || err_pipe_ >= 0) return std::nullopt;
  int status = 0;
  if (::waitpid(std::exchange(pid_, -1), &status, 0) < 0) return std::nullopt;
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

bool ChildProcess::readSome(Clock::time_point deadline) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
  // poll() ignores negative descriptors.
  pollfd pipes[2] = {{out_pipe_, POLLIN, 0}, {err_pipe_, POLLIN, 0}};
  if ((out_pipe_ < 0 && err_pipe_ < 0) || left.count() <= 0) return false;
  if (::poll(pipes, 2, static_cast<int>(left.count())) <= 0) return false;
  if (pipes[0].revents != 0 && !append(out_pipe_, out_)) ::close(std::exchange(out_pipe_, -1));
  if (pipes[1].revents != 0 && !append(err_pipe_, err_)) ::close(std::exchange(err_pipe_, -1));
  return true;
}

}  // namespace spindrift::test
