#include "golden_packed.h"

#include <cstdio>
#include <utility>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/crc32c.h>

namespace spindrift::wire {
namespace {

constexpr std::uint32_t kSide = 20;  // tiles of 8 do not fit evenly

/// Integers only, so that all machines give the same: a moving slope, noise in one corner, a spike.
std::vector<std::uint32_t> wordsAt(std::int32_t step) {
  std::vector<std::uint32_t> words(kSide * kSide / 2);
  std::uint32_t noise = 1u + static_cast<std::uint32_t>(step);
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(kSide * kSide); ++i) {
    const std::int32_t x = i % 20, z = i / 20;
    noise = noise * 1664525u + 1013904223u;
    std::int32_t value = (x - 2 * step) * (x - 2 * step) - z * (12 - step);
    if (x > 12 && z > 12) value += static_cast<std::int32_t>(noise >> 20) - 2048;
    if (x < 4 && z < 4) value = 0;
    if (i == 150) value = step == 1 ? 32767 : -32768;
    words[static_cast<std::size_t>(i) / 2] |=
        static_cast<std::uint32_t>(static_cast<std::uint16_t>(static_cast<std::int16_t>(value))) << (16 * (i % 2));
  }
  return words;
}

std::string jsonOf(const v1::LayerFrame& frame, const codec::SurfaceSamples& samples, const std::string& follows) {
  std::string text =
      "\"kind\": \"frame\", \"layer\": \"LAYER_SURFACE\", \"packing\": \"PACKING_PACKED\", \"tick\": \"" +
      std::to_string(frame.tick()) + "\", \"time_s\": 20.5, \"keyframe\": " + (frame.keyframe() ? "true" : "false") +
      ",\n    \"follows\": \"" + follows +
      "\", \"resolution_count\": 20, \"side_m\": 8, \"quantum_m\": 0.0009765625,\n    \"elevation_m\": [";
  for (std::size_t i = 0; i < samples.elevation_m.size(); ++i) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%s%.9g", i > 0 ? ", " : "", static_cast<double>(samples.elevation_m[i]));
    text += buffer;
  }
  return text + "]";
}

GoldenCase damagedCase(const std::string& name, const std::string& why, const core::Bytes& good,
                       void (*damage)(v1::LayerFrame&)) {
  v1::ServerMessage message = *codec::parseServerMessage(good);
  v1::LayerFrame& frame = *message.mutable_frame();
  damage(frame);
  frame.set_crc32c(
      core::crc32c({reinterpret_cast<const std::uint8_t*>(frame.payload().data()), frame.payload().size()}));
  core::Bytes bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(bytes.data());
  return {name, GoldenVerdict::kBadFrame, "\"why\": \"" + why + "\"", std::move(bytes)};
}

/// A lattice in a corner, many particles at one position, single drops, with various speeds.
std::vector<std::uint32_t> particleWords() {
  std::vector<std::uint32_t> words;
  std::uint32_t noise = 1;
  const auto add = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    noise = noise * 1664525u + 1013904223u;
    words.push_back(x | z << 16);
    words.push_back(y | (noise >> 27) << 16 | (0xF0u + (noise >> 29)) << 24);
    words.push_back((noise >> 26 & 0x3Fu) | (200u + (noise >> 28)) << 8 | (noise >> 31) * 255u << 16);
  };
  for (std::uint32_t i = 0; i < 125; ++i) add(1000 + i % 5 * 820, 300 + i / 25 * 810, 700 + i / 5 % 5 * 830);
  for (std::uint32_t i = 0; i < 9; ++i) add(40000 + i, 50000, 60000);
  for (std::uint32_t i = 0; i < 20; ++i) add(i * 3276, 65535 - i * 3000, i * i * 160);
  return words;
}

}  // namespace

std::vector<GoldenCase> goldenPackedFoam() {
  codec::FrameEncoder encoder;
  codec::PackedFoamDecoder decoder;
  std::vector<GoldenCase> cases;
  for (std::uint32_t step = 0; step < 2; ++step) {
    // Fading streaks with white spots, 12 samples per side.
    std::vector<std::uint32_t> words(36);
    for (std::uint32_t i = 0; i < 144; ++i) {
      const std::uint32_t white = i % 31 == step ? 255u : (i / 12 % 4 == 0 ? 180u - 20u * step : i % 12 * 3);
      words[i / 4] |= white << (8 * (i % 4));
    }
    core::FrameView view;
    view.tick = 100 + 2 * step;
    view.time_s = 20.5;
    view.at(core::Level::kFull).foam = core::FoamView{{12, 12}, 8.0, 8.0, words};
    const codec::EncodedFrame encoded =
        encoder.encode({v1::LAYER_FOAM, v1::PACKING_PACKED}, view, core::Level::kFull, false);
    const core::Bytes& bytes = encoded.keyframe ? *encoded.keyframe : *encoded.delta;
    const v1::LayerFrame frame = codec::parseServerMessage(bytes)->frame();
    const std::string follows = step > 0 ? cases.back().file : "";
    const std::string json =
        "\"kind\": \"frame\", \"layer\": \"LAYER_FOAM\", \"packing\": \"PACKING_PACKED\", \"tick\": \"" +
        std::to_string(frame.tick()) + "\", \"time_s\": 20.5, \"keyframe\": " + (frame.keyframe() ? "true" : "false") +
        ",\n    \"follows\": \"" + follows +
        "\", \"resolution_count\": 12, \"side_m\": 8,\n    \"foam\": " + numbersOf(decoder.decode(frame)->foam);
    cases.push_back({"foam_packed_" + std::to_string(step) + ".bin", GoldenVerdict::kOk, json, bytes});
  }
  cases.push_back(damagedCase("bad_foam_packed_cut.bin", "the packed payload is cut, checksum of what is there",
                              cases.front().bytes,
                              [](v1::LayerFrame& f) { f.mutable_payload()->resize(f.payload().size() - 3); }));
  return cases;
}

