// spindrift-study: the water against theory and experiment.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include <spindrift/study_suites/suites.h>

#include "commands.h"
#include "forms.h"

namespace spindrift::cli {
namespace {

struct StudyOptions : study_suites::SuiteOptions {
  std::string suite = "accuracy";
  std::string device = "auto";
  std::string json_file;
  std::string plot_folder;   ///< folder for the results as SUITE.json, for the charts; empty: none
  std::string journal_file;  ///< file that keeps finished cases, which are not run again; empty: none
};

/// Creates the folder before hours of measuring. kUnavailable where that fails.
core::Result<void> prepareFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return {};
  return core::Error{core::ErrorCode::kUnavailable,
                     "--plot '" + folder + "': cannot be created: " + error.message() + ": choose another folder"};
}

int study(const StudyOptions& options) {
  auto device = gpu::parseDeviceChoice(options.device);
  if (!device) return fail(device.error());
  study_suites::StudyJournal journal(options.journal_file);
  if (auto usable = journal.check(); !usable) return fail(usable.error());
  if (!options.plot_folder.empty()) {
    if (auto prepared = prepareFolder(options.plot_folder); !prepared) return fail(prepared.error());
  }
  auto ctx = gpu::Context::create(*device);
  if (!ctx) return fail(ctx.error());

  std::FILE* out = options.json_file == "-" ? stderr : stdout;
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  const gpu::DeviceInfo& info = (*ctx)->device();
  fmt::print(out, "{}{}; machine {}, {} hardware threads; device {}, {}\n", options.suite,
             options.quick ? ", quick" : "", host, std::thread::hardware_concurrency(), info.name, info.gl_version);
  const auto suite = options.suite == "stability" ? study_suites::studyStability
                     : options.suite == "trade"   ? study_suites::studyTrade
                                                  : study_suites::studyAccuracy;
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
  if (!options.plot_folder.empty()) {
    const auto file = std::filesystem::path(options.plot_folder) / (options.suite + ".json");
    if (auto written = writeJson(file, json, "--plot"); !written) return fail(written.error());
  }
  return result->missed_count == 0 ? 0 : 1;
}

std::vector<ProgramCommand> addOptions(CLI::App& program) {
  const auto options = std::make_shared<StudyOptions>();
  program.add_option("--suite", options->suite, "What to study")
      ->check(CLI::IsMember({"accuracy", "stability", "trade"}))
      ->capture_default_str();
  program.add_option("--case", options->only,
                     "One case of the accuracy suite, the sweeps of the stability suite whose name contains "
                     "this, or one scene of the trade suite, known, or cost");
  addDevice(program, options->device);
  program.add_flag("--quick", options->quick, "Shorter runs, a few minutes in all");
  program
      .add_option("--journal", options->journal_file,
                  "Save finished cases in this file; an interrupted study continues from it")
      ->check(isOutputFile());
  program.add_option("--plot", options->plot_folder,
                     "Write the results into this folder as SUITE.json, from which ./dev charts draws charts");
  addJson(program, options->json_file);
  const auto flags_only = [] { return core::Result<void>(); };
  return {{&program, [options] { return study(*options); }, flags_only}};
}

}  // namespace
}  // namespace spindrift::cli

int main(int argc, char** argv) {
  return spindrift::cli::runProgram("spindrift-study", "Measure the simulation against theory and experiment",
                                    spindrift::cli::addOptions, argc, argv);
}
