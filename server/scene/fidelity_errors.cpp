#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>

#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/text_format.h>

#include <spindrift/core/files.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/fidelity_errors.h>

namespace spindrift::scene {

using core::Error;
using core::ErrorCode;

core::Result<v1::FidelityErrors> loadFidelityErrors(const std::filesystem::path& folder) {
  constexpr std::size_t kMaxBytes = 1 << 16;
  const std::filesystem::path file = folder / kFidelityErrorsFile;
  v1::FidelityErrors out;
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return out;
  const auto text = core::readText(file, kMaxBytes, "a file of errors", "`./dev study --update` writes it");
  if (!text) return text.error();
  const google::protobuf::LogSilencer silencer;
  if (!google::protobuf::TextFormat::ParseFromString(*text, &out)) {
    return Error{
        ErrorCode::kInvalidInput,
        file.string() + " is not a spindrift.v1.FidelityErrors in text form: `./dev study --update` writes it"};
  }
  for (const v1::FidelityErrorsOfScene& scene : out.scenes()) {
    const auto& ratios = scene.error_ratios();
    const bool is_valid = ratios.size() == std::ssize(kFidelities) &&
                          std::ranges::all_of(ratios, [](double ratio) { return std::isfinite(ratio) && ratio >= 0; });
    if (!is_valid) {
      return Error{ErrorCode::kInvalidInput, file.string() + ": scene '" + scene.name() + "' needs " +
                                                 std::to_string(kFidelities.size()) + " errors of 0 or more"};
    }
  }
  return out;
}

}  // namespace spindrift::scene
