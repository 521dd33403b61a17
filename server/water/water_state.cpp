#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <spindrift/scene/scene_rules.h>
#include <spindrift/water/water_state.h>

namespace spindrift::water {
namespace {

static_assert(std::endian::native == std::endian::little, "words are little-endian in messages");

std::string bytesOf(const std::vector<std::uint32_t>& words) {
  return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint32_t)};
}

/// Returns false if the bytes are not whole words.
bool readWords(const std::string& bytes, std::vector<std::uint32_t>& words) {
  if (bytes.size() % sizeof(std::uint32_t) != 0) return false;
  words.resize(bytes.size() / sizeof(std::uint32_t));
  if (!words.empty()) std::memcpy(words.data(), bytes.data(), bytes.size());
  return true;
}

/// A number that a message and a struct have under the same name: how to write it into the message, and to read it.
#define NUMBER(name)                                                                \
  std::pair([](auto& message, const auto& from) { message.set_##name(from.name); }, \
            [](const auto& message, auto& to) { to.name = message.name(); })

constexpr std::tuple kSplashNumbers{NUMBER(x_m), NUMBER(z_m), NUMBER(radius_m), NUMBER(depth_m), NUMBER(duration_s)};
constexpr std::tuple kWaveNumbers{NUMBER(amplitude_m), NUMBER(length_m), NUMBER(duration_s), NUMBER(direction_deg),
                                  NUMBER(width_m),     NUMBER(x_m),      NUMBER(z_m)};
constexpr std::tuple kStrokeNumbers{NUMBER(person_id), NUMBER(stroke_id), NUMBER(radius_m), NUMBER(depth_m)};
constexpr std::tuple kPointNumbers{NUMBER(time_s), NUMBER(x_m), NUMBER(z_m), NUMBER(pressure_ratio)};
constexpr std::tuple kActiveStrokeNumbers{NUMBER(is_whole), NUMBER(play_s), NUMBER(still_s),
                                          NUMBER(x_m),      NUMBER(z_m),    NUMBER(level_ratio)};
constexpr std::tuple kBoatNumbers{
    NUMBER(x_m),      NUMBER(z_m),           NUMBER(heading_deg),   NUMBER(length_m),       NUMBER(beam_m),
    NUMBER(height_m), NUMBER(density_ratio), NUMBER(max_speed_mps), NUMBER(throttle_ratio), NUMBER(rudder_ratio)};
constexpr std::tuple kFloaterNumbers{NUMBER(x_m),
                                     NUMBER(y_m),
                                     NUMBER(z_m),
                                     NUMBER(heading_deg),
                                     NUMBER(size_m),
                                     NUMBER(density_ratio),
                                     NUMBER(ballast_ratio),
                                     NUMBER(velocity_x_mps),
                                     NUMBER(velocity_y_mps),
                                     NUMBER(velocity_z_mps)};
constexpr std::tuple kSeaNumbers{NUMBER(wind_speed_mps), NUMBER(significant_height_m), NUMBER(peak_period_s),
                                 NUMBER(peak_length_m)};
constexpr std::tuple kSeaWaveNumbers{NUMBER(amplitude_m), NUMBER(omega_radps), NUMBER(kx_radpm), NUMBER(kz_radpm),
                                     NUMBER(phase_rad),   NUMBER(decay_pm),    NUMBER(sides)};
constexpr std::tuple kLayoutNumbers{NUMBER(count),        NUMBER(columns_x_count),   NUMBER(columns_z_count),
                                    NUMBER(layers_count), NUMBER(spacing_m),         NUMBER(pitch_x_m),
                                    NUMBER(pitch_z_m),    NUMBER(volume_m3),         NUMBER(support_radius_m),
                                    NUMBER(mass_kg),      NUMBER(virtual_mass_kg),   NUMBER(floor_drag_pm2),
                                    NUMBER(wall_share),   NUMBER(wall_reach_m),      NUMBER(constraint_softness_pm2),
                                    NUMBER(band_m),       NUMBER(splat_reach_count), NUMBER(neighbours_count),
                                    NUMBER(cell_count)};
#undef NUMBER

template <typename Message, typename Struct, typename Numbers>
void write(Message& out, const Struct& from, const Numbers& numbers) {
  std::apply([&](const auto&... number) { (number.first(out, from), ...); }, numbers);
}

template <typename Message, typename Struct, typename Numbers>
void read(const Message& message, Struct& out, const Numbers& numbers) {
  std::apply([&](const auto&... number) { (number.second(message, out), ...); }, numbers);
}

void fill(v1::ActiveEffect& out, const core::Splash& splash) {
  write(*out.mutable_splash(), splash, kSplashNumbers);
}

void fill(v1::ActiveEffect& out, const core::BreakingWave& wave) {
  v1::BreakingWave& message = *out.mutable_breaking_wave();
  write(message, wave, kWaveNumbers);
  message.set_side(toMessage(wave.side.value()));  // an active one has a side
  message.set_shape(wave.shape == core::WaveShape::kSwell ? v1::WAVE_SHAPE_SWELL : v1::WAVE_SHAPE_BREAKING);
}

void fill(v1::ActiveStroke& out, const sim::Stroke& stroke) {
  v1::Stroke& message = *out.mutable_stroke();
  write(message, stroke, kStrokeNumbers);
  message.set_tool(toMessage(stroke.tool));
  message.set_ends(stroke.is_lifted);
  for (const sim::StrokePoint& point : stroke.path) write(*message.add_points(), point, kPointNumbers);
  write(out, stroke, kActiveStrokeNumbers);
}

sim::Stroke toStroke(const v1::ActiveStroke& message) {
  sim::Stroke out;
  read(message.stroke(), out, kStrokeNumbers);
  sim::StrokePart part = toStrokePart(message.stroke());
  out.tool = part.tool;
  out.path = std::move(part.points);
  out.is_lifted = part.ends;
  read(message, out, kActiveStrokeNumbers);
  return out;
}

void fill(v1::FloaterPlace& out, const sim::FloaterPlace& place) {
  out.set_floater_id(place.floater_id);
  write(*out.mutable_floater(), place.floater, kFloaterNumbers);
  for (int kind = v1::FloaterKind_MIN + 1; kind < v1::FloaterKind_ARRAYSIZE; ++kind) {
    const auto one = static_cast<v1::FloaterKind>(kind);
    if (scene::toCore(one) == place.floater.kind) out.mutable_floater()->set_kind(one);
  }
}

void fill(v1::SeaState& out, const sim::SeaState& sea) {
  write(out, sea, kSeaNumbers);
  for (const sim::PlaneWave& wave : sea.waves) write(*out.add_waves(), wave, kSeaWaveNumbers);
}

sim::SeaState toSea(const v1::SeaState& message) {
  sim::SeaState out;
  read(message, out, kSeaNumbers);
  for (const v1::SeaWave& wave : message.waves()) read(wave, out.waves.emplace_back(), kSeaWaveNumbers);
  return out;
}

void fill(v1::ParticleLayout& out, const sim::ParticleLayout& layout) {
  write(out, layout, kLayoutNumbers);
  out.mutable_layer_heights_m()->Add(layout.layer_heights_m.begin(), layout.layer_heights_m.end());
  out.mutable_min_m()->Add(layout.min_m.begin(), layout.min_m.end());
  out.mutable_max_m()->Add(layout.max_m.begin(), layout.max_m.end());
  out.mutable_cells()->Add(layout.cells.begin(), layout.cells.end());
}

/// nullopt if a corner or the cells do not have three numbers.
std::optional<sim::ParticleLayout> toLayout(const v1::ParticleLayout& message) {
  if (message.min_m_size() != 3 || message.max_m_size() != 3 || message.cells_size() != 3) return std::nullopt;
  sim::ParticleLayout out;
  read(message, out, kLayoutNumbers);
  out.layer_heights_m.assign(message.layer_heights_m().begin(), message.layer_heights_m().end());
  std::ranges::copy(message.min_m(), out.min_m.begin());
  std::ranges::copy(message.max_m(), out.max_m.begin());
  std::ranges::copy(message.cells(), out.cells.begin());
  return out;
}

sim::StrokeTool toTool(v1::StrokeTool tool) {
  if (tool == v1::STROKE_TOOL_RAIN) return sim::StrokeTool::kRain;
  return tool == v1::STROKE_TOOL_CALM ? sim::StrokeTool::kCalm : sim::StrokeTool::kFinger;
}

std::uint64_t hashOfVersion0(const sim::StateCopy& state) {
  std::uint64_t hash = 0xcbf29ce484222325ull;  // 64-bit FNV-1a over bytes
  const auto add = [&](const auto& values) {
    for (const std::byte b : std::as_bytes(std::span(values)))
      hash = (hash ^ static_cast<std::uint64_t>(b)) * 0x100000001b3ull;
  };
  add(state.position);
  add(state.velocity);
  add(state.elevation_m);
  add(state.flow_m2ps);
  add(state.boats);
  add(state.pool);
  add(state.elevation_x_units);
  return hash;
}

}  // namespace

