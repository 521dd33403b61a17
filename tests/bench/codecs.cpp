#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <spindrift/bench/codecs.h>
#include <spindrift/bench/levels.h>
#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>
#include <spindrift/sim/water_sim.h>

#include "baselines.h"

namespace spindrift::bench {
namespace {

using Clock = std::chrono::steady_clock;

double sinceMs(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// Sums over all frames for one layer and one codec.
struct CodecRow {
  std::string name;
  std::size_t frame_count = 0;
  double bytes = 0.0;
  double most_bytes = 0.0;  ///< of the largest frame
  double item_count = 0.0;  ///< samples, particles
  double encode_ms = 0.0;
  double decode_ms = 0.0;
  double max_error = 0.0;  ///< in quanta; for particles: distance along an axis
  /// Lower bounds for unordered positions, in bits for the items of all frames: as dense as resting water, and with the
  /// same number anywhere in the box.
  std::optional<double> bound_bits = {};
  double sparse_bits = 0.0;
  bool is_installed = true;

  void add(std::size_t frame_bytes, std::size_t items) {
    ++frame_count;
    bytes += static_cast<double>(frame_bytes);
    most_bytes = std::max(most_bytes, static_cast<double>(frame_bytes));
    item_count += static_cast<double>(items);
  }
  /// Adds the result of a codec that may not be installed. `error`: that of the quantized input, in quanta; infinite if
  /// the decoded data differs from the input.
  void add(const std::optional<BaselineResult>& result, std::size_t items, double error) {
    is_installed = result.has_value();
    add(result ? result->bytes : 0, items);
    if (!result) return;
    encode_ms += result->encode_ms;
    decode_ms += result->decode_ms;
    max_error = std::max(max_error, result->is_exact ? error : std::numeric_limits<double>::infinity());
  }
  [[nodiscard]] double itemBits() const { return item_count > 0 ? 8 * bytes / item_count : 0.0; }
};

v1::LayerFrame frameOf(const core::SharedBytes& bytes) {
  return codec::parseServerMessage(*bytes)->frame();
}

/// The rows of a scene's surface and particles, filled frame by frame.
class CodecMeter {
 public:
  core::Result<void> add(const core::FrameView& frame) {
    if (frame.at(core::Level::kFull).surface) {
      if (auto done = addSurface(frame); !done) return done;
    }
    if (const auto& particles = frame.at(core::Level::kFull).particles; particles && particles->count > 0) {
      if (auto done = addParticles(frame); !done) return done;
    }
    if (frame.floaters && frame.floaters->count > 0) {
      if (auto done = addFloaters(frame); !done) return done;
    }
    return {};
  }
  [[nodiscard]] std::vector<CodecRow> rows() const {
    std::vector<CodecRow> rows;
    for (const CodecRow& row : {surface_plain_, surface_deflated_, surface_zstd_, surface_whole_, surface_,
                                particles_plain_, particles_deflated_, particles_zstd_, particles_,
                                places_meshoptimizer_, places_draco_, places_, floaters_plain_, floaters_whole_}) {
      if (row.frame_count > 0) rows.push_back(row);
    }
    for (const FloaterLevel& at : floaters_) {
      if (at.row.frame_count > 0) rows.push_back(at.row);
    }
    return rows;
  }

 private:
  core::Result<void> addSurface(const core::FrameView& frame) {
    const core::SurfaceView& view = *frame.at(core::Level::kFull).surface;
    const std::size_t samples = 2 * view.words.size();
    auto begin = Clock::now();
    const core::SharedBytes plain = encoder_.encode(v1::LAYER_SURFACE, frame);
    surface_plain_.encode_ms += sinceMs(begin);
    begin = Clock::now();
    const auto plain_samples = codec::decodeSurface(frameOf(plain));
    surface_plain_.decode_ms += sinceMs(begin);
    surface_plain_.add(plain->size(), samples);
    surface_deflated_.add(deflate(view.words), samples, 0.0);
    surface_zstd_.add(zstd(view.words), samples, 0.0);

    // The delta is encoded as in a room; the keyframe by a separate encoder, so that the times stay apart.
    const codec::Stream packed{v1::LAYER_SURFACE, v1::PACKING_PACKED};
    begin = Clock::now();
    const codec::EncodedFrame encoded = encoder_.encode(packed, frame, core::Level::kFull, false);
    const double encode_ms = sinceMs(begin);
    codec::FrameEncoder fresh;
    begin = Clock::now();
    const codec::EncodedFrame whole = fresh.encode(packed, frame, core::Level::kFull, true);
    surface_whole_.encode_ms += sinceMs(begin);
    surface_whole_.add(whole.keyframe->size(), samples);
    const v1::LayerFrame message = frameOf(encoded.delta ? encoded.delta : encoded.keyframe);
    begin = Clock::now();
    const auto packed_samples = decoder_.decode(message);
    const double decode_ms = sinceMs(begin);
    if (!packed_samples) return packed_samples.error();
    if (!encoded.delta) return {};
    surface_.encode_ms += encode_ms;
    surface_.decode_ms += decode_ms;
    surface_.add(encoded.delta->size(), samples);
    for (std::size_t i = 0; i < samples; ++i) {
      const double error_m = std::abs(packed_samples->elevation_m[i] - plain_samples->elevation_m[i]);
      surface_.max_error = std::max(surface_.max_error, error_m / view.quantum_m);
    }
    return {};
  }

  core::Result<void> addParticles(const core::FrameView& frame) {
    const core::ParticleView& view = *frame.at(core::Level::kFull).particles;
    auto begin = Clock::now();
    const core::SharedBytes plain = encoder_.encode(v1::LAYER_PARTICLES, frame);
    particles_plain_.encode_ms += sinceMs(begin);
    begin = Clock::now();
    const auto plain_samples = codec::decodeParticles(frameOf(plain));
    particles_plain_.decode_ms += sinceMs(begin);
    particles_plain_.add(plain->size(), view.count);
    particles_deflated_.add(deflate(view.words), view.count, 0.0);
    particles_zstd_.add(zstd(view.words), view.count, 0.0);

    begin = Clock::now();
    const codec::EncodedFrame encoded =
        encoder_.encode({v1::LAYER_PARTICLES, v1::PACKING_PACKED}, frame, core::Level::kFull, true);
    particles_.encode_ms += sinceMs(begin);
    const v1::LayerFrame message = frameOf(encoded.keyframe);
    begin = Clock::now();
    const auto samples = codec::decodePackedParticles(message);
    particles_.decode_ms += sinceMs(begin);
    if (!samples) return samples.error();
    particles_.add(encoded.keyframe->size(), view.count);
    const v1::ParticlesByCell& header = message.particles_by_cell();
    const double quantum_m = header.cell_m() / (1 << header.offset_bits());
    particles_.bound_bits = 3 * std::log2(2 * view.radius_m / quantum_m) + std::log2(std::exp(1.0));
    particles_.sparse_bits += sparseBits(view, quantum_m);
    particles_.max_error =
        std::max(particles_.max_error, largestShift(plain_samples->position_m, samples->position_m) / quantum_m);
    addPlaces(frame, header, plain_samples->position_m);
    return {};
  }

  core::Result<void> addFloaters(const core::FrameView& frame) {
    const std::size_t count = frame.floaters->count;
    auto begin = Clock::now();
    const core::SharedBytes plain = encoder_.encode(v1::LAYER_FLOATERS, frame);
    floaters_plain_.encode_ms += sinceMs(begin);
    begin = Clock::now();
    const auto plain_samples = codec::decodeFloaters(frameOf(plain));
    floaters_plain_.decode_ms += sinceMs(begin);
    if (!plain_samples) return plain_samples.error();
    floaters_plain_.add(plain->size(), count);
    const codec::Stream packed{v1::LAYER_FLOATERS, v1::PACKING_PACKED};
    for (const core::Level level : core::kLevels) {
      FloaterLevel& at = floaters_[core::indexOf(level)];
      at.row.name = "floaters, packed, " + codec::nameOf(level);
      begin = Clock::now();
      const codec::EncodedFrame encoded = encoder_.encode(packed, frame, level, false);
      const double encode_ms = sinceMs(begin);
      const v1::LayerFrame message = frameOf(encoded.delta ? encoded.delta : encoded.keyframe);
      begin = Clock::now();
      const auto samples = at.decoder.decode(message);
      const double decode_ms = sinceMs(begin);
      if (!samples) return samples.error();
      if (!encoded.delta) continue;
      at.row.encode_ms += encode_ms;
      at.row.decode_ms += decode_ms;
      at.row.add(encoded.delta->size(), count);
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double error_m = std::abs(samples->at(i).position_m[axis] - plain_samples->at(i).position_m[axis]);
          at.row.max_error = std::max(at.row.max_error, error_m / message.floaters_predicted().quantum_m());
        }
      }
    }
    // As when a session asks for a keyframe: with the delta.
    begin = Clock::now();
    const codec::EncodedFrame both = places_encoder_.encode(packed, frame, core::Level::kFull, true);
    floaters_whole_.encode_ms += sinceMs(begin);
    floaters_whole_.add(both.keyframe->size(), count);
    return {};
  }

