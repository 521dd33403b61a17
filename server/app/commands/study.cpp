// Tables of what the simulation is worth, printed as they grow and kept in a journal, so that a long run can go on.
#include <cstdio>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "output.h"
#include "study_suites.h"

namespace spindrift::app {

void showProgress(const std::string& text) {
  if (isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\r{}\033[K", text);
  std::fflush(stderr);
}

std::string journalKey(const std::string& suite, const std::string& name, const StudyOptions& options,
                       const gpu::Context& ctx) {
  return fmt::format("{} {} {} {} {}", suite, name, options.quick ? "quick" : "full", SPINDRIFT_VERSION,
                     ctx.device().name);
}

int study(const StudyOptions& options) {
  auto device = gpu::parseDeviceChoice(options.device);
  if (!device) return fail(device.error());
  StudyJournal journal(options.journal_file);
  if (auto usable = journal.check(); !usable) return fail(usable.error());
  auto ctx = gpu::Context::create(*device);
  if (!ctx) return fail(ctx.error());

  std::FILE* out = options.json_file == "-" ? stderr : stdout;
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  const gpu::DeviceInfo& info = (*ctx)->device();
  fmt::print(out, "{}{}; machine {}, {} hardware threads; device {}, {}\n", options.suite,
             options.quick ? ", quick" : "", host, std::thread::hardware_concurrency(), info.name, info.gl_version);
  const auto suite = options.suite == "stability" ? studyStability
                     : options.suite == "trade"   ? studyTrade
                                                  : studyAccuracy;
  auto result = suite(**ctx, options, journal, out);
  if (!result) return fail(result.error());
  fmt::print(out, "{} within bounds, {} missed\n", result->held_count, result->missed_count);
  boost::json::object json = std::move(result->json);
  json["suite"] = options.suite;
  json["quick"] = options.quick;
  json["threads"] = std::thread::hardware_concurrency();
  json["device"] = info.name;
  json["gl_version"] = info.gl_version;
  json["held"] = result->held_count;
  json["missed"] = result->missed_count;
  if (auto written = writeJson(options.json_file, json); !written) return fail(written.error());
  return result->missed_count == 0 ? 0 : 1;
}

}  // namespace spindrift::app
