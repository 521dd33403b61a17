#include <algorithm>
#include <chrono>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <spindrift/bench/levels.h>

namespace spindrift::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Words = std::array<std::uint32_t, 3>;

/// Budget of each level, from proto/README.md [Mbit/s]; 0: no limit.
constexpr std::array<double, core::kLevelCount> kBudgets_mbitps{4.0, 24.0, 95.0, 0.0};

std::vector<Words> particlesOf(const core::ParticleView& particles) {
  std::vector<Words> out(particles.count);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {particles.words[3 * i], particles.words[3 * i + 1], particles.words[3 * i + 2]};
  std::ranges::sort(out);
  return out;
}

std::size_t bytesOf(const codec::EncodedFrame& encoded) {
  const core::SharedBytes& sent = encoded.delta ? encoded.delta : encoded.keyframe;
  return sent ? sent->size() : 0;
}

}  // namespace

sim::FrameRequest LevelMeter::request(const core::Scene& scene) {
  const sim::LayerRequest layers{.surface = scene.wave.has_value(),
                                 .particles = scene.particles.has_value(),
                                 .foam = scene.foam.has_value() && scene.foam->surface};
  sim::FrameRequest out;
  out.levels.fill(layers);
  out.floaters = scene.floaters.has_value();
  return out;
}

void LevelMeter::add(const core::FrameView& frame) {
  counts_ = frame.reduced_counts;
  const std::uint32_t level_count = std::max(counts_.planes, counts_.particles);
  std::map<std::pair<v1::Layer, core::Level>, double> encoded_bytes;  // a level that downsamples nothing is not encoded
  for (const core::Level level : core::kLevels) {
    LevelCost& row = levels_[indexOf(level)];
    if (!isSent(level, level_count)) continue;
    const double since_last_s = static_cast<double>(frame_count_ - row.last_frame) / frame_rate_hz_;
    if (row.frame_count > 0 && !core::takesFrameAfter(level, since_last_s)) continue;
    row.last_frame = frame_count_;
    const auto begin = Clock::now();
    const auto bytes = [&](v1::Layer layer) {
      const core::Level effective =
          core::effectiveLevel(level, codec::reducedCountOf({layer, v1::PACKING_PACKED}, counts_));
      const core::LevelView& view = frame.at(effective);
      if (layer == v1::LAYER_SURFACE && view.surface) row.surface = view.surface->count;
      if (layer == v1::LAYER_PARTICLES && view.particles) row.particle_sum += view.particles->count;
      const auto [known, is_new] = encoded_bytes.try_emplace({layer, effective}, 0.0);
      if (is_new) {
        known->second =
            static_cast<double>(bytesOf(encoder_.encode({layer, v1::PACKING_PACKED}, frame, effective, false)));
      }
      return known->second;
    };
    const double surface_bytes = bytes(v1::LAYER_SURFACE);
    const double particle_bytes = bytes(v1::LAYER_PARTICLES);
    const double foam_bytes = bytes(v1::LAYER_FOAM);
    row.encode_ms += std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    ++row.frame_count;
    row.surface_bytes += surface_bytes;
    row.particle_bytes += particle_bytes;
    row.foam_bytes += foam_bytes;
  }
  if (frame.at(core::Level::kFull).particles && counts_.particles > 0 && frame_count_ % 10 == 0) addParts(frame);
  ++frame_count_;
}

