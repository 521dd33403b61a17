// spindrift-bench: times of steps, codecs and crowds.
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <boost/json.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <spindrift/bench/codecs.h>
#include <spindrift/bench/fanout.h>
#include <spindrift/bench/load.h>
#include <spindrift/bench/queries.h>
#include <spindrift/bench/rooms.h>
#include <spindrift/bench/soak.h>
#include <spindrift/bench/steps.h>
#include <spindrift/bench/thesis.h>
#include <spindrift/bench/tune.h>
#include <spindrift/codec/stream.h>
#include <spindrift/core/files.h>
#include <spindrift/gpu/context.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>

#include "commands.h"
#include "forms.h"

namespace spindrift::cli {
namespace {

/// Of the floaters of --floaters: near each other, but not touching.
constexpr double kFloaterSizesApart = 2.2;

struct BenchOptions {
  std::string suite = "all";  ///< step, codec, baseline, fanout, load, query, rooms, soak, tune; all: step and codec
  std::string scene;          ///< empty: pool for baseline, otherwise harbor
  std::string fidelity;       ///< as in ServeOptions
  std::string device = "auto";
  std::string json_file;
  net::TlsFiles tls;        ///< for fanout; empty: plain
  double seconds = 2.0;     ///< measured time per case
  bench::LoadOptions load;  ///< its URLs and number of clients are those of `soak`, too
  bench::SoakOptions soak;
  std::string level = "coarse";
  std::uint32_t floater_count = 0;  ///< in place of those of the scene; 0: its own
};

/// Where tables go: not where the JSON goes.
std::FILE* tableOf(const BenchOptions& options) {
  return options.json_file == "-" ? stderr : stdout;
}

template <typename Json>
int written(const BenchOptions& options, const core::Result<Json>& result) {
  if (!result) return fail(result.error());
  const auto done = writeJson(options.json_file, *result);
  return done ? 0 : fail(done.error());
}

int benchFanout(const BenchOptions& options, const v1::Scene& scene) {
  const auto tls = options.tls.certificate_file.empty() ? std::nullopt : std::optional(options.tls);
  return written(options, bench::measureFanout(scene, options.device, options.seconds, tls, tableOf(options)));
}

/// Of servers that run already.
int benchLoad(const BenchOptions& options) {
  bench::LoadOptions load = options.load;
  load.seconds = options.seconds;
  for (const core::Level level : core::kLevels) {
    if (codec::nameOf(level) == options.level) load.level = level;
  }
  return written(options, bench::measureLoad(load, tableOf(options)));
}

int benchSoak(const BenchOptions& options) {
  bench::SoakOptions soak = options.soak;
  soak.urls = options.load.urls;
  soak.client_count = options.load.client_count;
  soak.seconds = options.seconds;
  return written(options, bench::measureSoak(soak, tableOf(options)));
}

int bench(const BenchOptions& options) {
  if (options.suite == "load") return benchLoad(options);
  if (options.suite == "soak") return benchSoak(options);
  auto device = gpu::parseDeviceChoice(options.device);
  if (!device) return fail(device.error());
  if (options.suite == "rooms" || options.suite == "tune") {
    gpu::chooseRasterThreads(std::thread::hardware_concurrency());
    if (options.suite == "tune") return written(options, bench::measureTuning(*device, tableOf(options)));
    return written(options, bench::measureRooms(*device, options.seconds, tableOf(options)));
  }
  const std::string usual = options.suite == "baseline" ? "pool" : "harbor";
  auto file = core::findScene(options.scene.empty() ? usual : options.scene);
  if (!file) return fail(file.error());
  auto loaded = scene::loadSceneFile(*file, scene::parseFidelity(options.fidelity));
  if (!loaded) return fail(loaded.error());
  if (options.suite == "fanout") return benchFanout(options, *loaded);
  if (options.suite == "query")
    return written(options, bench::measureQueries(*loaded, *device, options.seconds, tableOf(options)));
  auto ctx = gpu::Context::create(*device);
  if (!ctx) return fail(ctx.error());
  core::Scene scene = scene::toCore(*loaded);
  if (options.floater_count > 0)
    scene = bench::withFloaters(std::move(scene), options.floater_count, kFloaterSizesApart);

  std::FILE* const out = tableOf(options);
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  fmt::print(out, "machine {}, {} hardware threads; device {}, {}; scene {}\n", host,
             std::thread::hardware_concurrency(), (*ctx)->device().name, (*ctx)->device().gl_version, scene.name);
  boost::json::object json = {{"threads", std::thread::hardware_concurrency()},
                              {"device", (*ctx)->device().name},
                              {"gl_version", (*ctx)->device().gl_version},
                              {"scene", scene.name}};
  if (options.suite == "baseline") {
    auto result = bench::measureThesis(**ctx, scene, options.seconds, out);
    if (!result) return fail(result.error());
    json["baseline"] = *std::move(result);
    return written(options, core::Result<boost::json::object>(std::move(json)));
  }
  if (options.suite != "codec") {
    auto result = bench::measureSteps(**ctx, scene, options.seconds, out);
    if (!result) return fail(result.error());
    json["step"] = *std::move(result);
  }
  if (options.suite != "step") {
    auto result = bench::measureCodecs(**ctx, scene, options.seconds, out);
    if (!result) return fail(result.error());
    json["codec"] = *std::move(result);
  }
  return written(options, core::Result<boost::json::object>(std::move(json)));
}

std::vector<ProgramCommand> addOptions(CLI::App& program) {
  const auto options = std::make_shared<BenchOptions>();
  program.add_option("--suite", options->suite, "What to time")
      ->check(CLI::IsMember({"all", "step", "codec", "baseline", "fanout", "load", "query", "rooms", "soak", "tune"}))
      ->capture_default_str();
  program
      .add_option("--scene", options->scene,
                  "Scene file or name of a shipped scene [pool for --suite baseline, otherwise harbor]")
      ->check(isNotEmpty());
  addFidelity(program, options->fidelity);
  addDevice(program, options->device);
  program.add_option("--floaters", options->floater_count, "For --suite step and codec: objects in the water, in rows")
      ->check(integerIn(1, core::kMaxFloaters));
  program.add_option("--seconds", options->seconds, "Measured time per case")
      ->check(numberIn(0.1, 86400.0))
      ->capture_default_str();
  program
      .add_option("--url", options->load.urls,
                  "For --suite load and soak: a server that runs, ws://HOST:PORT/ws/ROOM; may be repeated")
      ->check(isUrl());
  program.add_option("--clients", options->load.client_count, "For --suite load and soak: number of clients")
      ->check(integerIn(1, 20000))
      ->capture_default_str();
  program.add_option("--level", options->level, "For --suite load: level of detail that they watch")
      ->check(CLI::IsMember({"coarse", "medium", "fine", "full"}))
      ->capture_default_str();
  program.add_option("--commands-per-s", options->load.commands_per_s, "For --suite load: splashes of each client")
      ->check(numberIn(0.0, 100.0))
      ->capture_default_str();
  program.add_option("--warm-up-s", options->soak.warm_up_s, "For --suite soak: time at the start that does not count")
      ->check(numberIn(0.0, 86400.0))
      ->capture_default_str();
  program.add_option("--interval-s", options->soak.interval_s, "For --suite soak: time between two rows")
      ->check(numberIn(1.0, 3600.0))
      ->capture_default_str();
  const auto addRate = [&](const char* name, double& rate, const char* help) {
    program.add_option(name, rate, help)->check(numberIn(0.0, 100.0))->capture_default_str();
  };
  addRate("--churn-per-s", options->soak.churn_per_s, "For --suite soak: connections that clients end, all together");
  addRate("--strokes-per-s", options->soak.strokes_per_s,
          "For --suite soak: strokes of a finger of each client, one after the other");
  addRate("--waves-per-s", options->soak.waves_per_s, "For --suite soak: waves that each client sends");
  addRate("--boats-per-s", options->soak.boats_per_s, "For --suite soak: boats that each client launches or removes");
  addRate("--level-changes-per-s", options->soak.level_changes_per_s,
          "For --suite soak: changes of a layer's level, rate and packing by each client");
  program.add_option("--seed", options->soak.seed, "For --suite soak: of what the clients do")->capture_default_str();
  CLI::Option* const cert = program
                                .add_option("--tls-cert", options->tls.certificate_file,
                                            "For fanout over TLS: a PEM certificate for 127.0.0.1")
                                ->check(CLI::ExistingFile);
  CLI::Option* const key =
      program.add_option("--tls-key", options->tls.key_file, "Its private key")->check(CLI::ExistingFile);
  cert->needs(key);
  key->needs(cert);
  addJson(program, options->json_file);
  const auto flags_only = [] { return core::Result<void>(); };
  return {{&program, [options] { return bench(*options); }, flags_only}};
}

}  // namespace
}  // namespace spindrift::cli

int main(int argc, char** argv) {
  return spindrift::cli::runProgram(
      "spindrift-bench", "Time the passes of a step, the stream's codecs on real frames, and a crowd of clients",
      spindrift::cli::addOptions, argc, argv);
}
