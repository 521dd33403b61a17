// Writes packed frames of a scene to a file, as input for a benchmark of the decoder. Each is a ServerMessage after its
// length (u32, little endian); surface and particles in turn, the first surface a keyframe.
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/gpu/context.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim/water_sim.h>

namespace {

using namespace spindrift;

int failWith(const core::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

bool write(const core::SharedBytes& bytes, std::FILE* out) {
  const auto size = static_cast<std::uint32_t>(bytes->size());
  return std::fwrite(&size, 1, sizeof size, out) == sizeof size && std::fwrite(bytes->data(), 1, size, out) == size;
}

int record(const char* scene_file, std::size_t frame_count, std::FILE* out) {
  auto loaded = scene::loadSceneFile(scene_file, std::nullopt);
  if (!loaded) return failWith(loaded.error());
  const core::Scene scene = scene::toCore(*loaded);
  auto ctx = gpu::Context::create(*gpu::parseDeviceChoice("auto"));
  if (!ctx) return failWith(ctx.error());
  auto sim = sim::WaterSim::create(**ctx, scene);
  if (!sim) return failWith(sim.error());
  codec::FrameEncoder encoder;
  double next_s = 1.0;  // time of the first effect
  for (std::size_t count = 0; count < frame_count;) {
    (*sim)->step();
    if ((*sim)->time_s() + 1e-9 < next_s) continue;
    next_s += 1.0 / scene.stream.frame_rate_hz;
    (void)(*sim)->requestFrame(sim::FrameRequest::full({.surface = true, .particles = true}));
    (*ctx)->finish();
    for (const core::FrameView& frame : (*sim)->takeFrames()) {
      for (const v1::Layer layer : {v1::LAYER_SURFACE, v1::LAYER_PARTICLES}) {
        const codec::EncodedFrame encoded =
            encoder.encode({layer, v1::PACKING_PACKED}, frame, core::Level::kFull, false);
        const core::SharedBytes& bytes = encoded.delta ? encoded.delta : encoded.keyframe;
        if (bytes && !write(bytes, out)) return failWith({core::ErrorCode::kUnavailable, "cannot write"});
      }
      ++count;
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: packed_frames SCENE.textproto FRAMES OUT\n");
    return 2;
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(argv[3], "wb"), &std::fclose);
  if (out == nullptr) {
    std::fprintf(stderr, "cannot write %s\n", argv[3]);
    return 2;
  }
  const int code = record(argv[1], static_cast<std::size_t>(std::atoi(argv[2])), out.get());
  return std::fflush(out.get()) == 0 ? code : 1;
}