  /// N log2(positions in the box) - log2(N!): the least for any codec that does not know where the water is.
  static double sparseBits(const core::ParticleView& view, double quantum_m) {
    const double count = view.count;
    double place_bits = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      place_bits += std::log2((view.max_m[axis] - view.min_m[axis]) / quantum_m);
    return count * place_bits - std::lgamma(count + 1.0) / std::log(2.0);
  }

  /// Positions only, because other codecs for points code nothing else.
  void addPlaces(const core::FrameView& frame, const v1::ParticlesByCell& header,
                 const std::vector<float>& position_m) {
    core::ParticleView particles = *frame.at(core::Level::kFull).particles;
    const std::size_t count = particles.count;
    const double quantum_m = header.cell_m() / (1 << header.offset_bits());
    std::vector<std::uint32_t> words(particles.words.begin(), particles.words.end());
    for (std::size_t i = 0; i < words.size(); i += 3) {
      words[i + 1] &= 0xffffu;
      words[i + 2] = 0;
    }
    particles.words = words;
    core::FrameView places = frame;
    places.at(core::Level::kFull).particles = particles;
    auto begin = Clock::now();
    const core::SharedBytes packed =
        places_encoder_.encode({v1::LAYER_PARTICLES, v1::PACKING_PACKED}, places, core::Level::kFull, true).keyframe;
    places_.encode_ms += sinceMs(begin);
    const v1::LayerFrame message = frameOf(packed);
    begin = Clock::now();
    const auto samples = codec::decodePackedParticles(message);
    places_.decode_ms += sinceMs(begin);
    places_.add(packed->size(), count);
    places_.bound_bits = particles_.bound_bits;
    places_.sparse_bits = particles_.sparse_bits;
    if (samples)
      places_.max_error = std::max(places_.max_error, largestShift(position_m, samples->position_m) / quantum_m);

    const double min_m[] = {header.min_x_m(), header.min_y_m(), header.min_z_m()};
    std::vector<std::uint16_t> quanta(4 * count);
    double error = 0.0;
    for (std::size_t i = 0; i < position_m.size(); ++i) {
      const double at = (position_m[i] - min_m[i % 3]) / quantum_m;
      quanta[i / 3 * 4 + i % 3] = static_cast<std::uint16_t>(std::clamp(std::lround(at - 0.5), 0l, 65535l));
      error = std::max(error, std::abs(at - 0.5 - quanta[i / 3 * 4 + i % 3]));
    }
    places_meshoptimizer_.add(meshoptimizer(quanta), count, error);
    auto cloud = draco(position_m, quantum_m);
    if (cloud) {
      cloud->is_exact = true;  // to what is measured
      error = largestShift(position_m, cloud->position_m) / quantum_m;
    }
    places_draco_.add(cloud, count, error);
  }

