// A NATS server, servers and edges of one cluster as processes of a test.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <boost/json.hpp>
#include <gtest/gtest.h>

#include "nats_process.h"
#include "scripted_client.h"
#include "temporary_folder.h"

namespace spindrift::test {

class ClusterTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!NatsProcess::isInstalled()) GTEST_SKIP() << "nats-server is not installed";
    nats_ = std::make_unique<NatsProcess>(folder_.path() / "nats");
    folder_.write("pool.textproto",
                  "wave { resolution_count: 64 side_m: 16 depth_m: 1 } boats { capacity_count: 8 } floaters { floaters "
                  "{ x_m: 3 } }\n"
                  "unwatched: UNWATCHED_GO_ON\n");
    folder_.write("tank.textproto", "wave { resolution_count: 32 side_m: 8 depth_m: 1 }\n");
  }

  struct Member {
    std::unique_ptr<LoggedProcess> process;
    std::uint16_t port = 0;
  };
  /// `nats_port`: of the NATS server, or of a link to it.
  Member start(const std::string& arguments, const std::string& name, std::uint16_t nats_port) {
    Member out;
    out.process = std::make_unique<LoggedProcess>(std::string(SPINDRIFT_PROGRAM) + " " + arguments +
                                                      " --port 0 --nats nats://127.0.0.1:" + std::to_string(nats_port) +
                                                      " --node " + name,
                                                  folder_.path() / (name + ".log"));
    const std::string mark = "Spindrift is ready: http://127.0.0.1:";
    const std::string log = out.process->waitForLog(mark);
    EXPECT_NE(log, "") << out.process->log();
    if (!log.empty()) out.port = static_cast<std::uint16_t>(std::stoi(log.substr(log.find(mark) + mark.size())));
    return out;
  }
  Member start(const std::string& arguments, const std::string& name) { return start(arguments, name, nats_->port()); }
  /// A server with the room main of the scene "pool", if no other has it.
  Member server(const std::string& name, const std::string& more, std::uint16_t nats_port) {
    return start("serve --device software --scene '" + scene("pool") + "' --snapshot-every-s 1 " + more, name,
                 nats_port);
  }
  Member server(const std::string& name, const std::string& more = "") {
    return server(name, sharedState() + more, nats_->port());
  }
  [[nodiscard]] std::string sharedState() const { return "--state-dir '" + (folder_.path() / "state").string() + "' "; }
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
  /// The value of a metric without labels; -1 if the page does not have it.
  static double metric(std::uint16_t port, const std::string& name) {
    const std::string page = httpRequest(port, "GET", "/metrics").body;
    const std::size_t at = page.find("\nspindrift_" + name + " ");
    return at == std::string::npos ? -1.0 : std::stod(page.substr(at + name.size() + 12));
  }
  /// Returns a subscription to the packed surface at the full rate.
  static v1::Subscribe packedSurface() {
    v1::Subscribe out;
    out.set_layer(v1::LAYER_SURFACE);
    out.set_max_rate_hz(60.0);
    out.set_packing(v1::PACKING_PACKED);
    return out;
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
  std::unique_ptr<NatsProcess> nats_;
};

}  // namespace spindrift::test
