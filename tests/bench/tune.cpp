#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/bench/tune.h>
#include <spindrift/core/files.h>
#include <spindrift/gpu/context.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim/water_sim.h>

namespace spindrift::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// No block starts after it. Making a scene and a block take less than the rest of three minutes.
constexpr std::chrono::seconds kLimit{165};
constexpr int kWarmUpTicks = 3;
constexpr int kPairs = 8;
constexpr double kBlock_s = 0.03;
constexpr int kBlockMaxTicks = 256;
/// A change is kept if it is faster by more than this, and by so many errors of the mean.
constexpr double kLeastGain = 0.01;
constexpr double kErrors = 3.0;

struct TunedScene {
  std::string name;
  core::Scene scene;
  std::vector<std::string_view> fields;  ///< what their names begin with
};

core::Result<std::vector<TunedScene>> tunedScenes() {
  std::vector<TunedScene> out = {{"8,192 particles", {}, {"particle", "scan", "wave", "reduce"}},
                                 {"65,536 particles", {}, {"particle", "scan", "reduce"}},
                                 {"sea", {}, {"wave", "reduce", "dispersion"}}};
  for (TunedScene& each : out) {
    const auto file = core::findScene(each.name == "sea" ? "open_water" : "pool");
    if (!file) return file.error();
    const auto loaded = scene::loadSceneFile(*file);
    if (!loaded) return loaded.error();
    each.scene = scene::toCore(*loaded);
  }
  out[1].scene.particles->count = 65536;
  return out;
}

/// A scene under one profile; several contexts take turns on the thread.
class Side {
 public:
  Side(gpu::Context& ctx, const core::Scene& scene) : ctx_(ctx) {
    if (!ctx.makeCurrent()) return;
    auto made = sim::WaterSim::create(ctx, scene);
    if (made) water_ = *std::move(made);
  }
  ~Side() {
    if (ctx_.makeCurrent()) water_.reset();
  }
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;

  [[nodiscard]] bool isMade() const { return water_ != nullptr; }
  double run_s(int ticks) {
    if (!ctx_.makeCurrent()) return 0.0;
    const auto begin = Clock::now();
    for (int tick = 0; tick < ticks; ++tick) water_->step();
    ctx_.finish();
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }
  /// Set if the device hung: further ticks took no time.
  [[nodiscard]] const std::optional<core::Error>& error() const { return water_->deviceError(); }
  std::uint64_t hash() { return ctx_.makeCurrent() ? water_->stateHash() : 0; }

 private:
  gpu::Context& ctx_;
  std::unique_ptr<sim::WaterSim> water_;
};

/// Logarithms of the time of a candidate over that of the best profile, one per pair of blocks; none if it is too late.
core::Result<std::vector<double>> compare(gpu::Context& best, gpu::Context& candidate, const core::Scene& scene,
                                          Clock::time_point deadline) {
  Side a(best, scene), b(candidate, scene);
  if (!a.isMade() || !b.isMade()) return core::Error{core::ErrorCode::kInternal, "the scene cannot be made"};
  for (Side* side : {&b, &a}) side->run_s(kWarmUpTicks);
  int ticks = 1;
  while (std::min(a.run_s(ticks), b.run_s(ticks)) < kBlock_s && ticks < kBlockMaxTicks) ticks *= 2;
  std::vector<double> out;
  for (int pair = 0; pair < kPairs; ++pair) {
    if (Clock::now() > deadline) return std::vector<double>();
    const bool a_first = pair % 2 == 0;
    const double first_s = (a_first ? a : b).run_s(ticks);
    const double second_s = (a_first ? b : a).run_s(ticks);
    out.push_back(a_first ? std::log(second_s / first_s) : std::log(first_s / second_s));
  }
  for (const Side* side : {&a, &b})
    if (side->error()) return *side->error();
  if (a.hash() != b.hash())
    return core::Error{core::ErrorCode::kInternal,
                       "the states differ: they depend on it, or equal runs differ on this device; report this line"};
  return out;
}

