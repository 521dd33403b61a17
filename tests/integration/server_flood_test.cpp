// Floods of commands from every client of a server at once: nobody is closed who keeps to the limit of messages, the
// room keeps its ticks, queues stay bounded; only those beyond that limit lose their connection.
#include <atomic>
#include <thread>

#include <fmt/format.h>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr int kFlooderCount = 12;
constexpr auto kDuration = 4s;

struct FloodReport {
  std::uint64_t sent_count = 0;
  std::uint64_t applied_count = 0;
  std::uint64_t busy_count = 0;
  std::uint64_t other_count = 0;  ///< rejected for another reason
  [[nodiscard]] std::uint64_t answerCount() const { return applied_count + busy_count + other_count; }
  bool is_closed = false;
  std::uint16_t close_code = 0;
};

/// Sends splashes at the rate and reads all answers, until the end of the time or of the connection.
FloodReport flood(ScriptedClient& client, double messages_per_s) {
  FloodReport report;
  const auto read = [&](std::chrono::milliseconds patience) {
    while (const auto bytes = client.ws().receive(patience)) {
      v1::ServerMessage message;
      if (!message.ParseFromArray(bytes->data(), static_cast<int>(bytes->size()))) continue;
      if (message.has_ack()) ++report.applied_count;
      if (message.has_reject()) {
        ++(message.reject().reason() == v1::REJECT_REASON_BUSY ? report.busy_count : report.other_count);
      }
    }
  };
  const auto begin = Clock::now();
  while (Clock::now() < begin + kDuration && !client.ws().closed()) {
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - begin).count();
    const auto due_count = static_cast<std::uint64_t>(elapsed_s * messages_per_s);
    for (; report.sent_count < due_count && !client.ws().closed(); ++report.sent_count) {
      v1::ClientMessage message;
      *message.mutable_command() = splash(0.01);
      message.mutable_command()->set_command_id(report.sent_count + 1);
      client.send(message);
    }
    read(1ms);
  }
  // Commands that were accepted are answered at a tick.
  const auto deadline = Clock::now() + kPatience;
  while (report.answerCount() < report.sent_count && !client.ws().closed() && Clock::now() < deadline) read(100ms);
  report.is_closed = client.ws().closed();
  report.close_code = client.ws().closeCode();
  return report;
}

class FloodOfCommands : public WaveServerTest {
 protected:
  void adjust(service::WaterServerOptions& options) const override {
    // As from many addresses: the limits per address would slow these clients, which all come from one.
    options.network.address_messages_per_s = options.network.address_message_burst_count = 1e6;
    options.network.address_session_share = 1.0;
  }

  std::vector<FloodReport> floodFromAll(double messages_per_s) {
    std::vector<ScriptedClient> clients;
    for (int k = 0; k < kFlooderCount; ++k) clients.push_back(client());
    std::vector<FloodReport> reports(clients.size());
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < clients.size(); ++k)
      threads.emplace_back([&, k] { reports[k] = flood(clients[k], messages_per_s); });
    for (std::thread& thread : threads) thread.join();
    return reports;
  }
};

TEST_F(FloodOfCommands, BelowTheLimitIsAnsweredBusy) {
  constexpr double kTicksPerSecond = 60.0;
  ScriptedClient watcher = client();
  const auto first_tick = watcher.apply(setSpeed(1.0));
  ASSERT_TRUE(first_tick);
  const auto begin = Clock::now();
  std::atomic<bool> done{false};
  std::uint64_t most_waiting_count = 0;
  std::thread sampler([&] {
    for (; !done; std::this_thread::sleep_for(20ms))
      most_waiting_count = std::max(most_waiting_count, server().networkStats().waiting_control_count);
  });
  // More than twice what a session may send as commands (200/s), and below its limit of messages (500/s).
  const auto reports = floodFromAll(450.0);
  done = true;
  sampler.join();
  const auto last_tick = watcher.apply(setSpeed(1.0));
  ASSERT_TRUE(last_tick);
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - begin).count();
  const double ratio = static_cast<double>(*last_tick - *first_tick) / kTicksPerSecond / elapsed_s;
  FloodReport all;
  for (const FloodReport& report : reports) {
    EXPECT_FALSE(report.is_closed) << report.close_code;
    EXPECT_GT(report.applied_count, 0u);
    EXPECT_GT(report.busy_count, 0u);
    EXPECT_EQ(report.other_count, 0u);
    EXPECT_EQ(report.applied_count + report.busy_count, report.sent_count) << "every command has one answer";
    all.sent_count += report.sent_count;
    all.applied_count += report.applied_count;
    all.busy_count += report.busy_count;
  }
  fmt::print(
      "{} clients sent {} commands in {:.1f} s: {} applied, {} busy; real-time factor {:.2f}; at most {} answers "
      "waited\n",
      kFlooderCount, all.sent_count, elapsed_s, all.applied_count, all.busy_count, ratio, most_waiting_count);
  EXPECT_LE(most_waiting_count, kFlooderCount * 2048u);
  EXPECT_GT(ratio, 0.5) << "0.9 and more on a quiet machine";
  EXPECT_TRUE(watcher.apply(setSpeed(1.0)));
}

TEST_F(FloodOfCommands, TenTimesTheLimitClosesOnlyTheSenders) {
  ScriptedClient watcher = client();
  watcher.subscribe(v1::LAYER_SURFACE);
  for (const FloodReport& report : floodFromAll(5000.0)) {
    EXPECT_TRUE(report.is_closed);
    EXPECT_EQ(report.close_code, 1008) << "policy";
  }
  EXPECT_TRUE(watcher.nextFrame(v1::LAYER_SURFACE));
  EXPECT_TRUE(watcher.apply(setSpeed(1.0)));
  EXPECT_TRUE(client().runFor(5)) << "a new client is served";
}

}  // namespace
}  // namespace spindrift::test