/// The alternative: each level sends only what the levels below it lack, at the full level's quantum, so that all
/// together are the full level.
void LevelMeter::addParts(const core::FrameView& frame) {
  std::vector<Words> before;
  double bits = 0.0;
  for (const core::Level level : core::kLevels) {
    if (!isSent(level, counts_.particles)) continue;
    if (!frame.at(level).particles) return;
    const std::vector<Words> now = particlesOf(*frame.at(level).particles);
    std::vector<Words> added;
    std::ranges::set_difference(now, before, std::back_inserter(added));
    core::ParticleView particles = *frame.at(core::Level::kFull).particles;
    particles.count = static_cast<std::uint32_t>(added.size());
    particles.words = std::span(added.data()->data(), 3 * added.size());
    core::FrameView part;
    part.at(core::Level::kFull).particles = particles;
    bits += 8.0 * static_cast<double>(bytesOf(codec::FrameEncoder().encode({v1::LAYER_PARTICLES, v1::PACKING_PACKED},
                                                                           part, core::Level::kFull, true)));
    part_bits_[indexOf(level)] += bits;
    part_counts_[indexOf(level)] += static_cast<double>(now.size());
    before = now;
  }
}

boost::json::array LevelMeter::print(std::FILE* out) const {
  boost::json::array json;
  if (std::max(counts_.planes, counts_.particles) == 0) {
    fmt::print(out, "levels: one, the scene has nothing to leave out\n");
    return json;
  }
  fmt::print(out, "{:<8} {:>8} {:>10} {:>5} {:>9} {:>10} {:>6} {:>8} {:>8} {:>10} {:>15} {:>14}\n", "level", "surface",
             "particles", "Hz", "surface", "particles", "foam", "Mbit/s", "at most", "encode ms", "bits/particle",
             "if they added");
  for (const core::Level level : core::kLevels) {
    const std::size_t k = indexOf(level);
    const LevelCost& row = levels_[k];
    if (row.frame_count == 0) continue;
    const auto frames = static_cast<double>(row.frame_count);
    const double rate_hz = frame_rate_hz_ * frames / static_cast<double>(frame_count_);
    const auto mbitps = [&](double bytes) { return bytes / frames * 8e-6 * rate_hz; };
    const double sum_mbitps = mbitps(row.surface_bytes + row.particle_bytes + row.foam_bytes);
    const double particle_count = row.particle_sum / frames;
    const double bits = row.particle_sum > 0 ? 8 * row.particle_bytes / row.particle_sum : 0.0;
    const double part_bits = part_counts_[k] > 0 ? part_bits_[k] / part_counts_[k] : 0.0;
    // The budget of the lowest level whose limits the row keeps: kFull of a small scene fits one of a reduced level.
    double budget_mbitps = 0.0;
    for (std::size_t b = core::kLevelCount; b-- > 0;) {
      const core::LevelBudget& budget = core::kLevelBudgets[b];
      const bool surface_fits = core::surfaceSamples(row.surface, core::kLevels[b]) == row.surface;
      if (surface_fits && particle_count <= budget.particle_count) budget_mbitps = kBudgets_mbitps[b];
    }
    fmt::print(out,
               "{:<8} {:>8} {:>10.0f} {:>5.0f} {:>9.2f} {:>10.2f} {:>6.2f} {:>8.2f} {:>8} {:>10.3f} {:>15.2f} {:>14}\n",
               codec::nameOf(level), fmt::format("{}x{}", row.surface.x, row.surface.z), particle_count, rate_hz,
               mbitps(row.surface_bytes), mbitps(row.particle_bytes), mbitps(row.foam_bytes), sum_mbitps,
               budget_mbitps > 0 ? fmt::format("{:.0f}", budget_mbitps) : std::string("-"), row.encode_ms / frames,
               bits, part_bits > 0 ? fmt::format("{:.2f}", part_bits) : std::string("-"));
    json.push_back({{"level", codec::nameOf(level)},
                    {"resolution_count", row.surface.x},
                    {"count_z", row.surface.z},
                    {"particle_count", particle_count},
                    {"rate_hz", rate_hz},
                    {"mbit_per_s", sum_mbitps},
                    {"budget_mbit_per_s", budget_mbitps},
                    {"encode_ms", row.encode_ms / frames},
                    {"particle_bits", bits},
                    {"particle_bits_if_added", part_bits}});
  }
  return json;
}

}  // namespace spindrift::bench