struct Estimate {
  double mean = 0.0, error = 0.0;
};

Estimate estimateOf(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  Estimate out;
  for (const double value : values) out.mean += value / count;
  for (const double value : values) out.error += (value - out.mean) * (value - out.mean) / (count * (count - 1.0));
  out.error = std::sqrt(out.error);
  return out;
}

}  // namespace

core::Result<boost::json::object> measureTuning(const gpu::DeviceChoice& device, std::FILE* out) {
  const auto deadline = Clock::now() + kLimit;
  auto scenes = tunedScenes();
  if (!scenes) return scenes.error();
  const auto contextWith = [&](const std::optional<gpu::TuningProfile>& profile) {
    gpu::DeviceChoice choice = device;
    choice.tuning = profile;
    return gpu::Context::create(choice);
  };
  auto best = contextWith(gpu::TuningProfile{});
  if (!best) return best.error();
  const gpu::DeviceInfo info = (*best)->device();
  gpu::TuningProfile profile = gpu::tuningProfile(info);
  best = contextWith(profile);
  if (!best) return best.error();

  fmt::print(out, "device {}, {}\n{:<20} {:>6} {:>6}  time by scene, +- error of the mean\n", info.name,
             info.gl_version, "field", "now", "tried");
  boost::json::array rows;
  bool is_late = false;
  for (const gpu::TuningField& field : gpu::tuningFields()) {
    for (const std::uint32_t value : field.allowed) {
      const std::uint32_t now = profile.*field.value;
      if (value == now) continue;
      gpu::TuningProfile tried = profile;
      tried.*field.value = value;
      auto candidate = contextWith(tried);
      if (!candidate) return candidate.error();
      std::vector<double> ratios;
      std::string line = fmt::format("{:<20} {:>6} {:>6} ", field.name, now, value);
      for (const TunedScene& each : *scenes) {
        if (std::ranges::none_of(each.fields, [&](auto start) { return field.name.starts_with(start); })) continue;
        auto compared = compare(**best, **candidate, each.scene, deadline);
        if (!compared)
          return core::Error{compared.error().code,
                             fmt::format("{} {} on {}: {}", field.name, value, each.name, compared.error().message)};
        is_late = compared->empty();
        if (is_late) break;
        const Estimate own = estimateOf(*compared);
        line += fmt::format(" {} {:.3f} +- {:.3f} ", each.name, std::exp(own.mean), own.error);
        ratios.insert(ratios.end(), compared->begin(), compared->end());
      }
      if (is_late) break;
      const Estimate all = estimateOf(ratios);
      const bool is_kept = all.mean < -std::max(kLeastGain, kErrors * all.error);
      fmt::print(out, "{}{}\n", line, is_kept ? " kept" : "");
      rows.push_back({{"field", field.name},
                      {"now", now},
                      {"tried", value},
                      {"time_ratio", std::exp(all.mean)},
                      {"error", all.error},
                      {"is_kept", is_kept}});
      if (!is_kept) continue;
      profile = tried;
      best = std::move(candidate);
    }
    if (is_late) {
      fmt::print(out, "the three minutes are over: {} and what follows it was not tried in full\n", field.name);
      break;
    }
  }

  const std::filesystem::path file = gpu::tuningFile(info);
  boost::json::object fields;
  for (const gpu::TuningField& field : gpu::tuningFields()) fields[field.name] = profile.*field.value;
  fmt::print(out, "{}\n", boost::json::serialize(fields));
  if (file.empty()) {
    fmt::print(out, "not written: neither XDG_CACHE_HOME nor HOME is an absolute path\n");
  } else {
    if (auto written = gpu::writeTuning(file, profile); !written) return written.error();
    fmt::print(out, "written to {}: used from the next start on\n", file.string());
  }
  return boost::json::object{{"device", info.name},
                             {"gl_version", info.gl_version},
                             {"is_complete", !is_late},
                             {"profile", std::move(fields)},
                             {"rows", std::move(rows)}};
}

}  // namespace spindrift::bench
