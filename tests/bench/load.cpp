#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <thread>

#include <boost/json.hpp>
#include <fmt/format.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>

#include <spindrift/bench/crowd.h>
#include <spindrift/bench/load.h>
#include <spindrift/codec/stream.h>
#include <spindrift/core/monotonic.h>
#include <spindrift/net/client.h>
#include <spindrift/v1/wire.pb.h>

#include "client_urls.h"
#include "messages.h"

namespace spindrift::bench {
namespace {

using Clock = std::chrono::steady_clock;
using google::protobuf::internal::WireFormatLite;

constexpr double kRate_hz = 60.0;
/// New connections per second, while the crowd comes.
constexpr std::size_t kArrivals_per_s = 200;
/// A client whose connection ended tries again after this.
constexpr std::chrono::milliseconds kReconnectPause{250};

struct Frame {
  v1::Layer layer = v1::LAYER_UNSPECIFIED;
  double server_time_s = 0.0;
};

/// Reads only layer and time of a frame, because thousands of clients share this machine with the servers.
/// nullopt: no frame.
std::optional<Frame> glance(core::ByteView bytes) {
  google::protobuf::io::CodedInputStream in(bytes.data(), static_cast<int>(bytes.size()));
  if (WireFormatLite::GetTagFieldNumber(in.ReadTag()) != v1::ServerMessage::kFrameFieldNumber) return std::nullopt;
  int length = 0;
  if (!in.ReadVarintSizeAsInt(&length)) return std::nullopt;
  Frame out;
  while (const std::uint32_t tag = in.ReadTag()) {
    const int field = WireFormatLite::GetTagFieldNumber(tag);
    std::uint64_t value = 0;
    if (field == v1::LayerFrame::kLayerFieldNumber) {
      if (!in.ReadVarint64(&value)) return std::nullopt;
      out.layer = static_cast<v1::Layer>(value);
    } else if (field == v1::LayerFrame::kServerTimeSFieldNumber) {
      if (!in.ReadLittleEndian64(&value)) return std::nullopt;
      out.server_time_s = WireFormatLite::DecodeDouble(value);
    } else if (!WireFormatLite::SkipField(&in, tag)) {
      return std::nullopt;
    }
  }
  return out;
}

struct LoadClient {
  std::shared_ptr<net::Client> client;
  std::size_t url = 0;
  bool is_open = false;
  Clock::time_point try_at{};
  std::string resume_key;
  std::uint64_t surface_count = 0;
  Clock::time_point last_frame{};
  Clock::duration longest_gap{};
  std::uint64_t last_command = 0;
  Clock::time_point next_command{};
  std::map<std::uint64_t, Clock::time_point> waiting;
};

class Load {
 public:
  Load(const LoadOptions& options, std::vector<net::ClientUrl> urls)
      : options_(options), urls_(std::move(urls)), pool_(net::ClientPool::create(0)), clients_(options.client_count) {}

  void run() {
    const auto begin = Clock::now();
    for (std::size_t k = 0; k < clients_.size(); ++k) {
      clients_[k].url = k % urls_.size();
      clients_[k].try_at = begin + k * std::chrono::milliseconds(1000) / kArrivals_per_s;
    }
    const auto start = begin + clients_.size() * std::chrono::milliseconds(1000) / kArrivals_per_s + kSettle;
    turnUntil(start);
    for (LoadClient& one : clients_) {
      one.longest_gap = {};
      one.last_frame = start;
      one.surface_count = 0;
    }
    reconnect_count_ = 0;
    measures_ = true;
    turnUntil(start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options_.seconds)));
    measures_ = false;
    const auto end = Clock::now();
    for (LoadClient& one : clients_) one.longest_gap = std::max(one.longest_gap, end - one.last_frame);
  }

  boost::json::object report(std::FILE* out) {
    std::vector<double> counts;
    std::vector<double> gaps_ms;
    std::uint64_t unanswered_count = 0;
    std::size_t open_count = 0;
    for (const LoadClient& one : clients_) {
      counts.push_back(static_cast<double>(one.surface_count));
      gaps_ms.push_back(std::chrono::duration<double, std::milli>(one.longest_gap).count());
      unanswered_count += one.waiting.size();
      open_count += one.is_open ? 1 : 0;
    }
    for (auto* values : {&counts, &gaps_ms, &delays_ms_, &answers_ms_}) std::ranges::sort(*values);
    boost::json::object result{{"clients", clients_.size()},
                               {"open", open_count},
                               {"seconds", options_.seconds},
                               {"surface_frames_fewest", counts.front()},
                               {"surface_frames_median", quantileOf(counts, 0.5)},
                               {"longest_gap_p50_ms", quantileOf(gaps_ms, 0.5)},
                               {"longest_gap_max_ms", gaps_ms.back()},
                               {"delay_p50_ms", quantileOf(delays_ms_, 0.5)},
                               {"delay_p99_ms", quantileOf(delays_ms_, 0.99)},
                               {"answers", answers_ms_.size()},
                               {"answer_p50_ms", quantileOf(answers_ms_, 0.5)},
                               {"answer_p99_ms", quantileOf(answers_ms_, 0.99)},
                               {"rejected", rejected_count_},
                               {"unanswered", unanswered_count},
                               {"reconnects", reconnect_count_},
                               {"received_mbit_per_s", 8e-6 * static_cast<double>(bytes_count_) / options_.seconds}};
    for (const auto& [name, value] : result)
      fmt::print(out, "{:<24} {}\n", std::string(name), boost::json::serialize(value));
    return result;
  }

