#include <memory>
#include <string>

#include <boost/json.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <spindrift/gpu/device.h>
#include <spindrift/history/replay.h>

#include "commands.h"

namespace spindrift::cli {
namespace {

struct ReplayOptions {
  std::string file;
  std::string device = "auto";
  std::string json_file;
};

void print(const history::ReplayOutcome& outcome) {
  fmt::print("{} ticks, {} commands carried out again, {} states compared\n", outcome.tick_count, outcome.command_count,
             outcome.hash_count);
  if (outcome.truncation)
    fmt::print("the log has no end: {}; everything before it was replayed\n", *outcome.truncation);
  if (outcome.recovered_tick) {
    fmt::print(
        "the watchdog stepped in at tick {}: when it does depends on the machine's speed, so states after it may "
        "differ\n",
        *outcome.recovered_tick);
  }
  if (outcome.difference && outcome.device_difference)
    fmt::print("another device or driver: {}; for that alone states may differ\n", *outcome.device_difference);
  if (const auto& d = outcome.difference) {
    fmt::print("DIFFERS at tick {}: recorded {:016x}, now {:016x}; the state was the same at tick {}\n", d->tick,
               d->recorded, d->found, d->last_equal_tick);
  } else {
    fmt::print("the same, bit for bit\n");
  }
}

boost::json::object toJson(const history::ReplayOutcome& outcome) {
  boost::json::object out{
      {"tick_count", outcome.tick_count},
      {"command_count", outcome.command_count},
      {"hash_count", outcome.hash_count},
      {"same", !outcome.difference},
      {"device_difference", outcome.device_difference ? boost::json::value(*outcome.device_difference) : nullptr},
      {"truncation", outcome.truncation ? boost::json::value(*outcome.truncation) : nullptr},
      {"recovered_tick", outcome.recovered_tick ? boost::json::value(*outcome.recovered_tick) : nullptr}};
  if (const auto& d = outcome.difference) {
    out["difference"] = boost::json::object{{"tick", d->tick},
                                            {"last_equal_tick", d->last_equal_tick},
                                            {"recorded", fmt::format("{:016x}", d->recorded)},
                                            {"found", fmt::format("{:016x}", d->found)}};
  }
  return out;
}

int replay(const ReplayOptions& options) {
  auto device = gpu::parseDeviceChoice(options.device);
  if (!device) return fail(device.error());
  auto log = history::CommandLogReader::open(options.file);
  if (!log) return fail(log.error());
  const v1::RecordHeader& header = (*log)->header();
  const bool shows_progress = isatty(STDERR_FILENO) != 0;
  const auto outcome = history::replayLog(*device, **log, [&](std::uint64_t tick) {
    if (shows_progress) fmt::print(stderr, "\rtick {} ", tick);
  });
  if (shows_progress) fmt::print(stderr, "\r");
  if (!outcome) return fail(outcome.error());
  if (outcome->device_difference)
    spdlog::warn("{}: states repeat bit for bit on the same device and driver only", *outcome->device_difference);
  if (options.json_file != "-") {
    fmt::print("room {}, scene {}: ", header.room(), header.scene().name());
    print(*outcome);
  }
  if (auto written = writeJson(options.json_file, toJson(*outcome)); !written) return fail(written.error());
  return outcome->difference ? core::exitCode(core::ErrorCode::kCheckFailed) : 0;
}

}  // namespace

ProgramCommand addReplay(CLI::App& program) {
  const auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = program.add_subcommand("replay", "Run a room's log again and compare the states");
  command->add_option("file", options->file, "A log that serve --record wrote")->required();
  addDevice(*command, options->device);
  addJson(*command, options->json_file);
  return {command, [options] { return replay(*options); }};
}

}  // namespace spindrift::cli
