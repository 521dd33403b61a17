#include <algorithm>
#include <atomic>
#include <cstring>
#include <fstream>
#include <memory>
#include <thread>

#include <boost/json.hpp>
#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <spindrift/bench/crowd.h>
#include <spindrift/bench/fanout.h>
#include <spindrift/bench/scene_crowd.h>
#include <spindrift/codec/frame_decoder.h>
#include <spindrift/net/server.h>
#include <spindrift/service/water_server.h>

#include "bare_send.h"

namespace spindrift::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kRoom = "bench";
constexpr double kRate_hz = 20.0;

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double total_pages = 0.0, resident_pages = 0.0;
  statm >> total_pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

core::SharedBytes message(char verb, std::uint64_t number) {
  core::Bytes out(1 + sizeof number);
  out[0] = static_cast<std::uint8_t>(verb);
  std::memcpy(out.data() + 1, &number, sizeof number);
  return core::share(std::move(out));
}

/// All sessions watch layer 0; the application answers "c" + number with "a" + number.
class EchoApplication final : public net::Application {
 public:
  void serverStarts(net::Hub& hub) override { hub_ = &hub; }
  core::Result<void> acceptSession(const std::string&) override { return {}; }
  void sessionOpened(net::SessionId session, const net::SessionOpening&) override {
    io_thread_ = pthread_self();  // the only I/O thread
    hub_->join(session, kRoom, demand_);
    hub_->watch(session, 0, {.max_rate_hz = kWatchRate_hz});
  }
  void sessionMessage(net::SessionId session, core::ByteView bytes) override {
    std::uint64_t number = 0;
    if (bytes.size() != 1 + sizeof number || bytes[0] != 'c') return;
    std::memcpy(&number, bytes.data() + 1, sizeof number);
    hub_->sendAnswer(session, message('a', number));
  }
  void sessionClosed(net::SessionId, const net::SessionEnd&) override {}
  void httpRequest(const net::HttpRequest&, net::HttpResponder respond) override { respond(std::nullopt); }

  /// Call it while a session is open.
  [[nodiscard]] double ioCpu_s() const { return threadCpu_s(io_thread_); }

 private:
  static constexpr double kWatchRate_hz = 1000.0;
  net::Hub* hub_ = nullptr;
  const std::shared_ptr<core::DemandTable> demand_ = std::make_shared<core::DemandTable>();
  std::atomic<pthread_t> io_thread_{};
};

/// A frame begins with 'f' and the time of its publication.
core::SharedBytes frameNow(std::size_t size_bytes) {
  core::Bytes out(size_bytes);
  out[0] = 'f';
  const auto now = Clock::now().time_since_epoch().count();
  std::memcpy(out.data() + 1, &now, sizeof now);
  return core::share(std::move(out));
}

Sighting look(core::ByteView bytes) {
  Sighting out;
  std::int64_t number = 0;
  if (bytes.size() < 1 + sizeof number) return out;
  std::memcpy(&number, bytes.data() + 1, sizeof number);
  if (bytes[0] == 'f') {
    out.kind = Sighting::Kind::kFrame;
    out.published = Clock::time_point(Clock::duration(number));
  } else if (bytes[0] == 'a') {
    out.kind = Sighting::Kind::kAnswer;
    out.number = static_cast<std::uint64_t>(number);
  }
  return out;
}

struct FanoutCase {
  std::string name;
  std::size_t frame_bytes = 0;
  double rate_hz = kRate_hz;
  CrowdOptions crowd;
};

struct FanoutRow {
  std::string name;
  CrowdReport crowd{};
  net::ServerStats before{};
  net::ServerStats after{};
  double cpu_s = 0.0;  ///< of the threads that send: network and publisher; 0 if unknown
  double resident_grown_mb = 0.0;
  double real_time_factor = 0.0;
};

core::Result<net::ClientUrl> urlOf(std::uint16_t port, const std::optional<net::TlsFiles>& tls) {
  return net::ClientUrl::parse((tls ? "wss://127.0.0.1:" : "ws://127.0.0.1:") + std::to_string(port) + "/ws");
}

core::Result<FanoutRow> measure(const FanoutCase& test, const std::optional<net::TlsFiles>& tls) {
  EchoApplication application;
  net::ServerOptions options;
  options.port = 0;
  options.max_session_count = 1024;
  options.tls = tls;
  auto server = net::Server::start(options, application);
  if (!server) return server.error();
  std::atomic<bool> stopping{false};
  std::thread publisher([&] {
    auto next = Clock::now();
    while (!stopping) {
      (*server)->hub().publish(kRoom, 0, {frameNow(test.frame_bytes), nullptr});
      next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / test.rate_hz));
      std::this_thread::sleep_until(next);
    }
  });
  FanoutRow out{.name = test.name};
  const auto url = urlOf((*server)->port(), tls);
  const auto cpu_s = [&] { return application.ioCpu_s() + threadCpu_s(publisher.native_handle()); };
  double begin_cpu_s = 0.0;
  double begin_mb = 0.0;
  out.crowd = runCrowd(
      *url, test.crowd,
      [&] {
        begin_cpu_s = cpu_s();
        out.before = (*server)->stats();
        begin_mb = resident_mb();
      },
      [&] {
        out.cpu_s = cpu_s() - begin_cpu_s;
        out.after = (*server)->stats();
        out.resident_grown_mb = resident_mb() - begin_mb;
      });
  stopping = true;
  publisher.join();
  return out;
}

