#include <cctype>
#include <thread>

#include <boost/json.hpp>
#include <fmt/format.h>

#include "client_urls.h"
#include "soak_client.h"

namespace spindrift::bench {
namespace {

using Clock = SoakCrowd::Clock;

/// New connections per second at the start.
constexpr std::size_t kArrivals_per_s = 20;
constexpr std::size_t kClientsPerWitness = 8;
constexpr const char* kRow = "{:>8} {:>5} {:>9} {:>8} {:>8} {:>9} {:>9} {:>10} {:>10} {:>8} {:>8} {:>9} {:>11} {:>9}\n";

Clock::duration toClock(double time_s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s));
}

template <typename Counts>
std::uint64_t sumOf(const Counts& counts) {
  std::uint64_t out = 0;
  for (const auto& [key, count] : counts) out += count;
  return out;
}

/// "REJECT_REASON_BUSY" -> "busy".
std::string shortName(v1::RejectReason reason) {
  std::string out = v1::RejectReason_Name(reason).substr(sizeof("REJECT_REASON"));
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

class Soak {
 public:
  Soak(const SoakOptions& options, std::vector<net::ClientUrl> urls)
      : crowd_{.options = options,
               .urls = std::move(urls),
               .pool = net::ClientPool::create(0),
               .random = std::mt19937(options.seed),
               .total = {},
               .interval = {}} {
    clients_.reserve(options.client_count);
    const auto begin = Clock::now();
    for (std::size_t k = 0; k < options.client_count; ++k)
      clients_.emplace_back(std::make_unique<SoakClient>(
          crowd_, k % kClientsPerWitness == 0, begin + k * std::chrono::milliseconds(1000) / kArrivals_per_s));
  }

  void run(std::FILE* out) {
    const SoakOptions& options = crowd_.options;
    const auto begin = Clock::now();
    const auto end = begin + toClock(options.warm_up_s + options.seconds);
    auto next_row = begin + toClock(options.interval_s);
    fmt::print(out, kRow, "time_s", "open", "answers", "p50_ms", "p99_ms", "heavy_p99", "rejected", "unanswered",
               "reconnects", "ended", "refused", "frames", "undecodable", "nonfinite");
    for (auto now = begin; now < end; now = Clock::now()) {
      crowd_.measures = now >= begin + toClock(options.warm_up_s);
      for (const auto& client : clients_) client->turn(now);
      crowd_.pool->runFor(std::chrono::milliseconds(10), [] { return false; });
      if (now < next_row) continue;
      next_row += toClock(options.interval_s);
      printRow(out, std::chrono::duration<double>(now - begin).count());
    }
    crowd_.measures = false;
  }

  boost::json::object report(std::FILE* out) const {
    const SoakTally& all = crowd_.total;
    boost::json::object rejected;
    for (const auto& [reason, count] : all.rejected) rejected[shortName(reason)] = count;
    boost::json::object ended;
    for (const auto& [code, count] : all.ended) ended[std::to_string(code)] = count;
    boost::json::object result{
        {"clients", clients_.size()},
        {"seconds", crowd_.options.seconds},
        {"sent", all.sent_count},
        {"answers", all.answers.count()},
        {"answer_p50_ms", all.answers.quantile_ms(0.5)},
        {"answer_p99_ms", all.answers.quantile_ms(0.99)},
        {"answer_max_ms", all.answers.most_ms()},
        {"heavy_answers", all.heavy_answers.count()},
        {"heavy_answer_p50_ms", all.heavy_answers.quantile_ms(0.5)},
        {"heavy_answer_p99_ms", all.heavy_answers.quantile_ms(0.99)},
        {"rejected", rejected},
        {"unanswered", all.unanswered_count},
        {"cut", all.cut_count},
        {"reconnects", all.reconnect_count},
        {"resumed", all.resumed_count},
        {"ended", ended},
        {"refused", all.refused_count},
        {"frames", all.frame_count},
        {"longest_gap_ms", all.longest_gap_ms},
        {"decoded", all.decoded_count},
        {"undecodable", all.undecodable_count},
        {"nonfinite", all.nonfinite_count},
        {"watchdog_nonfinite", all.watchdog_nonfinite_count},
        {"received_mbit_per_s", 8e-6 * static_cast<double>(all.bytes_count) / crowd_.options.seconds}};
    for (const auto& [name, value] : result)
      fmt::print(out, "{:<24} {}\n", std::string(name), boost::json::serialize(value));
    return result;
  }

  [[nodiscard]] bool sawFrames() const { return crowd_.total.frame_count > 0; }

 private:
  void printRow(std::FILE* out, double time_s) {
    const SoakTally one = std::exchange(crowd_.interval, SoakTally{});
    const auto open = std::ranges::count_if(clients_, [](const auto& client) { return client->isOpen(); });
    const auto number = [](double value) { return fmt::format("{:.2f}", value); };
    fmt::print(out, kRow, fmt::format("{:.1f}", time_s), open, one.answers.count(),
               number(one.answers.quantile_ms(0.5)), number(one.answers.quantile_ms(0.99)),
               number(one.heavy_answers.quantile_ms(0.99)), sumOf(one.rejected), one.unanswered_count,
               one.reconnect_count, sumOf(one.ended), one.refused_count, one.frame_count, one.undecodable_count,
               one.nonfinite_count);
    std::fflush(out);
  }

  SoakCrowd crowd_;
  std::vector<std::unique_ptr<SoakClient>> clients_;
};

}  // namespace

core::Result<boost::json::object> measureSoak(const SoakOptions& options, std::FILE* out) {
  auto urls = parseUrls(options.urls);
  if (!urls) return urls.error();
  Soak soak(options, *std::move(urls));
  soak.run(out);
  if (!soak.sawFrames())
    return core::Error{core::ErrorCode::kUnavailable, "no client received a frame from " + options.urls.front()};
  return soak.report(out);
}

}  // namespace spindrift::bench
