// Untrusted bytes: random ones, and damaged valid messages. Nothing may crash, and no result may be non-finite. The
// sanitizer presets find errors here that plain runs do not show.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/core/crc32c.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/client_message.h>

#include "golden_cases.h"
#include "invariants.h"

namespace spindrift::wire {
namespace {

using test::isHarmless;
using test::isWhole;

constexpr int kCaseCount = 20'000;

class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  /// 0 <= result < bound; by remainder, because distributions differ between standard libraries.
  std::size_t below(std::size_t bound) { return engine_() % bound; }
  std::uint8_t byte() { return static_cast<std::uint8_t>(engine_()); }
  core::Bytes bytes(std::size_t max_size) {
    core::Bytes out(below(max_size + 1));
    for (std::uint8_t& value : out) value = byte();
    return out;
  }

 private:
  std::mt19937 engine_;
};

/// Makes one to four changes: flips a bit, replaces a byte, cuts the end, inserts or removes bytes.
core::Bytes mutate(core::Bytes bytes, Random& random) {
  for (std::size_t left = 1 + random.below(4); left > 0; --left) {
    if (bytes.empty()) bytes.push_back(random.byte());
    const auto at = static_cast<std::ptrdiff_t>(random.below(bytes.size()));
    switch (random.below(5)) {
      case 0:
        bytes[static_cast<std::size_t>(at)] ^= static_cast<std::uint8_t>(1u << random.below(8));
        break;
      case 1:
        bytes[static_cast<std::size_t>(at)] = random.byte();
        break;
      case 2:
        bytes.resize(static_cast<std::size_t>(at));
        break;
      case 3:
        bytes.insert(bytes.begin() + at, random.byte());
        break;
      default:
        bytes.erase(bytes.begin() + at);
        break;
    }
  }
  return bytes;
}

core::Bytes serialized(const google::protobuf::MessageLite& message) {
  core::Bytes bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(bytes.data());
  return bytes;
}

std::vector<core::Bytes> validClientMessages() {
  std::vector<v1::ClientMessage> messages(20);
  messages[0].mutable_hello()->mutable_version()->set_major(1);
  messages[0].mutable_hello()->set_client("hostile \xC3\xA9");
  messages[1].mutable_subscribe()->set_layer(v1::LAYER_SURFACE);
  messages[1].mutable_subscribe()->set_max_rate_hz(30);
  messages[2].mutable_ping()->set_client_time_s(12.5);
  for (std::size_t i = 3; i < messages.size(); ++i) messages[i].mutable_command()->set_command_id(i);
  v1::Splash& splash = *messages[3].mutable_command()->mutable_splash();
  splash.set_x_m(1);
  splash.set_radius_m(2);
  v1::BreakingWave& wave = *messages[4].mutable_command()->mutable_breaking_wave();
  wave.set_side(v1::SIDE_MINUS_Z);
  wave.set_amplitude_m(0.5);
  messages[5].mutable_command()->mutable_set_parameter()->set_path("particles.viscosity_pas");
  messages[5].mutable_command()->mutable_set_parameter()->set_value(20);
  messages[6].mutable_command()->mutable_reset();
  messages[7].mutable_command()->mutable_set_paused()->set_paused(true);
  messages[8].mutable_command()->mutable_set_speed()->set_speed(2);
  v1::Boat& boat = *messages[9].mutable_command()->mutable_spawn_boat()->mutable_boat();
  boat.set_x_m(3);
  boat.set_heading_deg(-90);
  messages[10].mutable_command()->mutable_control_boat()->set_boat_id(1);
  messages[10].mutable_command()->mutable_control_boat()->set_throttle_ratio(0.5);
  messages[11].mutable_command()->mutable_remove_boat()->set_boat_id(1);
  messages[12].mutable_command()->mutable_step()->set_tick_count(10);
  messages[13].mutable_command()->mutable_change_scene()->set_name("harbour");
  v1::Floater& floater = *messages[14].mutable_command()->mutable_spawn_floater()->mutable_floater();
  floater.set_kind(v1::FLOATER_KIND_BARREL);
  floater.set_size_m(0.5);
  messages[15].mutable_command()->mutable_hold_floater()->set_floater_id(1);
  messages[15].mutable_command()->mutable_hold_floater()->set_x_m(2);
  messages[16].mutable_command()->mutable_remove_floater()->set_floater_id(1);
  messages[17].mutable_command()->mutable_place_gauge()->set_x_m(-2);
  messages[18].mutable_command()->mutable_remove_gauge()->set_gauge_id(1);
  v1::Query& query = *messages[19].mutable_command()->mutable_query();
  query.set_interval_ticks(1);
  for (const float x_m : {-1.5F, 2.0F}) {
    query.add_x_m(x_m);
    query.add_z_m(-x_m);
  }
  query.add_velocity_z_mps(0.5F);
  std::vector<core::Bytes> out;
  for (const v1::ClientMessage& message : messages) out.push_back(serialized(message));
  return out;
}

v1::Scene fullScene() {
  const auto scene = scene::parseSceneText(
      "wave {} particles {} coupling {} foam {} boats {} floaters {} obstacles { rock { x_m: 4 } }",
      "hostile.textproto");
  EXPECT_TRUE(scene);
  return *scene;
}

TEST(HostileBytes, RandomClientMessagesDoNoHarm) {
  Random random(1);
  for (int i = 0; i < kCaseCount; ++i) ASSERT_TRUE(isHarmless(parseClientMessage(random.bytes(200)))) << "case " << i;
}

TEST(HostileBytes, DamagedClientMessagesDoNoHarm) {
  Random random(2);
  const std::vector<core::Bytes> valid = validClientMessages();
  const v1::Scene scene = fullScene();
  std::vector<int> answer_counts(std::variant_size_v<ClientMessage>, 0);
  for (int i = 0; i < kCaseCount; ++i) {
    const ClientMessage message = parseClientMessage(mutate(valid[random.below(valid.size())], random));
    ASSERT_TRUE(isHarmless(message)) << "case " << i;
    ++answer_counts[message.index()];
    if (const auto* command = std::get_if<v1::Command>(&message)) {
      v1::Command completed = *command;
      const auto rejection = completeCommand(completed, scene);
      ASSERT_TRUE(!rejection || !rejection->message().empty()) << "case " << i;
      ASSERT_TRUE(test::isChecked(completed)) << "case " << i;
    }
  }
  // Otherwise the damage would be too coarse to test the code after the parser.
  for (std::size_t answer = 0; answer < answer_counts.size(); ++answer) EXPECT_GT(answer_counts[answer], 50) << answer;
}

TEST(HostileBytes, RandomServerMessagesDoNoHarm) {
  Random random(3);
  for (int i = 0; i < kCaseCount; ++i) {
    const auto message = codec::parseServerMessage(random.bytes(200));
    if (!message) {
      ASSERT_FALSE(message.error().message.empty());
    } else {
      ASSERT_NE(message->message_case(), v1::ServerMessage::MESSAGE_NOT_SET);
    }
  }
}

TEST(HostileBytes, DamagedFramesDecodeToFiniteValues) {
  Random random(4);
  const std::vector<GoldenCase> golden = goldenCases();
  int decoded_count = 0;
  int refused_count = 0;
  for (int i = 0; i < kCaseCount; ++i) {
    auto message = codec::parseServerMessage(mutate(golden[random.below(golden.size())].bytes, random));
    if (!message || !message->has_frame()) continue;
    v1::LayerFrame& frame = *message->mutable_frame();
    // A wrong checksum would refuse almost every case, so half of them get the right one and reach the checks after it.
    if (random.below(2) == 0) {
      frame.set_crc32c(
          core::crc32c({reinterpret_cast<const std::uint8_t*>(frame.payload().data()), frame.payload().size()}));
    }
    codec::PackedSurfaceDecoder packed;
    codec::PackedFoamDecoder packed_foam;
    if (const auto surface = frame.has_surface_predicted() ? packed.decode(frame) : codec::decodeSurface(frame)) {
      ++decoded_count;
      ASSERT_TRUE(isWhole(*surface)) << "case " << i;
    } else if (const auto particles = frame.has_particles_by_cell() ? codec::decodePackedParticles(frame)
                                                                    : codec::decodeParticles(frame)) {
      ++decoded_count;
      ASSERT_TRUE(isWhole(*particles)) << "case " << i;
    } else if (const auto foam = frame.has_foam_predicted() ? packed_foam.decode(frame) : codec::decodeFoam(frame)) {
      ++decoded_count;
      ASSERT_TRUE(isWhole(*foam)) << "case " << i;
    } else if (const auto bodies = codec::decodeBodies(frame)) {
      ++decoded_count;
      ASSERT_EQ(bodies->size(), frame.bodies_fixed28().count());
    } else if (const auto floaters = frame.has_floaters_predicted() ? codec::PackedFloaterDecoder().decode(frame)
                                                                    : codec::decodeFloaters(frame)) {
      ++decoded_count;
      ASSERT_TRUE(isWhole(*floaters)) << "case " << i;
    } else {
      ++refused_count;
    }
  }
  EXPECT_GT(decoded_count, 200);
  EXPECT_GT(refused_count, 200);
}

TEST(HostileBytes, DamagedScenesLoadCheckedOrNotAtAll) {
  Random random(5);
  const std::string valid =
      "name: 'pool' gravity_mps2: 9.81\nwave { resolution_count: 64 depth_m: 1.5 stencil: STENCIL_NINE_POINT }\n"
      "particles { count: 100 boundary_x: BOUNDARY_WALL }\ncoupling { lattice_count: 3 }\nfoam { lifetime_s: 1e0 }\n"
      "events { at_s: 1 effect { splash { x_m: -2 depth_m: 0.4 } } }\n"
      "obstacles { rock { x_m: 5 } }\nboats { boats { z_m: -3 } }\nfloaters { floaters { x_m: 2 } }\nstorm { "
      "level_ratio: 0.5 }\n";
  int loaded_count = 0;
  for (int i = 0; i < 2'000; ++i) {
    const core::Bytes bytes = mutate(core::Bytes(valid.begin(), valid.end()), random);
    const auto scene =
        scene::parseSceneText({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "pool.textproto");
    if (!scene) {
      ASSERT_EQ(scene.error().message.find("pool.textproto:"), 0u) << "case " << i;
      continue;
    }
    ++loaded_count;
    const core::Scene core_scene = scene::toCore(*scene);
    ASSERT_TRUE(std::isfinite(core_scene.gravity_mps2)) << "case " << i;
    ASSERT_TRUE(core_scene.wave || core_scene.particles) << "case " << i;
    ASSERT_TRUE(!core_scene.wave || std::isfinite(core_scene.wave->depth_m)) << "case " << i;
  }
  EXPECT_GT(loaded_count, 20);
}

}  // namespace
}  // namespace spindrift::wire
