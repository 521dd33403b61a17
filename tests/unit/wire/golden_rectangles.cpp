// Planes with other numbers of samples along x and z, plain and packed.
#include <cstdio>
#include <utility>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/crc32c.h>

#include "golden_packed.h"

namespace spindrift::wire {
namespace {

constexpr core::CellCounts kCount{21, 5};  // tiles of 8 do not fit evenly, and the number of samples is odd
constexpr core::CellCounts kFoamCount{11, 3};
constexpr double kLength_m = 10.5;
constexpr double kWidth_m = 2.5;

/// Integers only, so that all machines give the same: a slope that moves along x.
std::vector<std::uint32_t> surfaceAt(std::int32_t step) {
  std::vector<std::uint32_t> words((kCount.total() + 1) / 2);
  for (std::uint32_t i = 0; i < kCount.total(); ++i) {
    const auto x = static_cast<std::int32_t>(i % kCount.x), z = static_cast<std::int32_t>(i / kCount.x);
    const std::int32_t value = (x - 3 * step) * (x - 3 * step) - 7 * z + (x == 4 && z == 4 ? -500 : 0);
    words[i / 2] |= static_cast<std::uint32_t>(static_cast<std::uint16_t>(static_cast<std::int16_t>(value)))
                    << (16 * (i % 2));
  }
  return words;
}

std::vector<std::uint32_t> foamAt(std::uint32_t step) {
  std::vector<std::uint32_t> words((kFoamCount.total() + 3) / 4);
  for (std::uint32_t i = 0; i < kFoamCount.total(); ++i) words[i / 4] |= ((23 * i + 9 * step) % 256) << (8 * (i % 4));
  return words;
}

std::string headOf(const v1::LayerFrame& frame, const char* layer, bool is_packed, const std::string& follows) {
  std::string text = std::string("\"kind\": \"frame\", \"layer\": \"") + layer + "\", ";
  if (is_packed) text += "\"packing\": \"PACKING_PACKED\", ";
  text += "\"tick\": \"" + std::to_string(frame.tick()) +
          "\", \"time_s\": 20.5, \"keyframe\": " + (frame.keyframe() ? "true" : "false");
  if (is_packed) text += ",\n    \"follows\": \"" + follows + "\"";
  if (!is_packed) text += ", \"crc32c\": " + std::to_string(frame.crc32c());
  return text;
}

template <typename Samples>
std::string extentsOf(const Samples& samples) {
  char buffer[160];
  std::snprintf(buffer, sizeof buffer,
                ",\n    \"resolution_count\": %u, \"count_z\": %u, \"side_m\": %.9g, \"width_m\": %.9g",
                samples.count.x, samples.count.z, samples.length_m, samples.width_m);
  return buffer;
}

std::string jsonOf(const v1::LayerFrame& frame, const codec::SurfaceSamples& samples, bool is_packed,
                   const std::string& follows) {
  return headOf(frame, "LAYER_SURFACE", is_packed, follows) + extentsOf(samples) +
         ", \"quantum_m\": 0.0009765625,\n    \"elevation_m\": " + numbersOf(samples.elevation_m);
}

std::string jsonOf(const v1::LayerFrame& frame, const codec::FoamSamples& samples, bool is_packed,
                   const std::string& follows) {
  return headOf(frame, "LAYER_FOAM", is_packed, follows) + extentsOf(samples) +
         ",\n    \"foam\": " + numbersOf(samples.foam);
}

GoldenCase damaged(const std::string& name, const std::string& why, const core::Bytes& good,
                   void (*damage)(v1::LayerFrame&)) {
  v1::ServerMessage message = *codec::parseServerMessage(good);
  damage(*message.mutable_frame());
  core::Bytes bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(bytes.data());
  return {name, GoldenVerdict::kBadFrame, "\"why\": \"" + why + "\"", std::move(bytes)};
}

}  // namespace

std::vector<GoldenCase> goldenRectangles() {
  codec::FrameEncoder encoder;
  codec::PackedSurfaceDecoder surfaces;
  codec::PackedFoamDecoder foams;
  std::vector<GoldenCase> cases;
  std::string surface_before, foam_before;
  for (std::uint32_t step = 0; step < 2; ++step) {
    const auto surface_words = surfaceAt(static_cast<std::int32_t>(step));
    const auto foam_words = foamAt(step);
    core::FrameView view;
    view.tick = 100 + 2 * step;
    view.time_s = 20.5;
    view.at(core::Level::kFull).surface = core::SurfaceView{kCount, kLength_m, kWidth_m, 0.0009765625, surface_words};
    view.at(core::Level::kFull).foam = core::FoamView{kFoamCount, kLength_m, kWidth_m, foam_words};
    const auto encoded = [&](v1::Layer layer, v1::Packing packing) {
      const codec::EncodedFrame out = encoder.encode({layer, packing}, view, core::Level::kFull, false);
      return out.keyframe ? *out.keyframe : *out.delta;
    };
    const auto frameOf = [](const core::Bytes& bytes) { return codec::parseServerMessage(bytes)->frame(); };
    if (step == 0) {
      const core::Bytes surface = encoded(v1::LAYER_SURFACE, v1::PACKING_PLAIN);
      cases.push_back({"surface_21x5.bin", GoldenVerdict::kOk,
                       jsonOf(frameOf(surface), *codec::decodeSurface(frameOf(surface)), false, ""), surface});
      const core::Bytes foam = encoded(v1::LAYER_FOAM, v1::PACKING_PLAIN);
      cases.push_back({"foam_11x3.bin", GoldenVerdict::kOk,
                       jsonOf(frameOf(foam), *codec::decodeFoam(frameOf(foam)), false, ""), foam});
    }
    const core::Bytes surface = encoded(v1::LAYER_SURFACE, v1::PACKING_PACKED);
    std::string name = "surface_packed_21x5_" + std::to_string(step) + ".bin";
    cases.push_back({name, GoldenVerdict::kOk,
                     jsonOf(frameOf(surface), *surfaces.decode(frameOf(surface)), true, surface_before), surface});
    surface_before = std::exchange(name, "foam_packed_11x3_" + std::to_string(step) + ".bin");
    const core::Bytes foam = encoded(v1::LAYER_FOAM, v1::PACKING_PACKED);
    cases.push_back(
        {name, GoldenVerdict::kOk, jsonOf(frameOf(foam), *foams.decode(frameOf(foam)), true, foam_before), foam});
    foam_before = name;
  }
  const core::Bytes plain = cases.front().bytes;  // a copy, because the list grows below
  cases.push_back(damaged("bad_surface_count_z.bin", "count_z says a row more than the payload holds", plain,
                          [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_count_z(6); }));
  cases.push_back(damaged("bad_surface_count_z_huge.bin", "count_z above 4096", plain,
                          [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_count_z(4097); }));
  cases.push_back(damaged("bad_surface_width.bin", "a negative width", plain,
                          [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_width_m(-2.5); }));
  return cases;
}

}  // namespace spindrift::wire
