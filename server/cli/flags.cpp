#include "commands.h"
#include "forms.h"

namespace spindrift::cli {

void addDevice(CLI::App& command, std::string& device) {
  command.add_option("--device", device, "auto, software, or a device from `info`: its number, DRM file or UUID")
      ->check(isText())
      ->capture_default_str();
}

void addFidelity(CLI::App& command, std::string& fidelity) {
  command.add_option("--fidelity", fidelity, "Fidelity of all scenes, in place of the one in their files")
      ->check(CLI::IsMember({"draft", "balanced", "fine", "reference"}));
}

void addJson(CLI::App& command, std::string& file) {
  command.add_option("--json", file, "Write JSON to this file, - = standard output")->check(isOutputFile());
}

}  // namespace spindrift::cli
