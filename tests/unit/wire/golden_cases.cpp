// The golden cases in one list, so that both languages use the same ones in the same order. The file is long because it
// holds 400 lines of cases.
#include "golden_cases.h"

#include <cstdio>
#include <functional>
#include <limits>
#include <utility>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/crc32c.h>
#include <spindrift/wire/server_message.h>

#include "commands.h"
#include "golden_boats.h"
#include "golden_packed.h"

namespace spindrift::wire {
namespace {

// Inputs are powers of two where they can be, so that decoded values print exactly.
constexpr double kTimeS = 20.5;
constexpr std::uint64_t kTick = 9'007'199'254'740'993;  // 2^53 + 1: a reader that converts it to double loses it

std::string number(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.9g", value);
  return buffer;
}

/// 64-bit integers are strings in JSON, as in Protobuf's own mapping.
std::string wide(std::uint64_t value) {
  return '"' + std::to_string(value) + '"';
}

template <typename Values>
std::string numbers(const Values& values) {
  std::string text = "[";
  for (const auto value : values) text += (text.size() > 1 ? ", " : "") + number(static_cast<double>(value));
  return text + "]";
}

std::vector<std::uint32_t> surfaceWords() {
  std::vector<std::uint32_t> words;
  for (std::int32_t i = 0; i < 256; i += 2) {
    const auto sample = [](std::int32_t k) {
      const std::int32_t value = k == 0 ? -32768 : k == 255 ? 32767 : (k * 97) % 2001 - 1000;
      return static_cast<std::uint32_t>(static_cast<std::uint16_t>(static_cast<std::int16_t>(value)));
    };
    words.push_back(sample(i) | sample(i + 1) << 16);
  }
  return words;
}

core::Bytes surfaceBytes() {
  const std::vector<std::uint32_t> words = surfaceWords();
  core::FrameView frame;
  frame.tick = kTick;
  frame.time_s = kTimeS;
  frame.at(core::Level::kFull).surface = core::SurfaceView{{16, 16}, 8.0, 8.0, 0.0009765625, words};
  return *codec::FrameEncoder().encode(v1::LAYER_SURFACE, frame);
}

/// A frame with a state id; the other golden frames have none.
core::Bytes numberedBytes() {
  const std::vector<std::uint32_t> words = goldenBodyWords();
  core::FrameView frame;
  frame.tick = 1234;
  frame.time_s = kTimeS;
  frame.state_id = kTick + 2;
  frame.bodies = core::BodiesView{2, words};
  return *codec::FrameEncoder().encode(v1::LAYER_BODIES, frame);
}

core::Bytes particleBytes() {
  // Corners, centre, both ends of a velocity, tint and foam.
  const std::vector<std::uint32_t> words = {
      0x0000'0000u, 0x0000'0000u, 0x0000'0000u,  //
      0xFFFF'FFFFu, 0x7F7F'FFFFu, 0x00FF'FF7Fu,  //
      0x8000'8000u, 0x8181'8000u, 0x0080'8081u,  //
      0x0000'FFFFu, 0xFF01'4000u, 0x0001'0240u,  //
      0x1234'5678u, 0xC03F'9ABCu, 0x00C8'64E0u,
  };
  core::ParticleView particles;
  particles.count = 5;
  const double min_m[3] = {-8.0, -1.5, -4.0};
  const double max_m[3] = {8.0, 5.0, 4.0};
  for (int axis = 0; axis < 3; ++axis) {
    particles.min_m[axis] = min_m[axis];
    particles.max_m[axis] = max_m[axis];
  }
  particles.max_speed_mps = 9.0;
  particles.radius_m = 0.0625;
  particles.words = words;
  core::FrameView frame;
  frame.tick = 1234;
  frame.time_s = kTimeS;
  frame.at(core::Level::kFull).particles = particles;
  return *codec::FrameEncoder().encode(v1::LAYER_PARTICLES, frame);
}

/// What wire 1.9 has added: a gauge of the scene, one that a person has placed, and one that has not been read.
core::Bytes gaugeDiagnosticsBytes() {
  core::DiagnosticsView view;
  view.gauges = {{.name = "toe", .x_m = -2.5, .z_m = 0.5, .elevation_m = 0.25, .highest_m = 0.5, .lowest_m = -0.125},
                 {.name = "G7",
                  .x_m = 3,
                  .z_m = -1.5,
                  .gauge_id = 7,
                  .person_id = 2,
                  .elevation_m = -0.0625,
                  .velocity_x_mps = 1.5,
                  .velocity_z_mps = -0.75,
                  .highest_m = 0.125,
                  .lowest_m = -0.25},
                 {.name = "G8", .x_m = 1, .gauge_id = 8, .person_id = 2, .is_unread = true}};
  view.gauges_time_s = 20.25;
  core::FrameView frame;
  frame.tick = 1234;
  frame.time_s = kTimeS;
  frame.diagnostics = view;
  return *codec::FrameEncoder().encode(v1::LAYER_DIAGNOSTICS, frame);
}

core::Bytes diagnosticsBytes() {
  core::DiagnosticsView view;
  view.step_ms = 6.5;
  view.real_time_factor = 0.875;
  view.substeps_count = 3;
  view.particle_count = 8192;
  view.max_particle_speed_mps = 4.25;
  view.max_elevation_m = 0.75;
  view.kinetic_energy_j = 1500.5;
  view.potential_energy_j = -250.25;
  view.wave_energy_j = 10000;
  view.mean_density_ratio = 0.96875;
  view.max_density_ratio = 1.0625;
  view.nonfinite_count = 0;
  view.escaped_count = 1;
  view.recovered_count = kTick;
  view.boat_count = 2;
  view.volume_error_units = -3;
  view.emitted_m3 = 12.5;
  view.absorbed_m3 = 11.75;
  view.breaking_ratio = 0.03125;
  view.passes = {{"grid", 1.25}, {"sph", 4.5}};
  core::FrameView frame;
  frame.tick = 1234;
  frame.time_s = kTimeS;
  frame.diagnostics = view;
  return *codec::FrameEncoder().encode(v1::LAYER_DIAGNOSTICS, frame);
}

core::Bytes serialized(const v1::ServerMessage& message) {
  core::Bytes bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(bytes.data());
  return bytes;
}

core::Bytes foamBytes() {
  std::vector<std::uint32_t> words;
  for (std::uint32_t i = 0; i < 256; i += 4) words.push_back(i | (i + 1) << 8 | (i + 2) << 16 | (i + 3) << 24);
  core::FrameView frame;
  frame.tick = kTick;
  frame.time_s = kTimeS;
  frame.at(core::Level::kFull).foam = core::FoamView{{16, 16}, 8.0, 8.0, words};
  return *codec::FrameEncoder().encode(v1::LAYER_FOAM, frame);
}

core::Bytes bodiesBytes() {
  const std::vector<std::uint32_t> words = goldenBodyWords();
  core::FrameView frame;
  frame.tick = 1234;
  frame.time_s = kTimeS;
  frame.bodies = core::BodiesView{2, words};
  return *codec::FrameEncoder().encode(v1::LAYER_BODIES, frame);
}

/// Written here instead of using greeting(), so that a changed help text does not change the golden bytes.
core::Bytes greetingBytes() {
  v1::ServerMessage message;
  v1::Greeting& out = *message.mutable_greeting();
  out.mutable_version()->set_major(1);
  out.set_server("spindrift 0.1.0");
  out.set_device("golden");
  out.set_room("pool");
  out.set_session_id(kTick);
  out.add_layers(v1::LAYER_SURFACE);
  out.add_layers(v1::LAYER_PARTICLES);
  out.add_layers(v1::LAYER_DIAGNOSTICS);
  out.mutable_limits()->set_message_max_bytes(16384);
  out.mutable_limits()->set_commands_per_s(200);
  out.mutable_limits()->set_frame_rate_max_hz(60);
  v1::Scene& scene = *out.mutable_scene();
  scene.set_name("pool");
  scene.set_title("Pool \xE2\x89\x88 water");
  scene.set_seed(1);
  scene.set_gravity_mps2(9.8125);
  scene.mutable_wave()->set_side_m(16);
  scene.mutable_wave()->set_depth_m(1.5);
  scene.mutable_wave()->set_damping_per_s(0);
  scene.mutable_wave()->set_stencil(v1::STENCIL_NINE_POINT);
  scene.mutable_wave()->set_boundary_minus_x(v1::WAVE_BOUNDARY_REFLECT);
  scene.mutable_wave()->set_boundary_plus_x(v1::WAVE_BOUNDARY_REFLECT);
  scene.mutable_wave()->set_boundary_minus_z(v1::WAVE_BOUNDARY_REFLECT);
  scene.mutable_wave()->set_boundary_plus_z(v1::WAVE_BOUNDARY_ABSORB);
  v1::ParameterDescription& parameter = *out.add_parameters();
  parameter.set_path("wave.damping_per_s");
  parameter.set_label("Wave damping");
  parameter.set_unit("1/s");
  parameter.set_max(5);
  parameter.set_step(0.25);
  parameter.set_default_(0.125);
  parameter.set_help("How fast waves fade.");
  out.set_server_time_s(kTimeS);
  out.mutable_room_state()->set_paused(true);
  out.mutable_room_state()->set_speed(0.5);
  *out.mutable_boat_list() = goldenBoats();
  out.add_scenes("harbour");
  out.add_scenes("pool");
  return serialized(message);
}

core::Bytes damaged(const core::Bytes& good, const std::function<void(v1::LayerFrame&)>& damage) {
  v1::ServerMessage message;
  message.ParseFromArray(good.data(), static_cast<int>(good.size()));
  damage(*message.mutable_frame());
  return serialized(message);
}

std::string frameJson(const v1::LayerFrame& frame, const std::string& layer) {
  return "\"kind\": \"frame\", \"layer\": \"" + layer + "\", \"tick\": " + wide(frame.tick()) +
         ", \"time_s\": " + number(frame.time_s()) +
         ", \"keyframe\": true, \"crc32c\": " + std::to_string(frame.crc32c());
}

std::string surfaceJson(const core::Bytes& bytes) {
  const auto message = codec::parseServerMessage(bytes);
  const auto samples = codec::decodeSurface(message->frame());
  return frameJson(message->frame(), "LAYER_SURFACE") +
         ",\n    \"resolution_count\": 16, \"side_m\": 8, \"quantum_m\": " + number(samples->quantum_m) +
         ",\n    \"elevation_m\": " + numbers(samples->elevation_m);
}

std::string particleJson(const core::Bytes& bytes) {
  const auto message = codec::parseServerMessage(bytes);
  const auto samples = codec::decodeParticles(message->frame());
  return frameJson(message->frame(), "LAYER_PARTICLES") +
         ",\n    \"count\": 5, \"radius_m\": " + number(samples->radius_m) +
         ",\n    \"position_m\": " + numbers(samples->position_m) +
         ",\n    \"velocity_mps\": " + numbers(samples->velocity_mps) + ",\n    \"tint\": " + numbers(samples->tint) +
         ", \"foam\": " + numbers(samples->foam);
}

std::string foamJson(const core::Bytes& bytes) {
  const auto message = codec::parseServerMessage(bytes);
  const auto samples = codec::decodeFoam(message->frame());
  return frameJson(message->frame(), "LAYER_FOAM") +
         ",\n    \"resolution_count\": 16, \"side_m\": 8,\n    \"foam\": " + numbers(samples->foam);
}

std::string bodiesJson(const core::Bytes& bytes) {
  const auto message = codec::parseServerMessage(bytes);
  const auto samples = codec::decodeBodies(message->frame());
  std::string text = frameJson(message->frame(), "LAYER_BODIES") + ", \"count\": 2,\n    \"bodies\": [";
  for (const codec::BodySample& body : *samples) {
    if (text.back() != '[') text += ",\n      ";
    text += "{\"boat_id\": " + std::to_string(body.boat_id) +
            ", \"position_m\": " + numbers(std::vector<double>(body.position_m, body.position_m + 3)) +
            ", \"heading_rad\": " + number(body.heading_rad) + ", \"pitch_rad\": " + number(body.pitch_rad) +
            ", \"roll_rad\": " + number(body.roll_rad) + ", \"speed_mps\": " + number(body.speed_mps) +
            ", \"throttle_ratio\": " + number(body.throttle_ratio) +
            ", \"rudder_ratio\": " + number(body.rudder_ratio) + "}";
  }
  return text + "]";
}

std::string diagnosticsJson() {
  return "\"kind\": \"diagnostics\", \"tick\": \"1234\", \"time_s\": 20.5, \"step_ms\": 6.5, \"real_time_factor\": "
         "0.875,\n"
         "    \"substeps_count\": 3, \"particle_count\": 8192, \"max_particle_speed_mps\": 4.25, \"max_elevation_m\": "
         "0.75,\n"
         "    \"kinetic_energy_j\": 1500.5, \"potential_energy_j\": -250.25, \"wave_energy_j\": 10000,\n"
         "    \"mean_density_ratio\": 0.96875, \"max_density_ratio\": 1.0625, \"nonfinite_count\": \"0\", "
         "\"escaped_count\": \"1\",\n    \"recovered_count\": " +
         wide(kTick) +
         ", \"passes\": [{\"name\": \"grid\", \"ms\": 1.25}, {\"name\": \"sph\", \"ms\": 4.5}],\n"
         "    \"boat_count\": 2, \"volume_error_units\": \"-3\", \"emitted_m3\": 12.5, \"absorbed_m3\": 11.75, "
         "\"breaking_ratio\": 0.03125";
}

std::string gaugeDiagnosticsJson() {
  return "\"kind\": \"diagnostics\", \"tick\": \"1234\", \"time_s\": 20.5, \"gauges_time_s\": 20.25, \"gauges\": [\n"
         "    {\"name\": \"toe\", \"elevation_m\": 0.25, \"velocity_x_mps\": 0, \"velocity_z_mps\": 0, \"highest_m\": "
         "0.5, "
         "\"lowest_m\": -0.125, \"x_m\": -2.5, \"z_m\": 0.5, \"gauge_id\": 0, \"person_id\": 0, \"unread\": false},\n"
         "    {\"name\": \"G7\", \"elevation_m\": -0.0625, \"velocity_x_mps\": 1.5, \"velocity_z_mps\": -0.75, "
         "\"highest_m\": 0.125, \"lowest_m\": -0.25, \"x_m\": 3, \"z_m\": -1.5, \"gauge_id\": 7, \"person_id\": 2, "
         "\"unread\": false},\n"
         "    {\"name\": \"G8\", \"elevation_m\": 0, \"velocity_x_mps\": 0, \"velocity_z_mps\": 0, \"highest_m\": 0, "
         "\"lowest_m\": 0, \"x_m\": 1, \"z_m\": 0, \"gauge_id\": 8, \"person_id\": 2, \"unread\": true}]";
}

std::string greetingJson() {
  return "\"kind\": \"greeting\", \"version\": {\"major\": 1, \"minor\": 0}, \"server\": \"spindrift 0.1.0\", "
         "\"device\": \"golden\", \"room\": \"pool\",\n    \"session_id\": " +
         wide(kTick) +
         ", \"layers\": [\"LAYER_SURFACE\", \"LAYER_PARTICLES\", \"LAYER_DIAGNOSTICS\"],\n"
         "    \"limits\": {\"message_max_bytes\": 16384, \"commands_per_s\": 200, \"frame_rate_max_hz\": 60},\n"
         "    \"scene\": {\"name\": \"pool\", \"title\": \"Pool \\u2248 water\", \"seed\": \"1\", \"gravity_mps2\": "
         "9.8125,\n"
         "      \"wave\": {\"side_m\": 16, \"depth_m\": 1.5, \"damping_per_s\": 0, \"stencil\": "
         "\"STENCIL_NINE_POINT\", "
         "\"boundary_minus_x\": \"WAVE_BOUNDARY_REFLECT\",\n        \"boundary_plus_x\": \"WAVE_BOUNDARY_REFLECT\", "
         "\"boundary_minus_z\": \"WAVE_BOUNDARY_REFLECT\", \"boundary_plus_z\": \"WAVE_BOUNDARY_ABSORB\"}},\n"
         "    \"parameters\": [{\"path\": \"wave.damping_per_s\", \"label\": \"Wave damping\", \"unit\": \"1/s\", "
         "\"min\": 0, "
         "\"max\": 5, \"step\": 0.25,\n      \"default\": 0.125, \"value\": 0, \"help\": \"How fast waves fade.\"}],\n"
         "    \"server_time_s\": 20.5, \"room_state\": {\"paused\": true, \"speed\": 0.5},\n"
         "    \"boat_list\": {\"boats\": " +
         std::string(kGoldenBoatsJson) + "}, \"scenes\": [\"harbour\", \"pool\"]";
}

v1::Draining goldenDraining() {
  v1::Draining out;
  out.set_closes_in_s(1.0);
  out.set_go_to("wss://other.example:8443");
  out.set_reconnect_after_min_s(0.25);
  out.set_reconnect_after_max_s(4.0);
  return out;
}

std::string because(const std::string& why) {
  return "\"why\": \"" + why + "\"";
}

core::Bytes cutInHalf(core::Bytes bytes) {
  bytes.resize(bytes.size() / 2);
  return bytes;
}

}  // namespace

std::vector<GoldenCase> goldenCases() {
  using enum GoldenVerdict;
  const core::Bytes surface = surfaceBytes();
  const core::Bytes particles = particleBytes();
  const core::Bytes foam = foamBytes();
  const core::Bytes bodies = bodiesBytes();
  const auto seal = [](v1::LayerFrame& frame) {
    frame.set_crc32c(
        core::crc32c({reinterpret_cast<const std::uint8_t*>(frame.payload().data()), frame.payload().size()}));
  };
  const auto bad = [](std::string name, const core::Bytes& good, const std::string& why,
                      const std::function<void(v1::LayerFrame&)>& damage) {
    return GoldenCase{"bad_" + std::move(name) + ".bin", kBadFrame, because(why), damaged(good, damage)};
  };
  std::vector<GoldenCase> cases = {
      {"surface_16.bin", kOk, surfaceJson(surface), surface},
      {"particles_5.bin", kOk, particleJson(particles), particles},
      {"diagnostics.bin", kOk, diagnosticsJson(), diagnosticsBytes()},
      {"greeting.bin", kOk, greetingJson(), greetingBytes()},
      {"ack.bin", kOk, "\"kind\": \"ack\", \"command_id\": \"300\", \"applied_tick\": " + wide(kTick),
       *ack(test::ackOf(300, kTick))},
      {"reject.bin", kOk,
       "\"kind\": \"reject\", \"command_id\": \"301\", \"reason\": \"REJECT_REASON_OUT_OF_RANGE\", "
       "\"field\": \"splash.radius_m\", \"message\": \"too wide\"",
       *reject(rejection(v1::REJECT_REASON_OUT_OF_RANGE, "splash.radius_m", "too wide", 301))},
      {"foam_16.bin", kOk, foamJson(foam), foam},
      {"bodies_2.bin", kOk, bodiesJson(bodies), bodies},
      {"bodies_state_id.bin", kOk, "\"state_id\": " + wide(kTick + 2) + ", " + bodiesJson(numberedBytes()),
       numberedBytes()},
      {"ack_boat.bin", kOk, "\"kind\": \"ack\", \"command_id\": \"302\", \"applied_tick\": \"1234\", \"boat_id\": 7",
       *ack(test::ackOf(302, 1234, 7))},
      {"ack_gauge.bin", kOk, "\"kind\": \"ack\", \"command_id\": \"304\", \"applied_tick\": \"1234\", \"gauge_id\": 7",
       *ack(test::ackOf(304, 1234, 0, 0, 7))},
      {"diagnostics_gauges.bin", kOk, gaugeDiagnosticsJson(), gaugeDiagnosticsBytes()},
      {"boat_list.bin", kOk, "\"kind\": \"boat_list\", \"boats\": " + std::string(kGoldenBoatsJson),
       *boatList(goldenBoats())},
      {"room_event.bin", kOk,
       "\"kind\": \"room_event\", \"event\": \"ROOM_EVENT_KIND_RECOVERED\", \"tick\": " + wide(kTick) +
           ", \"message\": \"put back\"",
       *roomEvent(v1::ROOM_EVENT_KIND_RECOVERED, kTick, "put back")},
      {"draining.bin", kOk,
       "\"kind\": \"draining\", \"closes_in_s\": 1, \"go_to\": \"wss://other.example:8443\", "
       "\"reconnect_after_min_s\": 0.25, \"reconnect_after_max_s\": 4",
       *draining(goldenDraining())},
      bad("surface_truncated", surface, "payload two bytes short, checksum of what is there",
          [&](v1::LayerFrame& f) {
            f.mutable_payload()->resize(f.payload().size() - 2);
            seal(f);
          }),
      bad("surface_crc", surface, "wrong checksum", [](v1::LayerFrame& f) { f.set_crc32c(f.crc32c() ^ 1u); }),
      bad("surface_payload", surface, "one bit of the payload flipped",
          [](v1::LayerFrame& f) { (*f.mutable_payload())[100] ^= 0x10; }),
      bad("surface_resolution", surface, "resolution_count above 4096",
          [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_resolution_count(100'000); }),
      bad("surface_quantum", surface, "quantum_m is not a number",
          [](v1::LayerFrame& f) {
            f.mutable_surface_fixed16()->set_quantum_m(std::numeric_limits<double>::quiet_NaN());
          }),
      bad("surface_no_codec", surface, "no codec header", [](v1::LayerFrame& f) { f.clear_codec(); }),
      bad("particles_truncated", particles, "the last particle is cut short, checksum of what is there",
          [&](v1::LayerFrame& f) {
            f.mutable_payload()->resize(f.payload().size() - 5);
            seal(f);
          }),
      bad("particles_count", particles, "count says more particles than the payload holds",
          [](v1::LayerFrame& f) { f.mutable_particles_fixed12()->set_count(6); }),
      bad("particles_count_huge", particles, "count whose size in bytes wraps to the payload's in 32 bits",
          [](v1::LayerFrame& f) { f.mutable_particles_fixed12()->set_count(0x4000'0005u); }),
      bad("particles_bounds", particles, "max_y_m below min_y_m",
          [](v1::LayerFrame& f) { f.mutable_particles_fixed12()->set_max_y_m(-2); }),
      bad("particles_infinite", particles, "max_speed_mps is infinite",
          [](v1::LayerFrame& f) {
            f.mutable_particles_fixed12()->set_max_speed_mps(std::numeric_limits<double>::infinity());
          }),
      bad("foam_truncated", foam, "payload one byte short, checksum of what is there",
          [&](v1::LayerFrame& f) {
            f.mutable_payload()->pop_back();
            seal(f);
          }),
      bad("foam_crc", foam, "wrong checksum", [](v1::LayerFrame& f) { f.set_crc32c(f.crc32c() ^ 1u); }),
      bad("foam_resolution", foam, "resolution_count above 4096",
          [](v1::LayerFrame& f) { f.mutable_foam_fixed8()->set_resolution_count(65'552); }),
      bad("foam_side", foam, "side_m is negative", [](v1::LayerFrame& f) { f.mutable_foam_fixed8()->set_side_m(-8); }),
      bad("bodies_truncated", bodies, "the last boat is cut short, checksum of what is there",
          [&](v1::LayerFrame& f) {
            f.mutable_payload()->resize(f.payload().size() - 2);
            seal(f);
          }),
      bad("bodies_crc", bodies, "wrong checksum", [](v1::LayerFrame& f) { f.set_crc32c(f.crc32c() ^ 1u); }),
      bad("bodies_count", bodies, "count says fewer boats than the payload holds",
          [](v1::LayerFrame& f) { f.mutable_bodies_fixed28()->set_count(1); }),
      bad("bodies_count_huge", bodies, "count whose size in bytes wraps to the payload's in 32 bits",
          [](v1::LayerFrame& f) { f.mutable_bodies_fixed28()->set_count(0x4000'0002u); }),
      bad("bodies_layer", bodies, "the codec of another layer",
          [](v1::LayerFrame& f) { f.mutable_foam_fixed8()->set_resolution_count(1); }),
      {"bad_cut.bin", kBadMessage, because("the first half of surface_16.bin"), cutInHalf(surface)},
      {"bad_empty.bin", kBadMessage, because("no bytes: no kind of message"), {}},
      {"bad_kind.bin",
       kBadMessage,
       because("a kind of message of the future: field 100"),
       {0xA2, 0x06, 0x02, 0x08, 0x01}},
  };
  for (GoldenCase& packed : goldenPackedSurfaces()) cases.push_back(std::move(packed));
  for (GoldenCase& packed : goldenPackedFoam()) cases.push_back(std::move(packed));
  for (GoldenCase& packed : goldenPackedParticles()) cases.push_back(std::move(packed));
  for (GoldenCase& rectangle : goldenRectangles()) cases.push_back(std::move(rectangle));
  for (GoldenCase& floaters : goldenFloaters()) cases.push_back(std::move(floaters));
  return cases;
}

std::string goldenJson(const std::vector<GoldenCase>& cases) {
  std::string text = "[";
  for (const GoldenCase& golden : cases) {
    const char* verdict = golden.verdict == GoldenVerdict::kOk         ? "ok"
                          : golden.verdict == GoldenVerdict::kBadFrame ? "bad_frame"
                                                                       : "bad_message";
    text += text.size() > 1 ? ",\n" : "\n";
    text += "  {\"file\": \"" + golden.file + "\", \"verdict\": \"" + verdict + "\", " + golden.expected_json + "}";
  }
  return text + "\n]\n";
}

}  // namespace spindrift::wire
