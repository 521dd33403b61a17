#include <algorithm>
#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/codec/stream.h>
#include <spindrift/script/record_room.h>

#include "commands.h"
#include "forms.h"

namespace spindrift::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".mcap";

struct RecordOptions {
  std::string url = "ws://127.0.0.1:8080";
  std::string room;
  std::string ca_file;
  std::string token_variable = "SPINDRIFT_TOKEN";
  std::string file;
  double duration_s = 3600.0;
  std::uint64_t max_mib = 4096;
  std::uint64_t file_max_mib = 0;
  std::vector<std::string> layers;
  std::string level = "full";
  bool is_plain = false;
  bool is_for_foxglove = false;
  std::string json_file;
};

/// Names of the layers, in the order of the wire.
std::vector<std::pair<std::string, v1::Layer>> layerNames() {
  return {{"surface", v1::LAYER_SURFACE}, {"particles", v1::LAYER_PARTICLES},     {"bodies", v1::LAYER_BODIES},
          {"foam", v1::LAYER_FOAM},       {"diagnostics", v1::LAYER_DIAGNOSTICS}, {"floaters", v1::LAYER_FLOATERS}};
}

std::vector<std::string> namesOf(const auto& pairs) {
  std::vector<std::string> out;
  for (const auto& [name, value] : pairs) out.push_back(name);
  return out;
}

volatile std::sig_atomic_t is_interrupted = 0;

core::Result<script::RecordRoomOptions> optionsOf(const RecordOptions& options) {
  auto url = net::ClientUrl::parse(options.url);
  if (!url) return url.error();
  const fs::path file(options.file);
  if (file.extension() != kEnding || file.stem().empty())
    return core::invalid("-o " + options.file + ": name a file that ends with .mcap");
  constexpr std::uint64_t kMiB = 1u << 20;
  script::RecordRoomOptions out{.url = *std::move(url),
                                .room = options.room,
                                .ca_file = options.ca_file,
                                .token_variable = options.token_variable,
                                .layers = {},
                                .recorder = {}};
  for (const auto& [name, layer] : layerNames()) {
    if (options.layers.empty() || std::ranges::find(options.layers, name) != options.layers.end())
      out.layers.push_back(layer);
  }
  out.packing = options.is_plain || options.is_for_foxglove ? v1::PACKING_PLAIN : v1::PACKING_PACKED;
  for (const core::Level level : core::kLevels) {
    if (codec::nameOf(level) == options.level) out.level = codec::toWire(level);
  }
  out.recorder.files = {
      .folder = file.has_parent_path() ? file.parent_path() : fs::path("."),
      .name = file.stem().string(),
      .file_max_bytes = options.file_max_mib > 0 ? std::optional(options.file_max_mib * kMiB) : std::nullopt,
      .max_bytes = options.max_mib * kMiB};
  out.recorder.max_duration =
      std::chrono::milliseconds(static_cast<std::chrono::milliseconds::rep>(1e3 * options.duration_s));
  out.recorder.is_for_foxglove = options.is_for_foxglove;
  if (auto checked = recording::checkBounds(out.recorder.files); !checked) return checked.error();
  return out;
}

int record(const RecordOptions& options) {
  const auto wanted = optionsOf(options);
  if (!wanted) return fail(wanted.error());
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { is_interrupted = 1; });
  std::signal(SIGXFSZ, SIG_IGN);  // a limit for files is an error that can be told
  const auto report = script::recordRoom(*wanted, [] { return is_interrupted != 0; });
  if (!report) return fail(report.error());
  const auto& counts = report->counts;
  if (options.json_file != "-") {
    fmt::print("{}: {} messages, {:.1f} MB", report->end, counts.message_count,
               static_cast<double>(counts.written_bytes) / 1e6);
    for (const std::string& file : report->files) fmt::print("\n{}", (wanted->recorder.files.folder / file).string());
    fmt::print("\n");
  }
  boost::json::array files;
  for (const std::string& file : report->files) files.emplace_back(file);
  const boost::json::object json{{"ended", report->end},
                                 {"files", std::move(files)},
                                 {"message_count", counts.message_count},
                                 {"skipped_count", counts.skipped_count},
                                 {"malformed_count", counts.malformed_count},
                                 {"written_bytes", counts.written_bytes}};
  if (auto written = writeJson(options.json_file, json); !written) return fail(written.error());
  return 0;
}

}  // namespace

ProgramCommand addRecord(CLI::App& program) {
  const auto options = std::make_shared<RecordOptions>();
  CLI::App* command = program.add_subcommand(
      "record", "Record a room of a server as an MCAP file, which Foxglove and other programs open");
  command->add_option("--url", options->url, "The server, ws://HOST:PORT or wss://HOST:PORT")
      ->check(isUrl())
      ->capture_default_str();
  command->add_option("--room", options->room, "Name of the room (default: that of the URL, or the server's)")
      ->check(isNotEmpty());
  command->add_option("-o,--output", options->file, "The file, NAME.mcap; one that exists is not replaced")
      ->check(isOutputFile())
      ->required();
  command->add_option("--for-s,--for", options->duration_s, "Seconds after which the recording ends")
      ->check(numberIn(0.1, 604'800.0))
      ->capture_default_str();
  command->add_option("--max-mib", options->max_mib, "MiB of all files after which it ends")
      ->check(integerIn(1, 1'048'576))
      ->capture_default_str();
  command
      ->add_option("--file-mib", options->file_max_mib,
                   "MiB after which a new file begins: NAME_0001.mcap, NAME_0002.mcap, … (default: one file)")
      ->check(integerIn(1, 1'048'576));
  command->add_option("--layers", options->layers, "Layers to record, with ',' between them (default: all)")
      ->check(CLI::IsMember(namesOf(layerNames())))
      ->delimiter(',');
  command->add_option("--level", options->level, "Level of detail")
      ->check(CLI::IsMember({"full", "fine", "medium", "coarse"}))
      ->capture_default_str();
  command->add_flag("--plain", options->is_plain, "Layers in plain packing: larger, and each frame can be read alone");
  command->add_flag("--foxglove", options->is_for_foxglove,
                    "Also record messages of Foxglove's schemas, which it draws; the layers are plain then");
  command->add_option("--token-env", options->token_variable, "Environment variable with the token, if there is one")
      ->check(isNotEmpty())
      ->capture_default_str();
  command
      ->add_option("--tls-ca", options->ca_file,
                   "For wss://: PEM file with authorities to trust beside those of the system")
      ->check(CLI::ExistingFile);
  addJson(*command, options->json_file);
  return {command, [options] { return record(*options); }};
}

}  // namespace spindrift::cli
