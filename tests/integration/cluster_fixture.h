// A NATS server, servers and edges of one cluster as processes of a test.
#pragma once

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <boost/json.hpp>
#include <gtest/gtest.h>

#include "child_process.h"
#include "scripted_client.h"
#include "temporary_folder.h"

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

class ClusterTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists("/usr/sbin/nats-server")) GTEST_SKIP() << "nats-server is not installed";
    startNats();
    if (IsSkipped() || HasFatalFailure()) return;
    folder_.write("pool.textproto",
                  "wave { resolution_count: 64 side_m: 16 depth_m: 1 } boats { capacity_count: 8 }\n"
                  "unwatched: UNWATCHED_GO_ON\n");
    folder_.write("tank.textproto", "wave { resolution_count: 32 side_m: 8 depth_m: 1 }\n");
  }

  /// Starts NATS, the second time on the port of the first.
  void startNats() {
    const auto ports = folder_.path() / "ports";
    std::filesystem::create_directories(ports);
    nats_ = std::make_unique<LoggedProcess>(
        "/usr/sbin/nats-server -a 127.0.0.1 -js -sd '" + (folder_.path() / "jetstream").string() + "' -p " +
            std::to_string(nats_port_ == 0 ? -1 : nats_port_) + " --ports_file_dir '" + ports.string() + "'",
        folder_.path() / "nats.log");
    ASSERT_NE(nats_->waitForLog("Server is ready"), "");
    if (nats_port_ != 0) return;
    const std::string log = nats_->waitForLog("Listening for client connections on 127.0.0.1:");
    const std::string mark = "client connections on 127.0.0.1:";
    nats_port_ = std::stoi(log.substr(log.find(mark) + mark.size()));
  }
  [[nodiscard]] std::string natsUrl() const { return "nats://127.0.0.1:" + std::to_string(nats_port_); }

  struct Member {
    std::unique_ptr<LoggedProcess> process;
    std::uint16_t port = 0;
  };
  Member start(const std::string& arguments, const std::string& name) {
    Member out;
    out.process = std::make_unique<LoggedProcess>(
        std::string(SPINDRIFT_PROGRAM) + " " + arguments + " --port 0 --nats " + natsUrl() + " --node " + name,
        folder_.path() / (name + ".log"));
    const std::string mark = "Spindrift is ready: http://127.0.0.1:";
    const std::string log = out.process->waitForLog(mark);
    EXPECT_NE(log, "") << out.process->log();
    if (!log.empty()) out.port = static_cast<std::uint16_t>(std::stoi(log.substr(log.find(mark) + mark.size())));
    return out;
  }
  /// A server with the room main of the scene "pool", if no other has it.
  Member server(const std::string& name, const std::string& more = "") {
    return start("serve --device software --scene '" + scene("pool") + "' --state-dir '" +
                     (folder_.path() / "state").string() + "' --snapshot-every-s 1 " + more,
                 name);
  }
  /// Waits until it knows a server.
  Member edge(const std::string& name, const std::string& more = "") {
    Member out = start("edge " + more, name);
    EXPECT_TRUE(eventually([&] { return httpRequest(out.port, "GET", "/readyz").status == 200; }))
        << out.process->log();
    EXPECT_TRUE(eventually([&] { return rooms(out.port).find("\"main\"") != std::string::npos; }));
    return out;
  }
  [[nodiscard]] std::string scene(const std::string& name) const {
    return (folder_.path() / (name + ".textproto")).string();
  }
  static std::string rooms(std::uint16_t port) { return httpRequest(port, "GET", "/api/v1/rooms").body; }
  static HttpAnswer post(std::uint16_t port, const std::string& target, const std::string& body) {
    return httpRequest(port, "POST", target, "Content-Type: application/json\r\n", body);
  }
  /// The value of a metric without labels; -1: there is none.
  static double metric(std::uint16_t port, const std::string& name) {
    const std::string page = httpRequest(port, "GET", "/metrics").body;
    const std::size_t at = page.find("\nspindrift_" + name + " ");
    return at == std::string::npos ? -1.0 : std::stod(page.substr(at + name.size() + 12));
  }
  static bool eventually(const std::function<bool()>& holds) {
    const auto deadline = std::chrono::steady_clock::now() + kStartPatience;
    while (!holds()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return true;
  }

  TemporaryFolder folder_;
  std::unique_ptr<LoggedProcess> nats_;
  int nats_port_ = 0;
};

}  // namespace spindrift::test