  [[nodiscard]] bool sawFrames() const { return !delays_ms_.empty(); }

 private:
  /// Not measured: a thousand clients that come within seconds are served late at first where programs share few cores.
  static constexpr std::chrono::seconds kSettle{5};

  void turnUntil(Clock::time_point deadline) {
    for (auto now = Clock::now(); now < deadline; now = Clock::now()) {
      for (LoadClient& one : clients_) {
        if (!one.client && now >= one.try_at) connect(one);
        if (one.is_open && measures_ && options_.commands_per_s > 0 && now >= one.next_command) splash(one, now);
      }
      pool_->runFor(std::chrono::milliseconds(10), [] { return false; });
    }
  }

  void connect(LoadClient& one) {
    one.client = pool_->connect(urls_[one.url], {},
                                {.opened = [this, &one] { greet(one); },
                                 .message = [this, &one](core::ByteView bytes) { take(one, bytes); },
                                 .closed =
                                     [this, &one](std::uint16_t, const std::string&) {
                                       one.is_open = false;
                                       one.client = nullptr;
                                       one.waiting.clear();
                                       one.url = (one.url + 1) % urls_.size();
                                       one.try_at = Clock::now() + kReconnectPause;
                                       ++reconnect_count_;
                                     }});
  }

  void greet(LoadClient& one) {
    one.is_open = true;
    (void)one.client->send(bytesOf(helloOf(options_.token, one.resume_key)));
    for (const v1::Layer layer : {v1::LAYER_SURFACE, v1::LAYER_PARTICLES, v1::LAYER_FOAM, v1::LAYER_BODIES}) {
      v1::ClientMessage message;
      v1::Subscribe& subscribe = *message.mutable_subscribe();
      subscribe.set_layer(layer);
      subscribe.set_max_rate_hz(kRate_hz);
      subscribe.set_packing(v1::PACKING_PACKED);
      subscribe.set_level(codec::toWire(options_.level));
      (void)one.client->send(bytesOf(message));
    }
    const auto spread = std::chrono::duration<double>(1.0 / std::max(options_.commands_per_s, 1e-3));
    one.next_command = Clock::now() + std::chrono::duration_cast<Clock::duration>(spread) *
                                          static_cast<int>(&one - clients_.data()) / static_cast<int>(clients_.size());
  }

  void splash(LoadClient& one, Clock::time_point now) {
    one.next_command =
        now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / options_.commands_per_s));
    v1::ClientMessage message;
    message.mutable_command()->set_command_id(++one.last_command);
    message.mutable_command()->mutable_splash()->set_depth_m(0.05);
    message.mutable_command()->mutable_splash()->set_radius_m(0.5);
    if (one.client->send(bytesOf(message))) one.waiting[one.last_command] = Clock::now();
  }

  void take(LoadClient& one, core::ByteView bytes) {
    const auto now = Clock::now();
    if (measures_) bytes_count_ += bytes.size();
    if (const auto frame = glance(bytes)) {
      if (frame->layer != v1::LAYER_SURFACE) return;
      one.longest_gap = std::max(one.longest_gap, now - one.last_frame);
      one.last_frame = now;
      ++one.surface_count;
      if (measures_) delays_ms_.push_back(1e3 * (core::monotonic_s(now) - frame->server_time_s));
      return;
    }
    v1::ServerMessage message;
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return;
    if (message.has_welcome()) one.resume_key = message.welcome().resume_key();
    if (!message.has_ack() && !message.has_reject()) return;
    const auto sent =
        one.waiting.extract(message.has_ack() ? message.ack().command_id() : message.reject().command_id());
    rejected_count_ += message.has_reject() ? 1 : 0;
    if (sent && measures_ && message.has_ack())
      answers_ms_.push_back(std::chrono::duration<double, std::milli>(now - sent.mapped()).count());
  }

  const LoadOptions& options_;
  const std::vector<net::ClientUrl> urls_;
  std::unique_ptr<net::ClientPool> pool_;
  std::vector<LoadClient> clients_;
  bool measures_ = false;
  std::uint64_t bytes_count_ = 0;
  std::uint64_t reconnect_count_ = 0;
  std::uint64_t rejected_count_ = 0;
  std::vector<double> delays_ms_;
  std::vector<double> answers_ms_;
};

}  // namespace

core::Result<boost::json::object> measureLoad(const LoadOptions& options, std::FILE* out) {
  auto urls = parseUrls(options.urls);
  if (!urls) return urls.error();
  Load load(options, *std::move(urls));
  load.run();
  if (!load.sawFrames())
    return core::Error{core::ErrorCode::kUnavailable, "no client received a frame from " + options.urls.front()};
  return load.report(out);
}

}  // namespace spindrift::bench
