#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>
#include <variant>

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

void fill(v1::ActiveEffect& out, const core::Splash& splash) {
  v1::Splash& message = *out.mutable_splash();
  message.set_x_m(splash.x_m);
  message.set_z_m(splash.z_m);
  message.set_radius_m(splash.radius_m);
  message.set_depth_m(splash.depth_m);
  message.set_duration_s(splash.duration_s);
}

void fill(v1::ActiveEffect& out, const core::BreakingWave& wave) {
  v1::BreakingWave& message = *out.mutable_breaking_wave();
  message.set_side(toMessage(wave.side.value()));  // an active one has a side
  message.set_amplitude_m(wave.amplitude_m);
  message.set_length_m(wave.length_m);
  message.set_duration_s(wave.duration_s);
  message.set_shape(wave.shape == core::WaveShape::kSwell ? v1::WAVE_SHAPE_SWELL : v1::WAVE_SHAPE_BREAKING);
  message.set_direction_deg(wave.direction_deg);
  message.set_width_m(wave.width_m);
  message.set_x_m(wave.x_m);
  message.set_z_m(wave.z_m);
}

void fill(v1::ActiveStroke& out, const sim::Stroke& stroke) {
  v1::Stroke& message = *out.mutable_stroke();
  message.set_person_id(stroke.person_id);
  message.set_stroke_id(stroke.stroke_id);
  message.set_tool(toMessage(stroke.tool));
  message.set_radius_m(stroke.radius_m);
  message.set_depth_m(stroke.depth_m);
  message.set_ends(stroke.is_lifted);
  for (const sim::StrokePoint& point : stroke.path) {
    v1::StrokePoint& one = *message.add_points();
    one.set_time_s(point.time_s);
    one.set_x_m(point.x_m);
    one.set_z_m(point.z_m);
    one.set_pressure_ratio(point.pressure_ratio);
  }
  out.set_is_whole(stroke.is_whole);
  out.set_play_s(stroke.play_s);
  out.set_still_s(stroke.still_s);
  out.set_x_m(stroke.x_m);
  out.set_z_m(stroke.z_m);
  out.set_level_ratio(stroke.level_ratio);
}

sim::Stroke toStroke(const v1::ActiveStroke& message) {
  sim::StrokePart part = toStrokePart(message.stroke());
  return {.person_id = part.person_id,
          .stroke_id = part.stroke_id,
          .tool = part.tool,
          .radius_m = part.radius_m,
          .depth_m = part.depth_m,
          .path = std::move(part.points),
          .is_lifted = part.ends,
          .is_whole = message.is_whole(),
          .play_s = message.play_s(),
          .still_s = message.still_s(),
          .x_m = message.x_m(),
          .z_m = message.z_m(),
          .level_ratio = message.level_ratio()};
}

void fill(v1::Boat& out, const core::Boat& boat) {
  out.set_x_m(boat.x_m);
  out.set_z_m(boat.z_m);
  out.set_heading_deg(boat.heading_deg);
  out.set_length_m(boat.length_m);
  out.set_beam_m(boat.beam_m);
  out.set_height_m(boat.height_m);
  out.set_density_ratio(boat.density_ratio);
  out.set_max_speed_mps(boat.max_speed_mps);
  out.set_throttle_ratio(boat.throttle_ratio);
  out.set_rudder_ratio(boat.rudder_ratio);
}

void fill(v1::SeaState& out, const sim::SeaState& sea) {
  out.set_wind_speed_mps(sea.wind_speed_mps);
  out.set_significant_height_m(sea.significant_height_m);
  out.set_peak_period_s(sea.peak_period_s);
  out.set_peak_length_m(sea.peak_length_m);
  for (const sim::PlaneWave& wave : sea.waves) {
    v1::SeaWave& message = *out.add_waves();
    message.set_amplitude_m(wave.amplitude_m);
    message.set_omega_radps(wave.omega_radps);
    message.set_kx_radpm(wave.kx_radpm);
    message.set_kz_radpm(wave.kz_radpm);
    message.set_phase_rad(wave.phase_rad);
    message.set_decay_pm(wave.decay_pm);
    message.set_sides(wave.sides);
  }
}

sim::SeaState toSea(const v1::SeaState& message) {
  sim::SeaState out{.wind_speed_mps = message.wind_speed_mps(),
                    .significant_height_m = message.significant_height_m(),
                    .peak_period_s = message.peak_period_s(),
                    .peak_length_m = message.peak_length_m(),
                    .waves = {}};
  for (const v1::SeaWave& wave : message.waves())
    out.waves.push_back({.amplitude_m = wave.amplitude_m(),
                         .omega_radps = wave.omega_radps(),
                         .kx_radpm = wave.kx_radpm(),
                         .kz_radpm = wave.kz_radpm(),
                         .phase_rad = wave.phase_rad(),
                         .decay_pm = wave.decay_pm(),
                         .sides = wave.sides()});
  return out;
}