v1::Side toMessage(core::Side side) {
  for (const v1::Side one : {v1::SIDE_PLUS_X, v1::SIDE_MINUS_X, v1::SIDE_PLUS_Z, v1::SIDE_MINUS_Z}) {
    if (scene::toCore(one) == side) return one;
  }
  return v1::SIDE_DIRECTION;
}

v1::StrokeTool toMessage(sim::StrokeTool tool) {
  for (const v1::StrokeTool one : {v1::STROKE_TOOL_RAIN, v1::STROKE_TOOL_CALM}) {
    if (toTool(one) == tool) return one;
  }
  return v1::STROKE_TOOL_FINGER;
}

sim::StrokePart toStrokePart(const v1::Stroke& stroke) {
  sim::StrokePart out{.ends = stroke.ends(), .tool = toTool(stroke.tool())};
  read(stroke, out, kStrokeNumbers);
  for (const v1::StrokePoint& point : stroke.points()) read(point, out.points.emplace_back(), kPointNumbers);
  return out;
}

v1::WaterState toMessage(const sim::SavedState& state) {
  v1::WaterState out;
  out.set_run_tick(state.run_tick);
  if (state.careful_ticks) out.set_careful_ticks(*state.careful_ticks);
  if (state.particles) fill(*out.mutable_particles(), *state.particles);
  out.set_layout(bytesOf(state.layout));
  for (const sim::SavedBuffer& buffer : state.buffers) {
    v1::WaterBuffer& message = *out.add_buffers();
    message.set_name(buffer.name);
    message.set_words(bytesOf(buffer.words));
  }
  for (const sim::Effects::Active& active : state.host.effects.active()) {
    v1::ActiveEffect& message = *out.add_effects();
    message.set_start_s(active.start_s);
    std::visit([&](const auto& effect) { fill(message, effect); }, active.effect);
  }
  for (const sim::Stroke& stroke : state.host.effects.strokes().active()) fill(*out.add_strokes(), stroke);
  for (const sim::BoatPlace& place : state.host.boats.places) {
    v1::BoatPlace& message = *out.add_boats();
    message.set_boat_id(place.boat_id);
    write(*message.mutable_boat(), place.boat, kBoatNumbers);
    message.set_moved_left_s(place.moved_left_s);
  }
  out.set_first_boat_id(state.host.boats.first_id);
  out.set_next_boat_id(state.host.boats.next_id);
  for (const sim::FloaterPlace& place : state.host.floaters.places) fill(*out.add_floaters(), place);
  out.set_next_floater_id(state.host.floaters.next_id);
  fill(*out.mutable_sea(), state.host.sea.shown);
  fill(*out.mutable_next_sea(), state.host.sea.next);
  if (state.host.sea.fade_begin_s) out.set_fade_begin_s(*state.host.sea.fade_begin_s);
  out.set_sea_step_count(state.host.sea.step_count);
  out.set_patch_x_m(state.host.patch_x_m);
  out.set_patch_z_m(state.host.patch_z_m);
  return out;
}

