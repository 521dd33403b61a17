#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/bench/queries.h>
#include <spindrift/rooms/room.h>
#include <spindrift/wire/server_message.h>

#include "silent_outlets.h"

namespace spindrift::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kBlockTicks = 60;

/// Takes the answers of a room, as bytes, and nothing else.
struct AnswersAlone final : test::SilentOutlets {
  std::uint64_t answer_count = 0;
  std::uint64_t answer_bytes = 0;
  std::string refusal{};  ///< of the last command that was refused

  void commandRejected(const rooms::Command&, const wire::CommandRejection& rejection) override {
    refusal = rejection.message();
  }
  void queryAnswered(const rooms::Room&, const core::Sender&, const v1::QueryAnswer& answer) override {
    ++answer_count;
    answer_bytes += wire::queryAnswer(answer)->size();
  }
};

struct Case {
  std::string name;
  std::uint32_t people_count = 1;
  int point_count = 0;  ///< of each person
  bool moves = false;
};

/// A paused room that is advanced tick by tick.
class SteppedRoom {
 public:
  core::Result<void> open(const v1::Scene& scene, const gpu::DeviceChoice& device) {
    auto water = water::Water::create(device, scene);
    if (!water) return water.error();
    builder_ = std::make_unique<water::WaterBuilder>(device);
    auto room = rooms::Room::begin("main", *std::move(water), rules_, *builder_, outlets_, {}, {});
    if (!room) return room.error();
    room_ = *std::move(room);
    while (true) {
      const auto restored = room_->restoreUntil(Clock::time_point::max());
      if (!restored) return restored.error();
      if (*restored) break;
    }
    for (std::uint64_t session = 1; session <= kPeopleMaxCount; ++session)
      person_ids_.push_back(room_->roster().arrive({.session = session}).person_id);
    room_->start(Clock::now());
    v1::Command pause;
    pause.mutable_set_paused()->set_paused(true);
    return send(std::move(pause), 1);
  }
  ~SteppedRoom() {
    if (room_) room_->releaseDevice();
  }

  core::Result<void> send(v1::Command command, std::uint64_t session) {
    const rooms::Command sent{.sender = {.session_id = session, .person_id = person_ids_[session - 1]},
                              .message = std::move(command)};
    outlets_.refusal.clear();
    const auto refused = room_->admit(sent);
    room_->run(Clock::now());
    if (refused || !outlets_.refusal.empty()) return core::invalid(refused ? refused->message() : outlets_.refusal);
    return {};
  }

  /// Mean time of a tick [ms]: on the wall, and of all threads of this process.
  struct Times {
    double wall_ms = 0.0;
    double cpu_ms = 0.0;
  };
  core::Result<Times> run() {
    v1::Command step;
    step.mutable_step()->set_tick_count(kBlockTicks);
    const std::uint64_t end_tick = room_->tick() + kBlockTicks;
    if (auto sent = send(std::move(step), 1); !sent) return sent.error();
    const std::uint64_t first_tick = room_->tick();
    const auto ticks = static_cast<double>(end_tick - first_tick);
    const auto begin = Clock::now();
    const std::clock_t cpu_begin = std::clock();
    while (room_->tick() < end_tick) room_->run(Clock::now());
    return Times{std::chrono::duration<double, std::milli>(Clock::now() - begin).count() / ticks,
                 1e3 * static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC / ticks};
  }

  core::Result<void> ask(const Case& test, double side_m, bool begins) {
    for (std::uint64_t session = 1; session <= test.people_count; ++session) {
      v1::Command command;
      v1::Query& query = *command.mutable_query();
      query.set_interval_ticks(1);
      for (int k = 0; begins && k < test.point_count; ++k) {
        query.add_x_m(static_cast<float>(side_m * (std::fmod(0.618 * k, 0.96) - 0.48)));
        query.add_z_m(static_cast<float>(side_m * (std::fmod(0.755 * k, 0.96) - 0.48)));
      }
      if (test.moves) query.add_velocity_x_mps(0.01F);
      if (auto sent = send(std::move(command), session); !sent) return sent;
    }
    return {};
  }

  [[nodiscard]] const AnswersAlone& outlets() const { return outlets_; }
  [[nodiscard]] double side_m() const {
    const sim::WaveLayout& wave = *room_->water().derived().wave;
    return std::min(wave.length_m, wave.width_m);
  }
  static constexpr std::uint64_t kPeopleMaxCount = 8;

