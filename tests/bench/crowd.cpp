#include <algorithm>
#include <map>
#include <memory>

#include <spindrift/bench/crowd.h>

namespace spindrift::bench {
namespace {

using Clock = std::chrono::steady_clock;

double ms(Clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

struct Spectator {
  std::shared_ptr<net::Client> client;
  bool is_deaf = false;
  bool opened = false;
  bool closed = false;
  bool leaves = false;           ///< a visitor before it leaves, or any client at the end of the crowd
  Clock::time_point leave_at{};  ///< time at which a visitor leaves
  std::uint64_t frame_count = 0;
  std::uint64_t last_command = 0;
  Clock::time_point next_command{};
  std::map<std::uint64_t, Clock::time_point> waiting;
};

class Crowd {
 public:
  Crowd(const net::ClientUrl& url, const CrowdOptions& options)
      : url_(url), options_(options), pool_(net::ClientPool::create(0, options.ca_file)) {}

  CrowdReport run(const std::function<void()>& begin, const std::function<void()>& end) {
    for (std::size_t k = 0; k < options_.client_count; ++k) {
      enter(k < options_.deaf_count);
      runUntil(Clock::now());
    }
    runUntil(Clock::now() + std::chrono::duration_cast<Clock::duration>(options_.settle));
    if (begin) begin();
    measures_ = true;
    const auto start = Clock::now();
    const auto stop = start + std::chrono::duration_cast<Clock::duration>(options_.duration);
    auto next_visitor = start;
    for (auto now = start; now < stop; now = Clock::now()) {
      if (options_.visitors_per_s > 0 && now >= next_visitor) {
        next_visitor +=
            std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / options_.visitors_per_s));
        Spectator& visitor = enter(false);
        visitor.leaves = true;
        visitor.leave_at = now + std::chrono::seconds(1);
      }
      act(now);
      runUntil(std::min(stop, now + std::chrono::milliseconds(5)));
    }
    measures_ = false;
    if (end) end();
    return report(stop);
  }

 private:
  Spectator& enter(bool is_deaf) {
    auto& spectator = *crowd_.emplace_back(std::make_unique<Spectator>());
    spectator.is_deaf = is_deaf;
    net::ClientOptions options;
    options.reads = !is_deaf;
    if (is_deaf) options.receive_buffer_bytes = kDeafBufferBytes;
    spectator.client = pool_->connect(
        url_, options,
        {.opened =
             [this, &spectator] {
               spectator.opened = true;
               // Spread the commands of a crowd over time.
               spectator.next_command = Clock::now() + std::chrono::milliseconds(7 * crowd_.size() % 1000);
               for (const auto& message : options_.on_open) (void)spectator.client->send(message);
             },
         .message = [this, &spectator](core::ByteView bytes) { see(spectator, bytes); },
         .closed = [&spectator](std::uint16_t, const std::string&) { spectator.closed = true; }});
    return spectator;
  }

  void act(Clock::time_point now) {
    for (const auto& one : crowd_) {
      if (one->leaves && !one->closed && now >= one->leave_at) one->client->close();
      if (options_.commands_per_s <= 0 || one->is_deaf || one->leaves || !one->opened || now < one->next_command)
        continue;
      one->next_command = now + std::chrono::duration_cast<Clock::duration>(
                                    std::chrono::duration<double>(1.0 / options_.commands_per_s));
      const std::uint64_t number = ++one->last_command;
      one->waiting[number] = Clock::now();
      (void)one->client->send(options_.command(number));
    }
  }

  void see(Spectator& spectator, core::ByteView bytes) {
    const auto now = Clock::now();
    const Sighting sighting = options_.look(bytes);
    if (sighting.kind == Sighting::Kind::kAnswer) {
      const auto node = spectator.waiting.extract(sighting.number);
      if (node && measures_) answers_ms_.push_back(ms(now - node.mapped()));
    }
    if (!measures_) return;
    received_bytes_ += bytes.size();
    if (sighting.kind != Sighting::Kind::kFrame) return;
    ++spectator.frame_count;
    if (sighting.published == Clock::time_point{}) return;
    delays_ms_.push_back(ms(now - sighting.published));
    if (spectator.leaves) return;
    Receipts& receipts = receipts_[sighting.published];
    ++receipts.count;
    receipts.last = now;
  }

  void runUntil(Clock::time_point deadline) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    pool_->runFor(std::max(left, std::chrono::milliseconds(1)), [] { return false; });
  }

  CrowdReport report(Clock::time_point stop) {
    constexpr std::chrono::milliseconds kRecent{500};
    CrowdReport out;
    std::vector<std::uint64_t> counts;
    for (const auto& one : crowd_) {
      if (one->leaves) continue;
      out.connected_count += one->opened ? 1 : 0;
      if (one->is_deaf) continue;
      out.lost_count += one->closed ? 1 : 0;
      counts.push_back(one->frame_count);
      for (const auto& [number, sent] : one->waiting) out.unanswered_count += stop - sent > kRecent ? 1 : 0;
    }
    std::ranges::sort(counts);
    if (!counts.empty()) {
      out.fewest_frames = counts.front();
      out.median_frames = counts[counts.size() / 2];
      out.most_frames = counts.back();
    }
    out.received_bytes = received_bytes_;
    for (const auto& [published, receipts] : receipts_) {
      if (receipts.count == counts.size()) out.last_delays_ms.push_back(ms(receipts.last - published));
    }
    std::ranges::sort(out.last_delays_ms);
    std::ranges::sort(delays_ms_);
    std::ranges::sort(answers_ms_);
    out.delays_ms = std::move(delays_ms_);
    out.answers_ms = std::move(answers_ms_);
    return out;
  }

  /// Small, so that a backlog shows quickly.
  static constexpr int kDeafBufferBytes = 64 * 1024;

  struct Receipts {
    std::size_t count = 0;  ///< number of clients that have the frame, without visitors
    Clock::time_point last{};
  };

  const net::ClientUrl url_;
  const CrowdOptions& options_;
  std::unique_ptr<net::ClientPool> pool_;  // declared first: must outlive the clients
  std::vector<std::unique_ptr<Spectator>> crowd_;
  bool measures_ = false;
  std::uint64_t received_bytes_ = 0;
  std::vector<double> delays_ms_;
  std::map<Clock::time_point, Receipts> receipts_;  ///< by time of publication
  std::vector<double> answers_ms_;
};

}  // namespace

double quantileOf(const std::vector<double>& sorted, double ratio) {
  if (sorted.empty()) return 0.0;
  return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(ratio * static_cast<double>(sorted.size())))];
}

CrowdReport runCrowd(const net::ClientUrl& url, const CrowdOptions& options, const std::function<void()>& begin,
                     const std::function<void()>& end) {
  return Crowd(url, options).run(begin, end);
}

}  // namespace spindrift::bench