core::Result<sim::SavedState> toSavedState(const v1::WaterState& message) {
  const auto invalid = [](const char* what) {
    return core::invalid(std::string("the saved water is damaged: ") + what);
  };
  sim::SavedState out;
  out.run_tick = message.run_tick();
  if (message.has_careful_ticks()) out.careful_ticks = message.careful_ticks();
  if (message.has_particles()) {
    out.particles = toLayout(message.particles());
    if (!out.particles) return invalid("its particles have no box");
  }
  if (!readWords(message.layout(), out.layout)) return invalid("its layout has no whole words");
  for (const v1::WaterBuffer& buffer : message.buffers()) {
    if (!readWords(buffer.words(), out.buffers.emplace_back(sim::SavedBuffer{buffer.name(), {}}).words))
      return invalid("a buffer has no whole words");
  }
  std::vector<sim::Effects::Active> active;
  for (const v1::ActiveEffect& effect : message.effects()) {
    if (effect.has_splash()) {
      active.push_back({scene::toCore(effect.splash()), effect.start_s()});
    } else if (effect.has_breaking_wave()) {
      if (effect.breaking_wave().side() == v1::SIDE_UNSPECIFIED) return invalid("an active wave has no side");
      active.push_back({scene::toCore(effect.breaking_wave()), effect.start_s()});
    } else {
      return invalid("an effect is neither splash nor wave");
    }
  }
  sim::HostState& host = out.host;
  if (!host.effects.resume(std::move(active))) return invalid("it has more effects than there can be");
  std::vector<sim::Stroke> strokes;
  for (const v1::ActiveStroke& stroke : message.strokes()) strokes.push_back(toStroke(stroke));
  if (!host.effects.strokes().resume(std::move(strokes))) return invalid("it has more strokes than there can be");
  for (const v1::BoatPlace& place : message.boats())
    host.boats.places.push_back({place.boat_id(), scene::toCore(place.boat()), place.moved_left_s()});
  host.boats.first_id = message.first_boat_id();
  host.boats.next_id = message.next_boat_id();
  if (message.floaters_size() > static_cast<int>(core::kMaxFloaters))
    return invalid("it has more floaters than there can be");
  for (const v1::FloaterPlace& place : message.floaters())
    host.floaters.places.push_back({place.floater_id(), scene::toCore(place.floater())});
  // Snapshots of servers that knew no floaters have no number.
  host.floaters.next_id = std::max(message.next_floater_id(), sim::CarriedFloaters{}.next_id);
  host.sea.shown = toSea(message.sea());
  host.sea.next = toSea(message.next_sea());
  if (host.sea.shown.waves.size() + host.sea.next.waves.size() > MAX_SEA_WAVES)
    return invalid("it has more waves than there can be");
  if (message.has_fade_begin_s()) host.sea.fade_begin_s = message.fade_begin_s();
  host.sea.step_count = message.sea_step_count();
  host.patch_x_m = message.patch_x_m();
  host.patch_z_m = message.patch_z_m();
  return out;
}

core::Result<std::uint64_t> recordedHash(sim::WaterSim& water, std::uint32_t version) {
  if (version == 0) return hashOfVersion0(water.copyState());
  if (version == kStateHashVersion) return water.stateHash();
  return core::invalid(fmt::format(
      "its state hashes are of version {}, and this program knows versions up to {}: use the program that wrote them",
      version, kStateHashVersion));
}

}  // namespace spindrift::water
