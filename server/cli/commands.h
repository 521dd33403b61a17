// The program's commands and their options; main() parses the flags. Each command returns the exit code: 0 success, 1 a
// check failed, 2 bad usage or input, 3 no usable device.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/study_suites/suites.h>

namespace spindrift::cli {

struct ServeOptions {
  std::string scene = "harbor";
  std::vector<std::string> rooms;  ///< NAME=SCENE
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;
  std::string fidelity;  ///< replaces the fidelity of the scenes; empty: theirs
  std::string device = "auto";
  std::string web_root;       ///< empty: searched beside the program
  std::string shader_folder;  ///< empty: the embedded shaders
  std::size_t thread_count = 1;
  double address_session_share = 0.5;  ///< share of the sessions that one address may hold
  std::size_t max_room_count = 8;
  std::string token_file;            ///< empty: SPINDRIFT_TOKENS in the environment, if set
  std::string guest_role;            ///< "none", or a role; empty: operator without tokens, viewer with tokens
  std::vector<std::string> origins;  ///< additional allowed Origins; "*" = any
  double grace_s = 20.0;             ///< how long the boat of a lost connection is kept
  std::string record_folder;         ///< folder for the logs of the rooms; empty: no logs
  std::uint32_t hash_interval_ticks = 60;
};
int serve(const ServeOptions& options);

struct InfoOptions {
  std::string json_file;  ///< "-" = standard output
  bool parameters = false;
};
int info(const InfoOptions& options);

struct CheckOptions {
  std::vector<std::string> scenes;
  std::string fidelity;  ///< as in ServeOptions
};
int check(const CheckOptions& options);

struct BenchOptions {
  std::string suite = "all";  ///< step, codec, fanout; all: step and codec
  std::string scene = "harbor";
  std::string fidelity;  ///< as in ServeOptions
  std::string device = "auto";
  std::string json_file;
  double seconds = 2.0;  ///< measured time per case
};
int bench(const BenchOptions& options);

struct StudyOptions : study_suites::SuiteOptions {
  std::string suite = "accuracy";
  std::string device = "auto";
  std::string json_file;
  std::string plot_folder;   ///< folder for the results as SUITE.json, for the charts; empty: none
  std::string journal_file;  ///< file that keeps finished cases, which are not run again; empty: none
};
int study(const StudyOptions& options);

struct ReplayOptions {
  std::string file;
  std::string device = "auto";
  std::string json_file;
};
int replay(const ReplayOptions& options);

struct ScriptOptions {
  std::string url = "ws://127.0.0.1:8080";
  std::string file;
  std::string json_file;
};
int script(const ScriptOptions& options);

/// Prints the error's line on standard error and returns its exit code.
int fail(const core::Error& error);

}  // namespace spindrift::cli
