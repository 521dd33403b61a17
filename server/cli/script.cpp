#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/script/junit.h>
#include <spindrift/script/script.h>

#include "commands.h"
#include "forms.h"

namespace spindrift::cli {
namespace {

constexpr std::int64_t kSeedMax = std::int64_t{1} << 53;  // every number up to it is exact in JSON

struct ScriptOptions {
  std::string url = "ws://127.0.0.1:8080";
  std::string ca_file;
  std::string file;
  std::string json_file;
  std::string junit_file;
  std::optional<std::uint64_t> seed;
};

void print(const script::ScriptReport& report) {
  for (const script::StepReport& step : report.steps) {
    fmt::print("{} {:>3} {:<10} {:<22} {}{}\n", step.passed ? "ok    " : "FAILED", step.index, step.client, step.what,
               step.detail, step.note.empty() ? "" : "  (" + step.note + ")");
  }
  const int left_count = report.step_count - static_cast<int>(report.steps.size());
  if (left_count > 0) fmt::print("{} steps were not run\n", left_count);
  for (const script::ClientReport& client : report.clients) {
    fmt::print("{}: {} answers, p50 {:.1f} ms, p99 {:.1f} ms; {:.1f} kB", client.name, client.answer_count,
               client.answer_p50_ms, client.answer_p99_ms, static_cast<double>(client.received_bytes) / 1e3);
    for (const script::ClientReport::Layer& layer : client.layers) {
      fmt::print("; {} {} frames, longest gap {:.3f} s", layer.name, layer.frame_count, layer.longest_gap_s);
    }
    fmt::print("\n");
  }
  if (!report.held) return;
  const script::HeldReport& held = *report.held;
  fmt::print("{} ticks, {:.3f} s, seed {}: state hash {}\n", held.tick_count, held.made_s,
             held.seed == 0 ? "of the scene" : std::to_string(held.seed),
             held.state_hash ? script::hashText(*held.state_hash) : "unknown");
  if (held.recovered_count > 0)
    fmt::print("the watchdog put the water back {} times: another run may have another hash\n", held.recovered_count);
}

boost::json::object toJson(const script::ScriptReport& report) {
  boost::json::array steps;
  for (const script::StepReport& step : report.steps) {
    steps.push_back(boost::json::object{{"index", step.index},
                                        {"client", step.client},
                                        {"what", step.what},
                                        {"note", step.note},
                                        {"passed", step.passed},
                                        {"detail", step.detail},
                                        {"took_s", step.took_s}});
  }
  boost::json::array clients;
  for (const script::ClientReport& client : report.clients) {
    boost::json::array layers;
    for (const script::ClientReport::Layer& layer : client.layers) {
      layers.push_back(boost::json::object{{"layer", layer.name},
                                           {"frame_count", layer.frame_count},
                                           {"state_count", layer.state_count},
                                           {"longest_gap_s", layer.longest_gap_s}});
    }
    clients.push_back(boost::json::object{{"name", client.name},
                                          {"received_bytes", client.received_bytes},
                                          {"malformed_count", client.malformed_count},
                                          {"layers", std::move(layers)},
                                          {"answer_count", client.answer_count},
                                          {"answer_p50_ms", client.answer_p50_ms},
                                          {"answer_p99_ms", client.answer_p99_ms}});
  }
  boost::json::object out{{"passed", report.passed()},
                          {"step_count", report.step_count},
                          {"steps", std::move(steps)},
                          {"clients", std::move(clients)}};
  if (report.held) {
    const script::HeldReport& held = *report.held;
    out["state_hash"] = held.state_hash ? boost::json::value(script::hashText(*held.state_hash)) : nullptr;
    out["seed"] = held.seed;
    out["tick_count"] = held.tick_count;
    out["made_s"] = held.made_s;
    out["recovered_count"] = held.recovered_count;
  }
  return out;
}

int script(const ScriptOptions& options) {
  const auto url = net::ClientUrl::parse(options.url);
  if (!url) return fail(url.error());
  auto loaded = script::loadScript(options.file);
  if (!loaded) return fail(loaded.error());
  if (options.seed && !loaded->hold_clock())
    return fail(core::invalid("--seed: " + options.file + " does not hold the clock: add hold_clock: true to it"));
  if (options.seed) loaded->set_seed(*options.seed);
  const script::ScriptReport report = script::runScript(*loaded, *url, options.ca_file);
  if (options.json_file != "-" && options.junit_file != "-") print(report);
  if (!options.junit_file.empty()) {
    const std::string name = std::filesystem::path(options.file).stem().string();
    if (auto written = writeText(options.junit_file, script::toJunit(report, name), "--junit"); !written)
      return fail(written.error());
  }
  if (auto written = writeJson(options.json_file, toJson(report)); !written) return fail(written.error());
  return report.passed() ? 0 : core::exitCode(core::ErrorCode::kCheckFailed);
}

}  // namespace

ProgramCommand addScript(CLI::App& program) {
  const auto options = std::make_shared<ScriptOptions>();
  CLI::App* command = program.add_subcommand("script", "Run scripted clients against a server and check what they see");
  command->add_option("file", options->file, "The script, a .textproto of spindrift.v1.Script")->required();
  command->add_option("--url", options->url, "The server, ws://HOST:PORT or wss://HOST:PORT")
      ->check(isUrl())
      ->capture_default_str();
  command
      ->add_option("--tls-ca", options->ca_file,
                   "For wss://: PEM file with authorities to trust beside those of the system")
      ->check(CLI::ExistingFile);
  command->add_option("--seed", options->seed, "Seed of the scene's random numbers, for a script with hold_clock")
      ->check(integerIn(0, kSeedMax));
  command->add_option("--junit", options->junit_file, "Write the steps as a JUnit report to this file")
      ->check(isOutputFile());
  addJson(*command, options->json_file);
  return {command, [options] { return script(*options); }};
}

}  // namespace spindrift::cli
