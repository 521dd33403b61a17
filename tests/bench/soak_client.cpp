#include "soak_client.h"

#include <algorithm>
#include <cmath>

#include "messages.h"

namespace spindrift::bench {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A command that took longer counts as not answered: heavy ones wait for a second at most, and a takeover of a room
/// or a change of its scene takes less than this.
constexpr seconds kAnswerPatience{20};
constexpr milliseconds kPointInterval{40};
constexpr int kStrokePoints = 15;
constexpr double kStrokeLength_m = 3.0;
constexpr milliseconds kSteeringInterval{500};
constexpr double kRates_hz[] = {0.0, 5.0, 20.0, 30.0, 60.0};
constexpr v1::Layer kLayers[] = {v1::LAYER_SURFACE, v1::LAYER_PARTICLES, v1::LAYER_FOAM, v1::LAYER_BODIES};
constexpr v1::Level kLevels[] = {v1::LEVEL_COARSE, v1::LEVEL_MEDIUM, v1::LEVEL_FINE, v1::LEVEL_FULL};

template <typename Values>
std::uint64_t countNonfinite(const Values& values) {
  return static_cast<std::uint64_t>(std::ranges::count_if(values, [](double value) { return !std::isfinite(value); }));
}

double ms(SoakCrowd::Clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

}  // namespace

SoakCrowd::Clock::duration SoakCrowd::untilNext(double per_s) {
  const double day_s = 86400.0;
  const double wait_s = per_s > 0.0 ? std::exponential_distribution<double>(per_s)(random) : day_s;
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(wait_s, day_s)));
}

void SoakClient::turn(Clock::time_point now) {
  if (!client_) {
    if (now >= try_at_) connect();
    return;
  }
  if (!is_open_ || leaves_) return;
  giveUpAnswers(now);
  if (now >= leave_at_) return leave(now);
  if (!is_greeted_) return;
  if (points_left_ > 0 && now >= next_point_) continueStroke(now);
  if (now >= next_stroke_ && points_left_ == 0) {
    next_stroke_ = now + crowd_.untilNext(crowd_.options.strokes_per_s);
    beginStroke(now);
  }
  if (now >= next_wave_) {
    next_wave_ = now + crowd_.untilNext(crowd_.options.waves_per_s);
    sendWave();
  }
  if (now >= next_boat_) {
    next_boat_ = now + crowd_.untilNext(crowd_.options.boats_per_s);
    launchOrRemoveBoat();
  }
  if (boat_ != 0 && now >= next_steering_) {
    next_steering_ = now + kSteeringInterval;
    steer();
  }
  if (now >= next_level_) {
    next_level_ = now + crowd_.untilNext(crowd_.options.level_changes_per_s);
    changeLevel();
  }
}

// Coming and going

void SoakClient::connect() {
  std::vector<const net::ClientUrl*> choices;
  for (const net::ClientUrl& url : crowd_.urls) {
    // A person is known in one room, at every server and edge.
    if (!comes_back_ || url.path == room_path_) choices.push_back(&url);
  }
  const net::ClientUrl& url = *choices[crowd_.below(choices.size())];
  room_path_ = url.path;
  was_open_ = is_open_ = is_greeted_ = leaves_ = false;
  client_ = crowd_.pool->connect(url, {},
                                 {.opened = [this] { opened(); },
                                  .message = [this](core::ByteView bytes) { take(bytes); },
                                  .closed = [this](std::uint16_t code, const std::string&) { ended(code); }});
}

void SoakClient::opened() {
  was_open_ = is_open_ = true;
  const auto now = Clock::now();
  (void)client_->send(bytesOf(helloOf(crowd_.options.token, comes_back_ ? resume_key_ : "")));
  for (const v1::Layer layer : kLayers) {
    subscribe(layer, 60.0, kLevels[crowd_.below(std::size(kLevels))], v1::PACKING_PACKED, crowd_.below(2) == 0);
  }
  if (is_witness_) subscribe(v1::LAYER_DIAGNOSTICS, 4.0, v1::LEVEL_FULL, v1::PACKING_PLAIN, false);
  const SoakOptions& options = crowd_.options;
  leave_at_ = now + crowd_.untilNext(options.churn_per_s / static_cast<double>(options.client_count));
  next_stroke_ = now + crowd_.untilNext(options.strokes_per_s);
  next_wave_ = now + crowd_.untilNext(options.waves_per_s);
  next_boat_ = now + crowd_.untilNext(options.boats_per_s);
  next_level_ = now + crowd_.untilNext(options.level_changes_per_s);
  points_left_ = 0;
  if (!comes_back_) boat_ = 0;
}

