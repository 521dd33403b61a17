// One client of a room for the C library: a thread that keeps the connection, commands with answers, and the water at
// points.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <spindrift_client.h>

#include <spindrift/client/join.h>

namespace spindrift::client {

using Clock = std::chrono::steady_clock;

struct Outcome {
  spindrift_status status = SPINDRIFT_OK;
  std::string text;  ///< one line, unless SPINDRIFT_OK
};

struct Points {
  std::vector<float> x_m;
  std::vector<float> z_m;
};

/// The water at points, and when it was so. `values`: one per point.
struct PointsAnswer {
  spindrift_moment moment = {};
  v1::QueryResult values;
};

/// Thread-safe. At most 64 commands and queries wait at a time.
class Session {
 public:
  struct Options {
    net::ClientUrl url;
    Identity identity;
    std::string ca_file;
    Clock::duration answer_within;
  };
  explicit Session(Options options);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  /// Leaves the room. No other call may be under way.
  ~Session();

  /// Waits until it has joined the room, or is refused, or the time is over.
  Outcome waitJoined(Clock::duration patience);
  Outcome state();
  std::uint64_t connectionCount();

  /// Sends a command and waits for its Ack. `is_patient`: as long as the connection lasts.
  Outcome command(v1::Command command, v1::Ack& ack, bool is_patient = false);
  Outcome query(const Points& points, PointsAnswer& answer);
  Outcome follow(Points points, std::uint32_t interval_ticks);
  /// `count`: of the caller's points. If it is not connected, `answer` is the last one, if any.
  Outcome newest(std::uint64_t after, Clock::duration patience, std::size_t count, PointsAnswer& answer);

 private:
  using Lock = std::unique_lock<std::mutex>;
  struct Waiting {
    bool is_done = false;
    Outcome outcome;
    v1::Ack ack;
    PointsAnswer answer;
  };

  void run();
  void keep();
  void connect();
  void drop(const std::string& why);
  void ended(std::uint16_t code, const std::string& reason);
  void take(core::ByteView bytes);
  void takeAnswers(v1::QueryAnswer& answers);
  void answered(std::uint64_t command_id, Outcome outcome, const v1::Ack& ack);
  void ask();
  void refuse(const std::string& text);
  void send(const v1::ClientMessage& message);
  [[nodiscard]] Outcome present() const;

  const Options options_;
  const std::unique_ptr<net::ClientPool> pool_;

  std::mutex mutex_;  ///< of everything below
  std::condition_variable changed_;
  bool is_stopping_ = false;
  net::ClientUrl url_;
  Identity identity_;
  std::shared_ptr<net::Client> connection_;
  std::uint64_t connection_number_ = 0;  ///< callbacks of an earlier one are ignored
  bool is_joined_ = false;
  std::uint64_t joined_count_ = 0;
  int failed_count_ = 0;
  std::string last_why_;
  std::optional<std::string> refused_;
  std::optional<Clock::time_point> connect_at_;
  std::optional<Move> move_;
  Clock::time_point joined_at_;
  Clock::time_point heard_at_;
  Clock::time_point pinged_at_;
  std::uint64_t next_command_id_ = 1;
  std::uint32_t next_query_id_ = 1;
  std::map<std::uint64_t, Waiting*> commands_;
  std::map<std::uint32_t, Waiting*> queries_;

  /// Followed points; none if empty.
  struct Followed {
    Points points;
    std::uint32_t interval_ticks = 1;
    std::uint32_t query_id = 0;
    std::uint64_t command_id = 0;             ///< of a query that the library sent by itself
    std::optional<Clock::time_point> ask_at;  ///< when to ask again
    Outcome outcome;                          ///< why there are no answers
  };
  Followed followed_;
  PointsAnswer newest_;

  std::thread thread_;
};

}  // namespace spindrift::client
