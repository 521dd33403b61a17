// spindrift: the program. Parses the flags and calls the commands.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/version.h>

#include "commands.h"

namespace {

constexpr int kUsageError = 2;

/// For every command that runs scenes.
void addFidelity(CLI::App& command, std::string& fidelity) {
  command.add_option("--fidelity", fidelity, "How finely scenes are simulated, whatever they say themselves")
      ->check(CLI::IsMember({"draft", "balanced", "fine", "reference"}));
}

void setUpLogging(const std::string& level) {
  // Standard output is for results (--json -, the address); the log goes to standard error.
  auto logger = spdlog::stderr_color_mt("spindrift");
  logger->set_pattern("%H:%M:%S.%e %^%l%$ %v");
  logger->set_level(spdlog::level::from_str(level));
  spdlog::set_default_logger(std::move(logger));
}

int run(int argc, char** argv) {
  using namespace spindrift::cli;
  CLI::App cli{
      "Spindrift: a headless water server. It simulates coupled particles and waves on a GPU and streams them to "
      "browsers."};
  cli.name("spindrift");
  cli.set_version_flag("--version", std::string(spindrift::core::nameAndVersion()));
  cli.require_subcommand(1);
  std::string log_level = "info";
  cli.add_option("--log-level", log_level, "Level of the log on standard error")
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
  cli.fallthrough();

  ServeOptions serve_options;
  CLI::App* serve_command = cli.add_subcommand("serve", "Simulate and serve rooms until interrupted");
  serve_command
      ->add_option("--scene", serve_options.scene,
                   "Scene of the room 'main': a .textproto file or the name of a shipped scene")
      ->capture_default_str();
  addFidelity(*serve_command, serve_options.fidelity);
  serve_command->add_option("--room", serve_options.rooms, "An additional room, NAME=SCENE; may be repeated");
  serve_command->add_option("--address", serve_options.address, "Address to listen on")->capture_default_str();
  serve_command->add_option("--port", serve_options.port, "Port to listen on; 0 = any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  serve_command->add_option("--device", serve_options.device, "auto, software, or a device number from `info`")
      ->capture_default_str();
  serve_command->add_option("--web-root", serve_options.web_root,
                            "Folder of the built web client (default: next to the program)");
  serve_command
      ->add_option("--shader-dir", serve_options.shader_folder,
                   "For shader development: read shaders from this folder (shaders/) and reload changed files")
      ->check(CLI::ExistingDirectory);
  serve_command->add_option("--threads", serve_options.thread_count, "I/O threads")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();

  serve_command
      ->add_option("--address-share", serve_options.address_session_share,
                   "Share of the sessions that one address may use; 1 behind a proxy")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  serve_command
      ->add_option("--max-rooms", serve_options.max_room_count, "Maximum number of rooms, including those opened later")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  serve_command->add_option("--tokens", serve_options.token_file,
                            "File with lines ROLE TOKEN (default: the environment variable SPINDRIFT_TOKENS)");
  serve_command
      ->add_option("--guests", serve_options.guest_role,
                   "Role of clients without a token (default: operator without tokens, viewer with tokens)")
      ->check(CLI::IsMember({"none", "viewer", "player", "operator"}));
  serve_command->add_option("--origin", serve_options.origins,
                            "Additional allowed Origin of pages, https://HOST; * = any; may be repeated");
  serve_command
      ->add_option("--grace", serve_options.grace_s,
                   "Seconds for which a boat keeps its owner after the connection was lost")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  serve_command->add_option("--record", serve_options.record_folder, "Write the log of every room into this folder");
  serve_command
      ->add_option("--hash-every", serve_options.hash_interval_ticks,
                   "Interval of the state hashes in the log, in ticks")
      ->check(CLI::Range(1, 36000))
      ->capture_default_str();

  ReplayOptions replay_options;
  CLI::App* replay_command = cli.add_subcommand("replay", "Run a room's log again and compare the states");
  replay_command->add_option("file", replay_options.file, "A log that serve --record wrote")->required();
  replay_command->add_option("--device", replay_options.device, "auto, software, or a device number from `info`")
      ->capture_default_str();
  replay_command->add_option("--json", replay_options.json_file, "Write JSON to this file, - = standard output");

  ScriptOptions script_options;
  CLI::App* script_command =
      cli.add_subcommand("script", "Run scripted clients against a server and check what they see");
  script_command->add_option("file", script_options.file, "The script, a .textproto of spindrift.v1.Script")
      ->required();
  script_command->add_option("--url", script_options.url, "The server, ws://HOST:PORT")->capture_default_str();
  script_command->add_option("--json", script_options.json_file, "Write JSON to this file, - = standard output");

  InfoOptions info_options;
  CLI::App* info_command =
      cli.add_subcommand("info", "Devices, OpenGL and driver versions, limits, versions of program and wire");
  info_command->add_option("--json", info_options.json_file, "Write JSON to this file, - = standard output");
  info_command->add_flag("--parameters", info_options.parameters,
                         "Print the reference of all scene parameters instead, as Markdown");

  CheckOptions check_options;
  CLI::App* check_command = cli.add_subcommand("check", "Check scenes and print the derived quantities");
  check_command->add_option("scene", check_options.scenes, "Scene files or names of shipped scenes")->required();

  addFidelity(*check_command, check_options.fidelity);

  BenchOptions bench_options;
  CLI::App* bench_command = cli.add_subcommand(
      "bench", "Time the passes of a step, the stream's codecs on real frames, and a crowd of clients");
  bench_command->add_option("--suite", bench_options.suite, "What to time")
      ->check(CLI::IsMember({"all", "step", "codec", "fanout"}))
      ->capture_default_str();
  bench_command->add_option("--scene", bench_options.scene, "Scene file or name of a shipped scene")
      ->capture_default_str();
  addFidelity(*bench_command, bench_options.fidelity);
  bench_command->add_option("--device", bench_options.device, "auto, software, or a device number from `info`")
      ->capture_default_str();
  bench_command->add_option("--seconds", bench_options.seconds, "Measured time per case")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  bench_command->add_option("--json", bench_options.json_file, "Write JSON to this file, - = standard output");

  StudyOptions study_options;
  CLI::App* study_command = cli.add_subcommand("study", "Measure the simulation against theory and experiment");
  study_command->add_option("--suite", study_options.suite, "What to study")
      ->check(CLI::IsMember({"accuracy", "stability", "trade"}))
      ->capture_default_str();
  study_command->add_option("--case", study_options.only,
                            "One case of the accuracy suite, the sweeps of the stability suite whose name contains "
                            "this, or one scene of the trade suite");
  study_command->add_option("--device", study_options.device, "auto, software, or a device number from `info`")
      ->capture_default_str();
  study_command->add_flag("--quick", study_options.quick, "Shorter runs, a few minutes in all");
  study_command->add_option("--journal", study_options.journal_file,
                            "Save finished cases in this file; an interrupted study continues from it");
  study_command->add_option("--plot", study_options.plot_folder,
                            "Write the results into this folder as SUITE.json, from which ./dev charts draws charts");
  study_command->add_option("--json", study_options.json_file, "Write JSON to this file, - = standard output");

  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return cli.exit(error);  // --help, --version
    // CLI11 reports a missing subcommand before it reports unknown words in its place.
    const std::vector<std::string> unknown =
        cli.get_subcommands().empty() ? cli.remaining() : std::vector<std::string>{};
    const std::string what = unknown.empty() ? error.what() : "there is no command or flag '" + unknown.front() + "'";
    std::fprintf(stderr, "spindrift: %s; run 'spindrift --help'\n", what.c_str());
    return kUsageError;
  }
  setUpLogging(log_level);
  if (serve_command->parsed()) return serve(serve_options);
  if (script_command->parsed()) return script(script_options);
  if (replay_command->parsed()) return replay(replay_options);
  if (info_command->parsed()) return info(info_options);
  if (check_command->parsed()) return check(check_options);
  if (bench_command->parsed()) return bench(bench_options);
  if (study_command->parsed()) return study(study_options);
  return kUsageError;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "spindrift: unexpected: %s\n", error.what());
    return 1;
  }
}