void SoakClient::leave(Clock::time_point now) {
  leaves_ = true;
  comes_back_ = crowd_.below(2) == 0 && !resume_key_.empty();
  try_at_ = now + milliseconds(comes_back_ ? 50 + crowd_.below(2000) : 50 + crowd_.below(500));
  crowd_.count([](SoakTally& tally) { ++tally.reconnect_count; });
  if (crowd_.below(2) == 0)
    client_->vanish();
  else
    client_->close();
}

void SoakClient::ended(int code) {
  const std::uint64_t cut = waiting_.size();
  crowd_.count([&](SoakTally& tally) {
    tally.cut_count += cut;
    if (!was_open_)
      ++tally.refused_count;
    else if (!leaves_)
      ++tally.ended[code];
  });
  if (!leaves_) {
    // A room that was closed takes its people with it.
    comes_back_ = false;
    try_at_ = Clock::now() + milliseconds(250 + crowd_.below(500));
  }
  waiting_.clear();
  boats_.clear();
  last_frame_ = {};
  is_open_ = false;
  client_ = nullptr;
}

// What it receives

void SoakClient::take(core::ByteView bytes) {
  crowd_.count([&](SoakTally& tally) { tally.bytes_count += bytes.size(); });
  // The first byte is the tag of the message: most clients need no frame's content.
  constexpr std::uint8_t kFrameTag = v1::ServerMessage::kFrameFieldNumber << 3 | 2;
  const bool is_frame = !bytes.empty() && bytes[0] == kFrameTag;
  if (is_frame) {
    const auto now = Clock::now();
    const double gap_ms = last_frame_ == Clock::time_point() ? 0.0 : ms(now - last_frame_);
    last_frame_ = now;
    crowd_.count([&](SoakTally& tally) {
      ++tally.frame_count;
      tally.longest_gap_ms = std::max(tally.longest_gap_ms, gap_ms);
    });
  }
  if (is_frame && !is_witness_) return;
  const auto message = codec::parseServerMessage(bytes);
  if (!message) {
    crowd_.count([](SoakTally& tally) { ++tally.undecodable_count; });
    return;
  }
  if (message->has_frame()) checkFrame(message->frame());
  if (message->has_diagnostics()) checkDiagnostics(message->diagnostics());
  if (message->has_greeting()) takeGreeting(message->greeting());
  if (message->has_boat_list()) {
    boats_.clear();
    for (const v1::BoatInfo& boat : message->boat_list().boats()) boats_.insert(boat.boat_id());
    if (!boats_.contains(boat_)) boat_ = 0;
  }
  if (message->has_welcome()) {
    resume_key_ = message->welcome().resume_key();
    if (message->welcome().resumed()) crowd_.count([](SoakTally& tally) { ++tally.resumed_count; });
  }
  if (message->has_ack()) takeAnswer(message->ack().command_id(), *message);
  if (message->has_reject()) takeAnswer(message->reject().command_id(), *message);
}

void SoakClient::takeGreeting(const v1::Greeting& greeting) {
  constexpr double kShare = 0.4;  // of the water on each side of its centre
  is_greeted_ = true;
  const v1::Scene& scene = greeting.scene();
  const double side_m = scene.wave().side_m();
  half_x_m_ = kShare * side_m;
  half_z_m_ = kShare * (scene.wave().width_m() > 0.0 ? scene.wave().width_m() : side_m);
  boat_max_count_ = scene.has_boats() ? scene.boats().capacity_count() : 0;
  boats_.clear();
  for (const v1::BoatInfo& boat : greeting.boat_list().boats()) boats_.insert(boat.boat_id());
  if (!boats_.contains(boat_)) boat_ = 0;
}

void SoakClient::takeAnswer(std::uint64_t command_id, const v1::ServerMessage& message) {
  const auto sent = waiting_.extract(command_id);
  if (message.has_reject()) {
    crowd_.count([&](SoakTally& tally) { ++tally.rejected[message.reject().reason()]; },
                 sent && sent.mapped().is_measured);
    return;
  }
  if (message.ack().boat_id() != 0) boat_ = message.ack().boat_id();
  if (!sent) return;
  const double delay_ms = ms(Clock::now() - sent.mapped().at);
  crowd_.count([&](SoakTally& tally) { (sent.mapped().is_heavy ? tally.heavy_answers : tally.answers).note(delay_ms); },
               sent.mapped().is_measured);
}