/// A thread sends the same frames to the readers of the case, with nothing between.
FanoutRow measureBareSend(const FanoutCase& test) {
  BareSender sender(test.crowd.client_count, test.rate_hz, [&] { return frameNow(test.frame_bytes); });
  FanoutRow out{.name = test.name};
  const auto url = urlOf(sender.port(), std::nullopt);
  double begin_cpu_s = 0.0;
  out.crowd = runCrowd(
      *url, test.crowd,
      [&] {
        begin_cpu_s = sender.cpu_s();
        out.before.sent_frame_count = sender.sentFrameCount();
      },
      [&] {
        out.cpu_s = sender.cpu_s() - begin_cpu_s;
        out.after.sent_frame_count = sender.sentFrameCount();
      });
  return out;
}

core::Result<FanoutRow> measureServer(const v1::Scene& scene, const gpu::DeviceChoice& device, double seconds,
                                      const std::optional<net::TlsFiles>& tls) {
  service::WaterServerOptions options;
  options.device = device;
  options.network.port = 0;
  options.network.max_session_count = 1024;
  options.network.tls = tls;
  options.rooms.push_back({"main", scene});
  auto server = service::WaterServer::start(std::move(options));
  if (!server) return server.error();
  FanoutRow out{.name = fmt::format("{}, 200 clients", scene.name())};
  const auto url = urlOf((*server)->port(), tls);
  double begin_mb = 0.0;
  CrowdOptions crowd = sceneCrowd(scene, 200, seconds);
  if (tls) crowd.ca_file = tls->certificate_file;
  out.crowd = runCrowd(
      *url, crowd,
      [&] {
        out.before = (*server)->networkStats();
        begin_mb = resident_mb();
      },
      [&] {
        out.after = (*server)->networkStats();
        out.resident_grown_mb = resident_mb() - begin_mb;
        out.real_time_factor = (*server)->simulation().find("")->vitals()->diagnostics.real_time_factor;
      });
  return out;
}

/// CPU time per frame and reader; nullopt if unknown.
std::optional<double> frameCpu_us(const FanoutRow& row) {
  if (row.cpu_s == 0.0) return std::nullopt;
  return 1e6 * row.cpu_s / static_cast<double>(row.after.sent_frame_count - row.before.sent_frame_count);
}

void print(std::FILE* out, const FanoutRow& row) {
  const CrowdReport& c = row.crowd;
  const auto cpu_us = frameCpu_us(row);
  // Frames of a real scene do not contain the time of their publication.
  const auto delay = [&](double ratio) {
    return c.delays_ms.empty() ? std::string("-") : fmt::format("{:.1f}", quantileOf(c.delays_ms, ratio));
  };
  const std::string last = c.last_delays_ms.empty() ? "-" : fmt::format("{:.1f}", quantileOf(c.last_delays_ms, 0.99));
  fmt::print(
      out, "{:<30} {:>6} {:>5}/{:>5}/{:>5} {:>8} {:>8} {:>8} {:>8} {:>7} {:>8} {:>8.1f} {:>8.1f} {:>7.1f} {:>5}\n",
      row.name, c.connected_count, c.fewest_frames, c.median_frames, c.most_frames, delay(0.5), delay(0.99), last,
      cpu_us ? fmt::format("{:.1f}", *cpu_us) : "-", row.after.dropped_frame_count - row.before.dropped_frame_count,
      row.after.evicted_session_count, quantileOf(c.answers_ms, 0.5), quantileOf(c.answers_ms, 0.99),
      row.resident_grown_mb, c.lost_count + c.unanswered_count);
  if (row.real_time_factor > 0) fmt::print(out, "{:<30} real-time factor {:.2f}\n", "", row.real_time_factor);
}

