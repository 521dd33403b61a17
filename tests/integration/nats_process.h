// Processes of a test that write a log, and a NATS server.
#pragma once

#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "child_process.h"

namespace spindrift::test {

inline constexpr std::chrono::seconds kStartPatience{40};

/// A child whose output nobody reads would block once its pipe is full: it goes to a file.
class LoggedProcess {
 public:
  LoggedProcess(const std::string& command, const std::filesystem::path& log)
      : log_(log), child_("/bin/sh", {"-c", "exec " + command + " >>'" + log.string() + "' 2>&1"}) {}
  void signal(int number) const { child_.signal(number); }
  std::optional<int> wait() { return child_.wait(); }
  [[nodiscard]] std::string log() const {
    std::ifstream file(log_);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Waits until the log contains the text; empty after `patience`. Returns the log.
  [[nodiscard]] std::string waitForLog(const std::string& text, std::chrono::seconds patience = kStartPatience) const {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < deadline) {
      std::string now = log();
      if (now.find(text) != std::string::npos) return now;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return "";
  }

 private:
  const std::filesystem::path log_;
  ChildProcess child_;
};

/// With JetStream and its monitoring page, on ports of its own that stay the same when it starts again.
class NatsProcess {
 public:
  static bool isInstalled() { return std::filesystem::exists("/usr/sbin/nats-server"); }

  /// Starts it; its files are in the folder. Throws std::runtime_error when it does not start.
  explicit NatsProcess(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
    start();
  }
  void start();
  void kill();
  /// Call it between kill() and start(): all buckets are gone.
  void loseData() { std::filesystem::remove_all(data()); }

  /// As an administrator's tool does it. Returns how many consumers, that is watches, were ended.
  int endConsumers(const std::string& bucket) const;
  void removeBucket(const std::string& bucket) const;

  [[nodiscard]] std::uint16_t port() const { return static_cast<std::uint16_t>(port_); }
  [[nodiscard]] std::uint16_t monitorPort() const { return static_cast<std::uint16_t>(monitor_port_); }
  [[nodiscard]] std::string url() const { return "nats://127.0.0.1:" + std::to_string(port_); }

 private:
  /// Sends an empty request and returns the answer.
  [[nodiscard]] std::string ask(const std::string& subject) const;
  [[nodiscard]] std::filesystem::path data() const { return folder_ / "jetstream"; }

  const std::filesystem::path folder_;
  int port_ = 0;
  int monitor_port_ = 0;
  std::unique_ptr<LoggedProcess> process_;
};

}  // namespace spindrift::test
