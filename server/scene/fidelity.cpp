#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <system_error>

#include <spindrift/core/files.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/fields.h>
#include <spindrift/scene/scene_rules.h>
#include <spindrift/textproto/parsed_text.h>

namespace spindrift::scene {
namespace {

/// Factors of a level relative to BALANCED, and its values for fields that the scene leaves out.
struct FidelityScale {
  double wave_scale;      ///< factor on the wave's resolution
  double particle_scale;  ///< factor on particles per length; the spacing is divided by it
  double tick_scale;      ///< factor on the tick rate, and so on the minimum number of steps
  std::uint32_t lattice_count;
  std::uint32_t iterations_count;
  double surface_quantum_m;
};

/// Of kFidelities.
constexpr std::array<FidelityScale, kFidelities.size()> kScales = {{
    {0.5, 0.7, 1.0, 3, 3, 0.002},
    {1.0, 1.0, 1.0, 3, 4, 0.001},
    {1.5, 1.7, 1.0, 5, 4, 0.0005},
    {2.5, 2.2, 2.0, 5, 8, 0.0005},
}};

/// Multiplies a number by `factor`, limited to its range and rounded to an allowed value.
void scaleNumber(google::protobuf::Message& message, const char* name, double factor) {
  if (factor == 1.0) return;
  const auto& field = *message.GetDescriptor()->FindFieldByName(name);
  const v1::ParameterOptions& options = *parameterOptions(field);
  const double step = options.multiple_of() > 0 ? options.multiple_of() : options.step();
  double value = std::round(numberOf(message, field) * factor / step) * step;
  setNumber(message, field, std::clamp(value, options.min(), options.max()));
}

/// Scales the number of cells. The cells of a rectangle have to fit its width, too: a number of cells near the wanted
/// one that fits, or the width is rounded to whole cells. Counts that are multiples of 16 stay so.
void scaleCells(v1::WaveScene& wave, double factor) {
  if (factor == 1.0) return;
  const core::WaveCells before = waveCellsOf(wave);
  constexpr double kMultiple = 16.0;
  constexpr double kNearShare = 0.1;
  constexpr double kLeastCount = 32.0;  // along the longer side, unless the scene has fewer
  constexpr double kRounding = 1e-9;
  const double step = before.count.x % 16 == 0 ? kMultiple : 1.0;
  const double total = static_cast<double>(before.count.total());
  const double most = std::min({double{core::kWaveMaxSideCount} / std::max(before.count.x, before.count.z),
                                std::sqrt(static_cast<double>(core::kWaveMaxCellCount) / total)});
  const double longer = std::max(before.count.x, before.count.z);
  const double least = before.count.x * std::min(1.0, kLeastCount / longer);
  const double wanted = std::max(std::round(before.count.x * factor / step) * step, std::ceil(least - kRounding));
  const double limit = std::max(std::floor(before.count.x * most / step + kRounding) * step, 1.0);
  auto count = static_cast<std::uint32_t>(std::min(wanted, limit));
  if (wave.width_m() > 0.0) {
    const auto fits = [&](std::uint32_t n) {
      return n > 0 && n <= limit &&
             core::widthFits(core::waveCellsOf(n, before.length_m, before.width_m), before.width_m);
    };
    const auto reach = static_cast<std::uint32_t>(kNearShare * count);
    for (std::uint32_t off = 0; off <= reach; ++off) {
      if (!fits(count + off) && !fits(count - off)) continue;
      count = fits(count + off) ? count + off : count - off;
      break;
    }
    wave.set_width_m(core::waveCellsOf(count, before.length_m, before.width_m).width_m);
  }
  wave.set_resolution_count(count);
}

double layersOf(const v1::ParticleScene& particles) {
  return numberOf(particles, *v1::ParticleScene::descriptor()->FindFieldByName("layers_count"));
}

}  // namespace

std::size_t rankOf(v1::Fidelity fidelity) {
  const auto level = std::ranges::find(kFidelities, fidelity);
  return level != kFidelities.end() ? static_cast<std::size_t>(level - kFidelities.begin()) : 1;
}

std::optional<v1::Fidelity> coarserThan(v1::Fidelity fidelity) {
  const std::size_t rank = rankOf(fidelity);
  return rank > 0 ? std::optional(kFidelities[rank - 1]) : std::nullopt;
}

std::optional<v1::Fidelity> finerThan(v1::Fidelity fidelity) {
  const std::size_t rank = rankOf(fidelity) + 1;
  return rank < kFidelities.size() ? std::optional(kFidelities[rank]) : std::nullopt;
}

std::optional<v1::Fidelity> parseFidelity(std::string_view name) {
  std::string upper = "FIDELITY_";
  for (const char c : name) upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  v1::Fidelity fidelity = v1::FIDELITY_UNSPECIFIED;
  if (!v1::Fidelity_Parse(upper, &fidelity) || fidelity == v1::FIDELITY_UNSPECIFIED) return std::nullopt;
  return fidelity;
}

std::string fidelityName(v1::Fidelity fidelity) {
  std::string name = v1::Fidelity_Name(kFidelities[rankOf(fidelity)]).substr(9);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

void applyFidelity(v1::Scene& scene) {
  const FidelityScale& level = kScales[rankOf(scene.fidelity())];
  const bool is_two_way = scene.coupling().mode() == v1::COUPLING_MODE_TWO_WAY;
  scaleNumber(scene, "tick_rate_hz", level.tick_scale);
  if (scene.has_wave()) {
    v1::WaveScene& wave = *scene.mutable_wave();
    // Ripples need their cells; fewer would be an error (sim_setup/surface_tension.cpp).
    scaleCells(wave, wave.surface_tension_npm() > 0.0 ? std::max(1.0, level.wave_scale) : level.wave_scale);
    // At every level: rings of the 9-point stencil are 1.3 to 1.5 times as far off at the same step, as far off at each
    // stencil's own largest step, and carry twice the faces (`spindrift-study --suite accuracy --case round-hump`).
    if (wave.stencil() == v1::STENCIL_UNSPECIFIED) wave.set_stencil(v1::STENCIL_FIVE_POINT);
  }
  if (scene.has_particles()) {
    v1::ParticleScene& particles = *scene.mutable_particles();
    if (is_two_way) {
      scaleNumber(particles, "count", std::pow(level.particle_scale, 3));  // spray fills a volume
    } else if (scene.has_wave()) {
      // A band keeps the number of layers and becomes thinner.
      scaleNumber(particles, "count", std::pow(level.particle_scale, 2));
    } else {
      // Keep the depth; whole layers decide.
      const double layers_count = layersOf(particles);
      scaleNumber(particles, "layers_count", level.particle_scale);
      scaleNumber(particles, "count", std::pow(layersOf(particles) / layers_count, 3));
    }
    if (!particles.has_iterations_count()) particles.set_iterations_count(level.iterations_count);
  }
  if (scene.has_coupling()) {
    v1::CouplingScene& coupling = *scene.mutable_coupling();
    if (is_two_way) scaleNumber(coupling, "droplet_spacing_m", 1 / level.particle_scale);
    if (!coupling.has_lattice_count()) coupling.set_lattice_count(level.lattice_count);
  }
  if (!scene.stream().has_surface_quantum_m()) scene.mutable_stream()->set_surface_quantum_m(level.surface_quantum_m);
}

core::Result<v1::FidelityErrors> loadFidelityErrors(const std::filesystem::path& folder) {
  constexpr std::size_t kMaxBytes = 1 << 16;
  const std::filesystem::path file = folder / kFidelityErrorsFile;
  v1::FidelityErrors out;
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return out;
  const auto text = core::readText(file, kMaxBytes, "a file of errors", "`./dev study --update` writes it");
  if (!text) return text.error();
  if (const textproto::ParsedText parsed(*text, out); parsed.hasErrors())
    return core::invalid(parsed.report(file.string()) + "\n`./dev study --update` writes this file");
  for (const v1::FidelityErrorsOfScene& scene : out.scenes()) {
    const auto& ratios = scene.error_ratios();
    const bool is_valid = ratios.size() == std::ssize(kFidelities) &&
                          std::ranges::all_of(ratios, [](double ratio) { return std::isfinite(ratio) && ratio >= 0; });
    if (!is_valid) {
      return core::invalid(file.string() + ": scene '" + scene.name() + "' needs " +
                           std::to_string(kFidelities.size()) + " errors of 0 or more");
    }
  }
  return out;
}

}  // namespace spindrift::scene
