// Times of the encoder for recorded frames of a scene, on one core. Recording and measuring are separate, so that two
// builds can be measured in turn on the same frames; equal checksums mean that both wrote the same bytes.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/crc32c.h>
#include <spindrift/gpu/context.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim/water_sim.h>

#include "encode/processor.h"

namespace {

using namespace spindrift;

int failWith(const char* message) {
  std::fprintf(stderr, "%s\n", message);
  return 1;
}

/// The data that a FrameView points to, and its numbers.
struct RecordedFrame {
  core::SurfaceView surface{};
  core::ParticleView particles{};
  std::vector<std::uint32_t> surface_words, particle_words;

  [[nodiscard]] core::FrameView view(std::uint64_t tick) const {
    core::FrameView out;
    out.tick = tick;
    core::LevelView& full = out.at(core::Level::kFull);
    full.surface = surface;
    full.surface->words = surface_words;
    full.particles = particles;
    full.particles->words = particle_words;
    return out;
  }
};

/// The views as in memory, followed by their words: a file only for this machine and this build.
int record(const char* scene_file, std::size_t frame_count, std::FILE* out) {
  auto loaded = scene::loadSceneFile(scene_file, std::nullopt);
  if (!loaded) return failWith(loaded.error().message.c_str());
  const core::Scene scene = scene::toCore(*loaded);
  auto ctx = gpu::Context::create(*gpu::parseDeviceChoice("auto"));
  if (!ctx) return failWith(ctx.error().message.c_str());
  auto sim = sim::WaterSim::create(**ctx, scene);
  if (!sim) return failWith(sim.error().message.c_str());
  if (!scene.wave || !scene.particles) return failWith("the scene has to have a surface and particles");
  double next_s = 1.0;  // time of the first effect
  for (std::size_t count = 0; count < frame_count;) {
    (*sim)->step();
    if ((*sim)->time_s() + 1e-9 < next_s) continue;
    next_s += 1.0 / scene.stream.frame_rate_hz;
    (void)(*sim)->requestFrame(sim::FrameRequest::full({.surface = true, .particles = true}));
    (*ctx)->finish();
    for (const core::FrameView& frame : (*sim)->takeFrames()) {
      const core::SurfaceView& surface = *frame.at(core::Level::kFull).surface;
      const core::ParticleView& particles = *frame.at(core::Level::kFull).particles;
      if (std::fwrite(&surface, sizeof surface, 1, out) != 1 ||
          std::fwrite(&particles, sizeof particles, 1, out) != 1 ||
          std::fwrite(surface.words.data(), 4, surface.words.size(), out) != surface.words.size() ||
          std::fwrite(particles.words.data(), 4, particles.words.size(), out) != particles.words.size())
        return failWith("cannot write");
      ++count;
    }
  }
  return 0;
}

std::vector<RecordedFrame> read(std::FILE* in) {
  std::vector<RecordedFrame> frames;
  RecordedFrame frame;
  while (std::fread(&frame.surface, sizeof frame.surface, 1, in) == 1 &&
         std::fread(&frame.particles, sizeof frame.particles, 1, in) == 1) {
    frame.surface_words.resize((frame.surface.count.total() + 1) / 2);
    frame.particle_words.resize(3 * std::size_t{frame.particles.count});
    if (std::fread(frame.surface_words.data(), 4, frame.surface_words.size(), in) != frame.surface_words.size() ||
        std::fread(frame.particle_words.data(), 4, frame.particle_words.size(), in) != frame.particle_words.size())
      break;
    frames.push_back(frame);
  }
  return frames;
}

double threadCpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// CPU time of each layer's delta frames over the rounds: least and mean time per frame, both averaged over the frames.
int measure(const std::vector<RecordedFrame>& frames, std::size_t rounds) {
  if (frames.size() < 2) return failWith("no frames in that file");
  constexpr std::array kLayers = {v1::LAYER_SURFACE, v1::LAYER_PARTICLES};
  struct Times {
    std::vector<double> least_ms;
    double sum_ms = 0.0, bytes = 0.0;
  };
  std::array<Times, kLayers.size()> times;
  core::Bytes sums;
  for (Times& t : times) t.least_ms.assign(frames.size(), 1e9);
  for (std::size_t round = 0; round < rounds; ++round) {
    codec::FrameEncoder encoder;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const core::FrameView view = frames[i].view(i + 1);
      for (std::size_t layer = 0; layer < kLayers.size(); ++layer) {
        const double begin_ms = threadCpu_ms();
        const codec::EncodedFrame encoded =
            encoder.encode({kLayers[layer], v1::PACKING_PACKED}, view, core::Level::kFull, false);
        const double ms = threadCpu_ms() - begin_ms;
        const core::SharedBytes& bytes = encoded.delta ? encoded.delta : encoded.keyframe;
        if (round == 0) {
          const std::uint32_t crc = core::crc32c(*bytes);
          sums.insert(sums.end(), reinterpret_cast<const std::uint8_t*>(&crc),
                      reinterpret_cast<const std::uint8_t*>(&crc) + sizeof crc);
        }
        if (i == 0) continue;
        times[layer].least_ms[i] = std::min(times[layer].least_ms[i], ms);
        times[layer].sum_ms += ms;
        times[layer].bytes += static_cast<double>(bytes->size());
      }
    }
  }
  const auto measured = static_cast<double>(frames.size() - 1);
  double least_ms = 0.0, mean_ms = 0.0;
  for (std::size_t layer = 0; layer < kLayers.size(); ++layer) {
    double sum = 0.0;
    for (std::size_t i = 1; i < frames.size(); ++i) sum += times[layer].least_ms[i];
    const double mean = times[layer].sum_ms / measured / static_cast<double>(rounds);
    std::printf("%-16s least %.3f ms, mean %.3f ms, %.0f bytes per frame\n", v1::Layer_Name(kLayers[layer]).c_str(),
                sum / measured, mean, times[layer].bytes / measured / static_cast<double>(rounds));
    least_ms += sum / measured;
    mean_ms += mean;
  }
  std::printf("both             least %.3f ms, mean %.3f ms; %zu frames, %zu rounds, check sum %08x\n", least_ms,
              mean_ms, frames.size() - 1, rounds, static_cast<unsigned>(core::crc32c(sums)));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view verb = argc > 1 ? argv[1] : "";
  const bool records = verb == "record" && argc == 5;
  const bool measures = verb == "measure" && (argc == 4 || (argc == 5 && std::string_view(argv[4]) == "plain"));
  if (!records && !measures) {
    std::fprintf(stderr,
                 "usage: encode_times record SCENE.textproto FRAMES FILE\n"
                 "       encode_times measure FILE ROUNDS [plain]   (plain: without AVX2)\n");
    return 2;
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
      std::fopen(records ? argv[4] : argv[2], records ? "wb" : "rb"), &std::fclose);
  if (file == nullptr) return failWith("cannot open that file");
  if (records) {
    const int code = record(argv[2], static_cast<std::size_t>(std::atoi(argv[3])), file.get());
    return std::fflush(file.get()) == 0 ? code : 1;
  }
  if (argc == 5) codec::useVectors(false);
  const std::vector<RecordedFrame> frames = read(file.get());
  return measure(frames, static_cast<std::size_t>(std::atoi(argv[3])));
}