void SoakClient::checkFrame(const v1::LayerFrame& frame) {
  std::uint64_t nonfinite = std::isfinite(frame.time_s()) && std::isfinite(frame.server_time_s()) ? 0 : 1;
  core::Result<void> read;
  const auto look = [&](auto&& decoded, auto&& count) {
    if (decoded)
      nonfinite += count(*decoded);
    else
      read = decoded.error();
  };
  const auto ofSurface = [](const codec::SurfaceSamples& one) { return countNonfinite(one.elevation_m); };
  const auto ofFoam = [](const codec::FoamSamples&) { return std::uint64_t{0}; };
  const auto ofParticles = [](const codec::ParticleSamples& one) {
    return countNonfinite(one.position_m) + countNonfinite(one.velocity_mps);
  };
  const auto ofBodies = [](const std::vector<codec::BodySample>& all) {
    std::uint64_t out = 0;
    for (const codec::BodySample& one : all) {
      out += countNonfinite(one.position_m);
      out += countNonfinite(std::initializer_list<double>{one.heading_rad, one.pitch_rad, one.roll_rad, one.speed_mps});
    }
    return out;
  };
  const auto ofFloaters = [](const std::vector<codec::FloaterSample>& all) {
    std::uint64_t out = 0;
    for (const codec::FloaterSample& one : all) out += countNonfinite(one.position_m) + countNonfinite(one.rotation);
    return out;
  };
  switch (frame.codec_case()) {
    case v1::LayerFrame::kSurfaceFixed16:
      look(codec::decodeSurface(frame), ofSurface);
      break;
    case v1::LayerFrame::kSurfacePredicted:
      look(surface_.decode(frame), ofSurface);
      break;
    case v1::LayerFrame::kFoamFixed8:
      look(codec::decodeFoam(frame), ofFoam);
      break;
    case v1::LayerFrame::kFoamPredicted:
      look(foam_.decode(frame), ofFoam);
      break;
    case v1::LayerFrame::kParticlesFixed12:
      look(codec::decodeParticles(frame), ofParticles);
      break;
    case v1::LayerFrame::kParticlesByCell:
      look(codec::decodePackedParticles(frame), ofParticles);
      break;
    case v1::LayerFrame::kBodiesFixed28:
      look(codec::decodeBodies(frame), ofBodies);
      break;
    case v1::LayerFrame::kFloatersFixed28:
      look(codec::decodeFloaters(frame), ofFloaters);
      break;
    case v1::LayerFrame::kFloatersPredicted:
      look(floaters_.decode(frame), ofFloaters);
      break;
    case v1::LayerFrame::CODEC_NOT_SET:
      read = core::Error{core::ErrorCode::kInvalidInput, "a frame without a codec"};
  }
  crowd_.count([&](SoakTally& tally) {
    ++(read ? tally.decoded_count : tally.undecodable_count);
    tally.nonfinite_count += nonfinite;
  });
}

void SoakClient::checkDiagnostics(const v1::Diagnostics& d) {
  const std::uint64_t nonfinite = countNonfinite(std::initializer_list<double>{
      d.time_s(), d.step_ms(), d.real_time_factor(), d.max_particle_speed_mps(), d.max_elevation_m(),
      d.kinetic_energy_j(), d.potential_energy_j(), d.wave_energy_j(), d.mean_density_ratio(), d.max_density_ratio()});
  crowd_.count([&](SoakTally& tally) {
    tally.nonfinite_count += nonfinite;
    tally.watchdog_nonfinite_count = std::max(tally.watchdog_nonfinite_count, d.nonfinite_count());
  });
}

// What it does

void SoakClient::subscribe(v1::Layer layer, double rate_hz, v1::Level level, v1::Packing packing, bool adapts) {
  v1::ClientMessage message;
  message.mutable_subscribe()->set_layer(layer);
  message.mutable_subscribe()->set_max_rate_hz(rate_hz);
  message.mutable_subscribe()->set_packing(packing);
  message.mutable_subscribe()->set_level(level);
  message.mutable_subscribe()->set_adapts(adapts);
  (void)client_->send(bytesOf(message));
}