boost::json::object toJson(const FanoutRow& row) {
  const CrowdReport& c = row.crowd;
  const auto cpu_us = frameCpu_us(row);
  return {{"name", row.name},
          {"connected_count", c.connected_count},
          {"fewest_frames", c.fewest_frames},
          {"median_frames", c.median_frames},
          {"most_frames", c.most_frames},
          {"delay_p50_ms", quantileOf(c.delays_ms, 0.5)},
          {"delay_p99_ms", quantileOf(c.delays_ms, 0.99)},
          {"last_delay_p99_ms", quantileOf(c.last_delays_ms, 0.99)},
          {"cpu_us_per_frame_sent", cpu_us ? boost::json::value(*cpu_us) : nullptr},
          {"dropped_frames", row.after.dropped_frame_count - row.before.dropped_frame_count},
          {"evicted_count", row.after.evicted_session_count},
          {"answer_p50_ms", quantileOf(c.answers_ms, 0.5)},
          {"answer_p99_ms", quantileOf(c.answers_ms, 0.99)},
          {"resident_grown_mb", row.resident_grown_mb},
          {"lost_count", c.lost_count},
          {"unanswered_count", c.unanswered_count},
          {"real_time_factor", row.real_time_factor}};
}

/// Bare sends and broadcasts to the same crowd in turn, because the speed of the machine changes. Returns the ratios of
/// their CPU times per frame and reader, sorted.
core::Result<std::vector<double>> compareWithBareSend(const std::string& size_name, std::size_t frame_bytes,
                                                      const CrowdOptions& crowd, boost::json::array& rows,
                                                      std::FILE* out) {
  constexpr int kPairCount = 3;
  std::vector<double> ratios;
  for (int k = 0; k < kPairCount; ++k) {
    const FanoutRow bare = measureBareSend({"bare send, " + size_name, frame_bytes, kRate_hz, crowd});
    const auto broadcast = measure({"broadcast of the same", frame_bytes, kRate_hz, crowd}, std::nullopt);
    if (!broadcast) return broadcast.error();
    for (const FanoutRow& row : {bare, *broadcast}) {
      print(out, row);
      rows.push_back(toJson(row));
    }
    ratios.push_back(*frameCpu_us(*broadcast) / *frameCpu_us(bare));
  }
  std::ranges::sort(ratios);
  fmt::print(out, "{:<30} {:.2f} times a bare send (median of {} pairs, {:.2f} to {:.2f})\n", "",
             ratios[kPairCount / 2], kPairCount, ratios.front(), ratios.back());
  return ratios;
}

}  // namespace

core::Result<boost::json::object> measureFanout(const v1::Scene& scene, const std::string& device, double seconds,
                                                const std::optional<net::TlsFiles>& tls, std::FILE* out) {
  const auto choice = gpu::parseDeviceChoice(device);
  if (!choice) return choice.error();
  /// Long enough for the server to evict the clients that never read.
  const std::chrono::duration<double> slow_case(std::max(seconds, 13.0));
  const auto crowd = [&](std::size_t clients, std::size_t deaf, std::chrono::duration<double> duration) {
    CrowdOptions options;
    options.client_count = clients;
    if (tls) options.ca_file = tls->certificate_file;
    options.deaf_count = deaf;
    options.duration = duration;
    options.commands_per_s = 1.0;
    options.command = [](std::uint64_t number) { return message('c', number); };
    options.look = look;
    return options;
  };
  std::vector<FanoutCase> cases = {
      {"100 readers, 200 kB", 200'000, kRate_hz, crowd(100, 0, std::chrono::duration<double>(seconds))},
      {"the same, 10 never read", 200'000, kRate_hz, crowd(100, 10, slow_case)},
      {"200 readers, 25 kB, visitors", 25'000, kRate_hz, crowd(200, 0, std::chrono::duration<double>(seconds))}};
  cases.back().crowd.visitors_per_s = 5.0;
  fmt::print(out, "fan-out, clients and server in this process{}\n", tls ? ", TLS" : "");
  fmt::print(out, "{:<30} {:>6} {:>17} {:>8} {:>8} {:>8} {:>8} {:>7} {:>8} {:>8} {:>8} {:>7} {:>5}\n", "case", "there",
             "frames, each", "p50 ms", "p99 ms", "last p99", "us/frame", "drops", "evicted", "ack p50", "ack p99",
             "+MB", "lost");
  boost::json::array rows;
  boost::json::object over_bare_send;
  CrowdOptions silent = crowd(100, 0, std::chrono::duration<double>(seconds));
  silent.commands_per_s = 0.0;
  silent.ca_file.clear();
  for (const auto& [size_name, frame_bytes] : {std::pair("200 kB", 200'000U), std::pair("4 kB", 4'000U)}) {
    const auto ratios = compareWithBareSend(size_name, frame_bytes, silent, rows, out);
    if (!ratios) return ratios.error();
    over_bare_send[size_name] = boost::json::value_from(*ratios);
  }
  for (const FanoutCase& test : cases) {
    auto row = measure(test, tls);
    if (!row) return row.error();
    print(out, *row);
    rows.push_back(toJson(*row));
  }
  auto row = measureServer(scene, *choice, seconds, tls);
  if (!row) return row.error();
  print(out, *row);
  rows.push_back(toJson(*row));
  return boost::json::object{{"rows", std::move(rows)}, {"cpu_over_bare_send", std::move(over_bare_send)}};
}

}  // namespace spindrift::bench
