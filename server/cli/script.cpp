#include <memory>
#include <string>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/script/script.h>

#include "commands.h"
#include "forms.h"

namespace spindrift::cli {
namespace {

struct ScriptOptions {
  std::string url = "ws://127.0.0.1:8080";
  std::string ca_file;
  std::string file;
  std::string json_file;
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
  return {{"passed", report.passed()},
          {"step_count", report.step_count},
          {"steps", std::move(steps)},
          {"clients", std::move(clients)}};
}

int script(const ScriptOptions& options) {
  const auto url = net::ClientUrl::parse(options.url);
  if (!url) return fail(url.error());
  const auto loaded = script::loadScript(options.file);
  if (!loaded) return fail(loaded.error());
  const script::ScriptReport report = script::runScript(*loaded, *url, options.ca_file);
  if (options.json_file != "-") print(report);
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
  addJson(*command, options->json_file);
  return {command, [options] { return script(*options); }};
}

}  // namespace spindrift::cli