void SoakClient::changeLevel() {
  subscribe(kLayers[crowd_.below(std::size(kLayers))], kRates_hz[crowd_.below(std::size(kRates_hz))],
            kLevels[crowd_.below(std::size(kLevels))], crowd_.below(4) == 0 ? v1::PACKING_PLAIN : v1::PACKING_PACKED,
            crowd_.below(2) == 0);
}

void SoakClient::sendWave() {
  v1::ClientMessage message;
  v1::BreakingWave& wave = *message.mutable_command()->mutable_breaking_wave();
  wave.set_side(v1::SIDE_DIRECTION);
  wave.set_direction_deg(crowd_.between(-180.0, 180.0));
  wave.set_amplitude_m(0.1);
  send(std::move(message), false);
}

void SoakClient::beginStroke(Clock::time_point now) {
  points_left_ = kStrokePoints;
  next_point_ = now;
  ++stroke_id_;
  const double direction_rad = crowd_.between(-M_PI, M_PI);
  stroke_x_m_ = crowd_.between(-half_x_m_, half_x_m_);
  stroke_z_m_ = crowd_.between(-half_z_m_, half_z_m_);
  stroke_dx_m_ = kStrokeLength_m / kStrokePoints * std::cos(direction_rad);
  stroke_dz_m_ = kStrokeLength_m / kStrokePoints * std::sin(direction_rad);
}

void SoakClient::continueStroke(Clock::time_point now) {
  --points_left_;
  next_point_ = now + kPointInterval;
  v1::ClientMessage message;
  v1::Stroke& stroke = *message.mutable_command()->mutable_stroke();
  stroke.set_stroke_id(stroke_id_);
  stroke.set_ends(points_left_ == 0);
  v1::StrokePoint& point = *stroke.add_points();
  point.set_time_s(std::chrono::duration<double>(kPointInterval).count() * (kStrokePoints - 1 - points_left_));
  point.set_x_m(std::clamp(stroke_x_m_, -half_x_m_, half_x_m_));
  point.set_z_m(std::clamp(stroke_z_m_, -half_z_m_, half_z_m_));
  stroke_x_m_ += stroke_dx_m_;
  stroke_z_m_ += stroke_dz_m_;
  send(std::move(message), false);
}

void SoakClient::launchOrRemoveBoat() {
  if (boat_max_count_ == 0) return;
  v1::ClientMessage message;
  v1::Command& command = *message.mutable_command();
  if (boat_ != 0) {
    command.mutable_remove_boat()->set_boat_id(boat_);
  } else if (boats_.size() + 1 >= boat_max_count_) {
    // Boats whose owners left stay until somebody takes them away.
    command.mutable_remove_boat()->set_boat_id(
        *std::next(boats_.begin(), static_cast<std::ptrdiff_t>(crowd_.below(boats_.size()))));
  } else {
    v1::Boat& boat = *command.mutable_spawn_boat()->mutable_boat();
    boat.set_x_m(crowd_.between(-half_x_m_, half_x_m_));
    boat.set_z_m(crowd_.between(-half_z_m_, half_z_m_));
    boat.set_heading_deg(crowd_.between(-180.0, 180.0));
    boat.set_length_m(crowd_.between(1.2, 2.4));
  }
  send(std::move(message), true);
}

void SoakClient::steer() {
  v1::ClientMessage message;
  v1::ControlBoat& control = *message.mutable_command()->mutable_control_boat();
  control.set_boat_id(boat_);
  control.set_throttle_ratio(crowd_.between(-1.0, 1.0));
  control.set_rudder_ratio(crowd_.between(-1.0, 1.0));
  send(std::move(message), false);
}

void SoakClient::send(v1::ClientMessage message, bool is_heavy) {
  message.mutable_command()->set_command_id(++last_command_);
  if (!client_->send(bytesOf(message))) return;
  waiting_[last_command_] = {Clock::now(), is_heavy, crowd_.measures};
  crowd_.count([](SoakTally& tally) { ++tally.sent_count; });
}

void SoakClient::giveUpAnswers(Clock::time_point now) {
  while (!waiting_.empty() && now - waiting_.begin()->second.at > kAnswerPatience) {
    waiting_.erase(waiting_.begin());
    crowd_.count([](SoakTally& tally) { ++tally.unanswered_count; });
  }
}

}  // namespace spindrift::bench
