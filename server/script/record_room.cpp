#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <spindrift/script/record_room.h>

#include "script_client.h"

namespace spindrift::script {
namespace {

constexpr std::chrono::milliseconds kReviewInterval{100};
constexpr std::chrono::milliseconds kGoodbye{500};
constexpr double kRate_hz = 60.0;

v1::ScriptClient setupOf(const RecordRoomOptions& options) {
  v1::ScriptClient out;
  out.set_name("recorder");
  out.set_room(options.room);
  out.set_token_env(options.token_variable);
  for (const v1::Layer layer : options.layers) {
    v1::Subscribe& wanted = *out.add_subscribe();
    wanted.set_layer(layer);
    wanted.set_packing(options.packing);
    wanted.set_level(options.level);
    wanted.set_max_rate_hz(kRate_hz);
  }
  return out;
}

}  // namespace

core::Result<RecordRoomReport> recordRoom(const RecordRoomOptions& options, const std::function<bool()>& is_stopped) {
  using WallClock = recording::WaterRecorder::WallClock;
  std::unique_ptr<recording::WaterRecorder> recorder;  // from the first message on
  core::Result<void> result;
  const auto take = [&](core::ByteView message) {
    if (!result) return;
    if (!recorder) {
      auto begun = recording::WaterRecorder::begin(options.recorder, WallClock::now());
      if (begun)
        recorder = *std::move(begun);
      else
        result = begun.error();
    }
    if (recorder) result = recorder->take(message, WallClock::now());
  };
  const v1::ScriptClient setup = setupOf(options);
  const auto pool = net::ClientPool::create(0, options.ca_file);
  ScriptClient client(setup, *pool, options.url, {.program = "spindrift record", .message = take});
  client.connect();
  RecordRoomReport report;
  while (result && report.end.empty()) {
    pool->runFor(kReviewInterval, [&] { return !result || client.end().has_value(); });
    client.followDraining();
    if (const auto& end = client.end(); result && end)
      result = core::unavailable(fmt::format("the server ended the connection: {} {}", end->code, end->reason));
    if (is_stopped()) report.end = "it was stopped";
    if (!recorder || !result) continue;
    result = recorder->review(WallClock::now());
    if (recorder->end()) report.end = *recorder->end();
    if (recorder->takeKeyframeWish()) {
      for (const v1::Subscribe& wanted : setup.subscribe()) client.subscribe(wanted);
    }
  }
  client.disconnect(false);
  pool->runFor(kGoodbye, [&] { return client.end().has_value(); });
  if (recorder) {
    auto finished = recorder->finish();
    if (result) result = finished;
    report.counts = recorder->counts();
    report.files = recorder->files();
  }
  if (!result) return result.error();
  return report;
}

}  // namespace spindrift::script