 private:
  rooms::RoomRules rules_;
  AnswersAlone outlets_;
  std::unique_ptr<water::WaterBuilder> builder_;
  std::shared_ptr<rooms::Room> room_;
  std::vector<std::uint32_t> person_ids_;
};

struct Mean {
  double mean = 0.0;
  double error = 0.0;  ///< of the mean
};

Mean meanOf(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Mean out;
  for (const double value : values) out.mean += value / n;
  double sum = 0.0;
  for (const double value : values) sum += (value - out.mean) * (value - out.mean);
  if (values.size() > 1) out.error = std::sqrt(sum / (n - 1.0) / n);
  return out;
}

core::Result<boost::json::object> measure(SteppedRoom& room, const Case& test, double seconds, std::FILE* out) {
  std::vector<double> without_ms, wall_ms, cpu_ms;
  const std::uint64_t answers_before = room.outlets().answer_count, bytes_before = room.outlets().answer_bytes;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  for (int pair = 0; pair < 4 || Clock::now() < end; ++pair) {
    SteppedRoom::Times times[2] = {};
    for (const int turn : {0, 1}) {
      const bool asks = (turn + pair) % 2 == 1;  // the first of a pair is the other one each time
      if (auto asked = room.ask(test, room.side_m(), asks); !asked) return asked.error();
      const auto measured = room.run();
      if (!measured) return measured.error();
      times[asks ? 1 : 0] = *measured;
    }
    without_ms.push_back(times[0].wall_ms);
    wall_ms.push_back(times[1].wall_ms - times[0].wall_ms);
    cpu_ms.push_back(times[1].cpu_ms - times[0].cpu_ms);
  }
  if (auto ended = room.ask(test, room.side_m(), false); !ended) return ended.error();
  const Mean base = meanOf(without_ms), wall = meanOf(wall_ms), cpu = meanOf(cpu_ms);
  std::ranges::sort(wall_ms);
  std::ranges::sort(cpu_ms);
  const double median_ms = wall_ms[wall_ms.size() / 2], cpu_median_ms = cpu_ms[cpu_ms.size() / 2];
  const std::uint64_t answers = room.outlets().answer_count - answers_before;
  const std::uint64_t bytes = room.outlets().answer_bytes - bytes_before;
  const double answer_bytes = answers > 0 ? static_cast<double>(bytes) / static_cast<double>(answers) : 0.0;
  fmt::print(out, "{:<32} {:>6} {:>8.3f} {:>8.4f} {:>7.4f} {:>8.4f} {:>8.4f} {:>7.4f} {:>8.4f} {:>7.0f}\n", test.name,
             wall_ms.size(), base.mean, wall.mean, wall.error, median_ms, cpu.mean, cpu.error, cpu_median_ms,
             answer_bytes);
  return boost::json::object{
      {"case", test.name},           {"pairs", wall_ms.size()},         {"tick_ms", base.mean},
      {"extra_ms", wall.mean},       {"extra_error_ms", wall.error},    {"extra_median_ms", median_ms},
      {"extra_cpu_ms", cpu.mean},    {"extra_cpu_error_ms", cpu.error}, {"extra_cpu_median_ms", cpu_median_ms},
      {"answer_bytes", answer_bytes}};
}

}  // namespace

core::Result<boost::json::object> measureQueries(const v1::Scene& scene, const gpu::DeviceChoice& device,
                                                 double seconds, std::FILE* out) {
  SteppedRoom room;
  if (auto opened = room.open(scene, device); !opened) return opened.error();
  const std::vector<Case> cases = {{"nobody asks, both blocks alike", 1, 0, false},
                                   {"1 point", 1, 1, false},
                                   {"1,024 points that stay", 1, 1024, false},
                                   {"1,024 points that move", 1, 1024, true},
                                   {"8 people with 1,024 points each", SteppedRoom::kPeopleMaxCount, 1024, true}};
  fmt::print(out, "queries, one answer per tick; pairs of blocks of {} ticks; ms per tick\n", kBlockTicks);
  fmt::print(out, "{:<32} {:>6} {:>8} {:>8} {:>7} {:>8} {:>8} {:>7} {:>8} {:>7}\n", "case", "pairs", "without", "more",
             "+-", "median", "CPU more", "+-", "median", "bytes");
  boost::json::array rows;
  for (const Case& test : cases) {
    auto row = measure(room, test, seconds, out);
    if (!row) return row.error();
    rows.push_back(*std::move(row));
  }
  return boost::json::object{{"rows", std::move(rows)}};
}

}  // namespace spindrift::bench
