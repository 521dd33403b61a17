// Encoder and decoder of packed particles: ParticlesByCell in wire.proto.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <spindrift/bitstream/decode/particle_reader.h>
#include <spindrift/codec/frame_decoder.h>

#include "layer_encoders.h"
#include "packed_payload.h"

namespace spindrift::codec {
namespace {

/// Side of a cell in particle spacings: a cell holds about eight particles. A quantum is a sixteenth of a spacing.
constexpr double kCellSpacings = 2.0;
constexpr std::uint32_t kOffsetBits = 5;
/// The page extrapolates particles by their velocity for some frames. Over this time, one quantum of velocity moves a
/// particle by two quanta of its position.
constexpr double kAdvance_s = 1.0 / 30.0;

struct Grid {
  CellGrid cells;
  double cell_m = 0.0;
  [[nodiscard]] double quantum_m() const { return cell_m / (1u << cells.offset_bits); }
};

/// Returns a grid over the particles' domain. Where there would be too many cells they are larger, with as fine
/// positions; where there would be too many positions along an axis, these are coarser.
Grid gridOf(const core::ParticleView& particles) {
  Grid grid{.cells = {.cells_count = {}, .offset_bits = kOffsetBits}, .cell_m = kCellSpacings * 2 * particles.radius_m};
  for (;;) {
    double most = 0.0, total = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double cells = std::max(std::ceil((particles.max_m[axis] - particles.min_m[axis]) / grid.cell_m), 1.0);
      most = std::max(most, cells);
      total *= cells;
      grid.cells.cells_count[axis] = static_cast<std::uint32_t>(std::min(cells, double{kCoordinateMaxCount}));
    }
    if (total > kCellMaxCount || most > kCoordinateMaxCount >> 1) {
      grid.cell_m *= 2;
      grid.cells.offset_bits = std::min(grid.cells.offset_bits + 1, kOffsetBitsMax);
    } else if (most > kCoordinateMaxCount >> grid.cells.offset_bits) {
      --grid.cells.offset_bits;
    } else {
      return grid;
    }
  }
}

core::Result<Grid> checkedGrid(const v1::ParticlesByCell& header) {
  const Grid grid{.cells = {.cells_count = {header.cells_x_count(), header.cells_y_count(), header.cells_z_count()},
                            .offset_bits = header.offset_bits()},
                  .cell_m = header.cell_m()};
  if (grid.cells.offset_bits < 1 || grid.cells.offset_bits > kOffsetBitsMax)
    return invalid("offset_bits: " + std::to_string(grid.cells.offset_bits) + " is not from 1 to 8");
  for (const std::uint32_t cells : grid.cells.cells_count) {
    if (cells < 1 || cells > kCoordinateMaxCount >> grid.cells.offset_bits)
      return invalid("cells: " + std::to_string(cells) + " along an axis, at least 1 and at most " +
                     std::to_string(kCoordinateMaxCount >> grid.cells.offset_bits) + " are allowed");
  }
  if (grid.cells.totalCount() > kCellMaxCount)
    return invalid("cells: " + std::to_string(grid.cells.totalCount()) + " in all is above " +
                   std::to_string(kCellMaxCount));
  return grid;
}

}  // namespace

core::SharedBytes PackedParticles::encode(const core::FrameView& frame, core::Level level) {
  if (!frame.at(level).particles) return nullptr;
  const core::ParticleView& particles = *frame.at(level).particles;
  const Grid grid = gridOf(particles);
  const double velocity_quantum_mps = std::max(2 * grid.quantum_m() / kAdvance_s, particles.max_speed_mps / 127);
  v1::LayerFrame codec;
  v1::ParticlesByCell& header = *codec.mutable_particles_by_cell();
  header.set_count(particles.count);
  header.set_min_x_m(particles.min_m[0]);
  header.set_min_y_m(particles.min_m[1]);
  header.set_min_z_m(particles.min_m[2]);
  header.set_cells_x_count(grid.cells.cells_count[0]);
  header.set_cells_y_count(grid.cells.cells_count[1]);
  header.set_cells_z_count(grid.cells.cells_count[2]);
  header.set_cell_m(grid.cell_m);
  header.set_offset_bits(grid.cells.offset_bits);
  header.set_velocity_quantum_mps(velocity_quantum_mps);
  header.set_radius_m(particles.radius_m);

  ParticleScale scale;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    scale.place[axis] =
        static_cast<float>((particles.max_m[axis] - particles.min_m[axis]) / (65535.0 * grid.quantum_m()));
  }
  scale.speed = static_cast<float>(particles.max_speed_mps / (127.0 * velocity_quantum_mps));
  cells_.encode(particles.words, scale, grid.cells, residuals_);
  payload_.clear();
  residuals_.finish(payload_);
  return serializeFrame(frame, v1::LAYER_PARTICLES, level, std::nullopt, codec, payload_);
}

core::Result<ParticleSamples> decodePackedParticles(const v1::LayerFrame& frame) {
  if (!frame.has_particles_by_cell()) return invalid("codec: not particles_by_cell");
  const v1::ParticlesByCell& header = frame.particles_by_cell();
  if (auto error = checkCount(header.count(), kParticleMaxCount)) return *error;
  const double min_m[3] = {header.min_x_m(), header.min_y_m(), header.min_z_m()};
  for (const double min : min_m) {
    if (auto error = checkRange("min_m", min, -kMaxMagnitude)) return *error;
  }
  if (auto error = checkRange("cell_m", header.cell_m(), 1e-6)) return *error;
  if (auto error = checkRange("velocity_quantum_mps", header.velocity_quantum_mps(), 0.0)) return *error;
  if (auto error = checkRange("radius_m", header.radius_m(), 0.0)) return *error;
  const auto grid = checkedGrid(header);
  if (!grid) return grid.error();
  if (!frame.keyframe()) return invalid("keyframe: false, but frames of this codec always stand by themselves");
  if (auto error = checkFrame(frame, v1::LAYER_PARTICLES)) return *error;

  const PackedPayload payload(viewOf(frame.payload()));
  const std::size_t count = header.count();
  std::vector<std::uint8_t> words(count * kParticleWordBytes + kParticleSlackBytes);
  if (!readParticles(payload.data(), payload.size(), header.count(), grid->cells, words.data()))
    return invalid("payload: it does not hold " + std::to_string(count) + " particles; the frame is damaged");

  ParticleSamples out = particlesOf(header);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* at = words.data() + i * kParticleWordBytes;
    std::array<std::uint16_t, 3> place;  // x, z, y
    std::memcpy(place.data(), at, sizeof place);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t at_axis = axis == 0 ? 0 : 3 - axis;
      out.position_m[3 * i + axis] = static_cast<float>(min_m[axis] + (place[at_axis] + 0.5) * grid->quantum_m());
      out.velocity_mps[3 * i + axis] =
          static_cast<float>(static_cast<std::int8_t>(at[6 + axis]) * header.velocity_quantum_mps());
    }
    out.tint[i] = at[9];
    out.foam[i] = at[10];
  }
  return out;
}

}  // namespace spindrift::codec