void fill(v1::ParticleLayout& out, const sim::ParticleLayout& layout) {
  out.set_count(layout.count);
  out.set_columns_x_count(layout.columns_x_count);
  out.set_columns_z_count(layout.columns_z_count);
  out.set_layers_count(layout.layers_count);
  out.set_spacing_m(layout.spacing_m);
  out.set_pitch_x_m(layout.pitch_x_m);
  out.set_pitch_z_m(layout.pitch_z_m);
  out.set_volume_m3(layout.volume_m3);
  out.set_support_radius_m(layout.support_radius_m);
  out.set_mass_kg(layout.mass_kg);
  out.set_virtual_mass_kg(layout.virtual_mass_kg);
  out.set_floor_drag_pm2(layout.floor_drag_pm2);
  out.set_wall_share(layout.wall_share);
  out.set_wall_reach_m(layout.wall_reach_m);
  out.set_constraint_softness_pm2(layout.constraint_softness_pm2);
  out.set_band_m(layout.band_m);
  out.set_splat_reach_count(layout.splat_reach_count);
  out.set_neighbours_count(layout.neighbours_count);
  out.set_cell_count(layout.cell_count);
  out.mutable_layer_heights_m()->Add(layout.layer_heights_m.begin(), layout.layer_heights_m.end());
  out.mutable_min_m()->Add(layout.min_m.begin(), layout.min_m.end());
  out.mutable_max_m()->Add(layout.max_m.begin(), layout.max_m.end());
  out.mutable_cells()->Add(layout.cells.begin(), layout.cells.end());
}

/// nullopt if a corner or the cells do not have three numbers.
std::optional<sim::ParticleLayout> toLayout(const v1::ParticleLayout& message) {
  sim::ParticleLayout out;
  if (message.min_m_size() != 3 || message.max_m_size() != 3 || message.cells_size() != 3) return std::nullopt;
  out.count = message.count();
  out.columns_x_count = message.columns_x_count();
  out.columns_z_count = message.columns_z_count();
  out.layers_count = message.layers_count();
  out.spacing_m = message.spacing_m();
  out.pitch_x_m = message.pitch_x_m();
  out.pitch_z_m = message.pitch_z_m();
  out.volume_m3 = message.volume_m3();
  out.support_radius_m = message.support_radius_m();
  out.mass_kg = message.mass_kg();
  out.virtual_mass_kg = message.virtual_mass_kg();
  out.floor_drag_pm2 = message.floor_drag_pm2();
  out.wall_share = message.wall_share();
  out.wall_reach_m = message.wall_reach_m();
  out.constraint_softness_pm2 = message.constraint_softness_pm2();
  out.band_m = message.band_m();
  out.splat_reach_count = message.splat_reach_count();
  out.neighbours_count = message.neighbours_count();
  out.cell_count = message.cell_count();
  out.layer_heights_m.assign(message.layer_heights_m().begin(), message.layer_heights_m().end());
  std::ranges::copy(message.min_m(), out.min_m.begin());
  std::ranges::copy(message.max_m(), out.max_m.begin());
  std::ranges::copy(message.cells(), out.cells.begin());
  return out;
}

}  // namespace

v1::Side toMessage(core::Side side) {
  switch (side) {
    case core::Side::kPlusX:
      return v1::SIDE_PLUS_X;
    case core::Side::kMinusX:
      return v1::SIDE_MINUS_X;
    case core::Side::kPlusZ:
      return v1::SIDE_PLUS_Z;
    case core::Side::kMinusZ:
      return v1::SIDE_MINUS_Z;
    case core::Side::kDirection:
      break;
  }
  return v1::SIDE_DIRECTION;
}

v1::StrokeTool toMessage(sim::StrokeTool tool) {
  switch (tool) {
    case sim::StrokeTool::kFinger:
      return v1::STROKE_TOOL_FINGER;
    case sim::StrokeTool::kRain:
      return v1::STROKE_TOOL_RAIN;
    case sim::StrokeTool::kCalm:
      break;
  }
  return v1::STROKE_TOOL_CALM;
}

namespace {

sim::StrokeTool toTool(v1::StrokeTool tool) {
  if (tool == v1::STROKE_TOOL_RAIN) return sim::StrokeTool::kRain;
  return tool == v1::STROKE_TOOL_CALM ? sim::StrokeTool::kCalm : sim::StrokeTool::kFinger;
}

}  // namespace

sim::StrokePart toStrokePart(const v1::Stroke& stroke) {
  sim::StrokePart out{.person_id = stroke.person_id(),
                      .stroke_id = stroke.stroke_id(),
                      .radius_m = stroke.radius_m(),
                      .depth_m = stroke.depth_m(),
                      .ends = stroke.ends(),
                      .tool = toTool(stroke.tool())};
  for (const v1::StrokePoint& point : stroke.points())
    out.points.push_back({point.time_s(), point.x_m(), point.z_m(), point.pressure_ratio()});
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
    fill(*message.mutable_boat(), place.boat);
  }
  out.set_first_boat_id(state.host.boats.first_id);
  out.set_next_boat_id(state.host.boats.next_id);
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
    return core::Error{core::ErrorCode::kInvalidInput, std::string("the saved water is damaged: ") + what};
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
    host.boats.places.push_back({place.boat_id(), scene::toCore(place.boat())});
  host.boats.first_id = message.first_boat_id();
  host.boats.next_id = message.next_boat_id();
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

}  // namespace spindrift::water