  /// The codecs change the order of particles. Along each axis, the largest difference between the sorted coordinates
  /// is at most that of any pairing of particles.
  static double largestShift(const std::vector<float>& a, const std::vector<float>& b) {
    double largest = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<float> left, right;
      for (std::size_t i = axis; i < a.size(); i += 3) left.push_back(a[i]);
      for (std::size_t i = axis; i < b.size(); i += 3) right.push_back(b[i]);
      std::ranges::sort(left);
      std::ranges::sort(right);
      for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i)
        largest = std::max<double>(largest, std::abs(left[i] - right[i]));
    }
    return largest;
  }

  codec::FrameEncoder encoder_, places_encoder_;
  codec::PackedSurfaceDecoder decoder_;
  struct FloaterLevel {
    codec::PackedFloaterDecoder decoder;
    CodecRow row;
  };

  CodecRow surface_plain_{.name = "surface, plain"};
  CodecRow surface_deflated_{.name = "surface, plain + deflate"};
  CodecRow surface_zstd_{.name = "surface, plain + zstd"};
  CodecRow surface_whole_{.name = "surface, packed, keyframe"};
  CodecRow surface_{.name = "surface, packed"};
  CodecRow particles_plain_{.name = "particles, plain"};
  CodecRow particles_deflated_{.name = "particles, plain + deflate"};
  CodecRow particles_zstd_{.name = "particles, plain + zstd"};
  CodecRow places_meshoptimizer_{.name = "places, meshoptimizer"};
  CodecRow places_draco_{.name = "places, Draco kd-tree"};
  CodecRow places_{.name = "places, packed"};
  CodecRow particles_{.name = "particles, packed"};
  CodecRow floaters_plain_{.name = "floaters, plain"};
  CodecRow floaters_whole_{.name = "floaters, packed, keyframe"};
  std::array<FloaterLevel, core::kLevelCount> floaters_;  ///< indexed by core::Level
};

}  // namespace