std::vector<GoldenCase> goldenPackedParticles() {
  const std::vector<std::uint32_t> words = particleWords();
  core::ParticleView particles;
  particles.count = static_cast<std::uint32_t>(words.size() / 3);
  for (double& min : particles.min_m) min = -4.0;
  for (double& max : particles.max_m) max = 4.0;
  particles.max_speed_mps = 8.0;
  particles.radius_m = 0.0625;
  particles.words = words;
  core::FrameView view;
  view.tick = 1234;
  view.time_s = 20.5;
  view.at(core::Level::kFull).particles = particles;
  const core::Bytes bytes =
      *codec::FrameEncoder().encode({v1::LAYER_PARTICLES, v1::PACKING_PACKED}, view, core::Level::kFull, true).keyframe;
  const auto samples = *codec::decodePackedParticles(codec::parseServerMessage(bytes)->frame());
  const std::string json =
      "\"kind\": \"frame\", \"layer\": \"LAYER_PARTICLES\", \"packing\": \"PACKING_PACKED\", "
      "\"tick\": \"1234\", \"time_s\": 20.5, \"keyframe\": true,\n    \"count\": " +
      std::to_string(samples.count) + ", \"radius_m\": 0.0625,\n    \"position_m\": " + numbersOf(samples.position_m) +
      ",\n    \"velocity_mps\": " + numbersOf(samples.velocity_mps) + ",\n    \"tint\": " + numbersOf(samples.tint) +
      ", \"foam\": " + numbersOf(samples.foam);
  std::vector<GoldenCase> cases = {{"particles_packed.bin", GoldenVerdict::kOk, json, bytes}};
  cases.push_back(damagedCase("bad_particles_packed_cut.bin", "the packed payload is cut, checksum of what is there",
                              bytes, [](v1::LayerFrame& f) { f.mutable_payload()->resize(f.payload().size() - 7); }));
  cases.push_back(damagedCase(
      "bad_particles_packed_count.bin", "count says one particle more than the payload holds", bytes,
      [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_count(f.particles_by_cell().count() + 1); }));
  cases.push_back(damagedCase("bad_particles_packed_cells.bin", "2^27 cells", bytes, [](v1::LayerFrame& f) {
    f.mutable_particles_by_cell()->set_cells_x_count(1024);
    f.mutable_particles_by_cell()->set_cells_y_count(512);
    f.mutable_particles_by_cell()->set_cells_z_count(256);
  }));
  return cases;
}

std::vector<GoldenCase> goldenPackedSurfaces() {
  codec::FrameEncoder encoder;
  codec::PackedSurfaceDecoder decoder;
  std::vector<GoldenCase> cases;
  for (std::int32_t step = 0; step < 3; ++step) {
    const std::vector<std::uint32_t> words = wordsAt(step);
    core::FrameView view;
    view.tick = 100 + 2 * static_cast<std::uint64_t>(step);
    view.time_s = 20.5;
    view.at(core::Level::kFull).surface = core::SurfaceView{{kSide, kSide}, 8.0, 8.0, 0.0009765625, words};
    const codec::EncodedFrame encoded =
        encoder.encode({v1::LAYER_SURFACE, v1::PACKING_PACKED}, view, core::Level::kFull, false);
    const core::Bytes& bytes = encoded.keyframe ? *encoded.keyframe : *encoded.delta;
    const v1::LayerFrame frame = codec::parseServerMessage(bytes)->frame();
    const std::string follows = step > 0 ? cases.back().file : "";
    cases.push_back({"surface_packed_" + std::to_string(step) + ".bin", GoldenVerdict::kOk,
                     jsonOf(frame, *decoder.decode(frame), follows), bytes});
  }
  const core::Bytes key = cases.front().bytes;  // a copy, because the list grows below
  cases.push_back(damagedCase("bad_surface_packed_cut.bin",
                              "the packed payload is cut in half, checksum of what is there", key,
                              [](v1::LayerFrame& f) { f.mutable_payload()->resize(f.payload().size() / 2); }));
  cases.push_back(
      damagedCase("bad_surface_packed_weights.bin", "nine weights instead of ten", key,
                  [](v1::LayerFrame& f) { f.mutable_surface_predicted()->mutable_weights()->RemoveLast(); }));
  cases.push_back(damagedCase("bad_surface_packed_longer.bin", "a byte too many behind the raw bits", key,
                              [](v1::LayerFrame& f) { f.mutable_payload()->push_back('\0'); }));
  return cases;
}

}  // namespace spindrift::wire