core::Result<boost::json::object> measureCodecs(gpu::Context& ctx, const core::Scene& scene, double seconds,
                                                std::FILE* out) {
  constexpr double kBegin_s = 1.0;  // the shipped scenes' first effect
  auto sim = sim::WaterSim::create(ctx, scene);
  if (!sim) return sim.error();
  CodecMeter meter;
  LevelMeter levels(scene.stream.frame_rate_hz);
  double next_s = kBegin_s;
  std::size_t frame_count = 0;
  while ((*sim)->time_s() < kBegin_s + seconds) {
    (*sim)->step();
    if (const auto& error = (*sim)->deviceError()) return *error;
    if ((*sim)->time_s() + 1e-9 < next_s) continue;
    next_s += 1.0 / scene.stream.frame_rate_hz;
    (void)(*sim)->requestFrame(LevelMeter::request(scene));
    ctx.finish();
    for (const core::FrameView& frame : (*sim)->takeFrames()) {
      if (auto added = meter.add(frame); !added) return added.error();
      levels.add(frame);
      ++frame_count;
    }
  }
  fmt::print(out, "codecs: {} frames at {:.0f} Hz from {:.0f} s on\n", frame_count, scene.stream.frame_rate_hz,
             kBegin_s);
  fmt::print(out, "{:<27} {:>9} {:>10} {:>9} {:>9} {:>9} {:>8} {:>10} {:>10} {:>11}\n", "stream", "items", "bits/item",
             "bound", "in box", "kB/frame", "largest", "encode ms", "decode ms", "error/quantum");
  boost::json::array json;
  for (const CodecRow& row : meter.rows()) {
    const auto frames = static_cast<double>(row.frame_count);
    if (!row.is_installed) {
      fmt::print(out, "{:<27} not installed when this was built\n", row.name);
      json.push_back({{"name", row.name}, {"installed", false}});
      continue;
    }
    fmt::print(out, "{:<27} {:>9.0f} {:>10.2f} {:>9} {:>9} {:>9.2f} {:>8.2f} {:>10.3f} {:>10.3f} {:>11.3f}\n", row.name,
               row.item_count / frames, row.itemBits(),
               row.bound_bits ? fmt::format("{:.2f}", *row.bound_bits) : std::string("-"),
               row.bound_bits ? fmt::format("{:.2f}", row.sparse_bits / row.item_count) : std::string("-"),
               row.bytes / frames / 1e3, row.most_bytes / 1e3, row.encode_ms / frames, row.decode_ms / frames,
               row.max_error);
    json.push_back({{"name", row.name},
                    {"items", row.item_count / frames},
                    {"bits_per_item", row.itemBits()},
                    {"bound_bits", row.bound_bits ? boost::json::value(*row.bound_bits) : boost::json::value()},
                    {"box_bound_bits", row.sparse_bits / row.item_count},
                    {"frame_bytes", row.bytes / frames},
                    {"largest_frame_bytes", row.most_bytes},
                    {"mbit_per_s", row.bytes / frames * 8e-6 * scene.stream.frame_rate_hz},
                    {"encode_ms", row.encode_ms / frames},
                    {"decode_ms", row.decode_ms / frames},
                    {"max_error_quanta", row.max_error}});
  }
  boost::json::array level_rows = levels.print(out);
  return boost::json::object{{"frames", frame_count}, {"rows", std::move(json)}, {"levels", std::move(level_rows)}};
}

}  // namespace spindrift::bench
