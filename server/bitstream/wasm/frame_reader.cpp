// The decoders of decode/ as a WebAssembly module for the page's worker. An instance decodes one layer: after the
// module's own memory comes what that layer needs, nothing else. All functions take and return plain numbers; addresses
// are valid until the next prepare call.
#include <algorithm>
#include <new>

#include <spindrift/bitstream/decode/floater_reader.h>
#include <spindrift/bitstream/decode/particle_reader.h>
#include <spindrift/bitstream/decode/plane_reader.h>
#include <spindrift/core/crc32c_tables.h>

#define SPINDRIFT_EXPORT(name) extern "C" __attribute__((export_name(#name)))

/// End of the module's own memory, set by the linker.
extern "C" std::uint8_t __heap_base;

namespace spindrift::codec {
namespace {

constexpr std::size_t kPageBytes = 64 * 1024;
constexpr std::size_t kAlignment = PlaneRow::kAlignment;

std::uint8_t* payload;
std::uint32_t payload_bytes;
std::uint8_t* words;
PlaneRow row;
SurfaceWeights weights, earlier_weights;
FloaterReader* floaters;
std::uint8_t* plain_samples;

std::size_t aligned(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

std::uint8_t* heapBegin() {
  return reinterpret_cast<std::uint8_t*>(aligned(reinterpret_cast<std::size_t>(&__heap_base)));
}

/// Makes room for `before_bytes` of the layer and for a payload after them. Null: the payload is too long, or there is
/// no memory left.
std::uint8_t* makeRoom(std::size_t before_bytes, std::uint32_t byte_count) {
  if (byte_count > BitSource::kMaxBytes) return nullptr;
  payload = heapBegin() + aligned(before_bytes);
  payload_bytes = byte_count;
  const std::size_t end = reinterpret_cast<std::size_t>(payload) + byte_count + BitSource::kSlackBytes;
  const std::size_t pages = (end + kPageBytes - 1) / kPageBytes, has_pages = __builtin_wasm_memory_size(0);
  if (pages > has_pages && __builtin_wasm_memory_grow(0, pages - has_pages) == static_cast<std::size_t>(-1))
    return nullptr;
  std::fill_n(payload + byte_count, BitSource::kSlackBytes, std::uint8_t{0});
  return payload;
}

}  // namespace
}  // namespace spindrift::codec

using namespace spindrift::codec;

/// Returns room for the payload of `count` particles. 0: not enough memory.
SPINDRIFT_EXPORT(prepareParticles) std::uint8_t* prepareParticles(std::uint32_t count, std::uint32_t byte_count) {
  words = heapBegin();
  if (count > kParticleReadMaxCount) return nullptr;
  return makeRoom(count * kParticleWordBytes + kParticleSlackBytes, byte_count);
}
/// Returns the address of the particles, kParticleWordBytes each. 0: the payload is damaged.
SPINDRIFT_EXPORT(readParticles)
std::uint8_t* readPreparedParticles(std::uint32_t count, std::uint32_t cells_x, std::uint32_t cells_y,
                                    std::uint32_t cells_z, std::uint32_t offset_bits) {
  return readParticles(payload, payload_bytes, count, {{cells_x, cells_y, cells_z}, offset_bits}, words) ? words
                                                                                                         : nullptr;
}

/// Returns room for the payload of a plane of nx x nz samples. 0: not enough memory. Another size forgets the planes.
SPINDRIFT_EXPORT(preparePlane)
std::uint8_t* preparePlane(std::uint32_t nx, std::uint32_t nz, std::uint32_t byte_count) {
  const auto isAllowed = [](std::uint32_t n) { return n >= 1 && n <= PlaneRow::kMaxResolutionCount; };
  if (!isAllowed(nx) || !isAllowed(nz)) return nullptr;
  const std::size_t row_bytes = aligned(PlaneRow::bytesFor(nx, nz));
  std::uint8_t* const room = makeRoom(row_bytes + nx * nz * sizeof(std::int16_t), byte_count);
  if (room == nullptr) {
    row.forget();
  } else if (!row.hasSize(nx, nz)) {
    row.place(heapBegin(), nx, nz);
    plain_samples = heapBegin() + row_bytes;
  }
  return room;
}
/// Address where the caller writes ten weights, then the ten of the earlier plane.
SPINDRIFT_EXPORT(weights) std::int32_t* weightsRoom() {
  return weights.of.data();
}
SPINDRIFT_EXPORT(earlierWeights) std::int32_t* earlierWeightsRoom() {
  return earlier_weights.of.data();
}
/// Decodes a keyframe or a delta. 0: the payload is damaged, or a delta has no plane before it.
SPINDRIFT_EXPORT(readKeyframePlane) bool readKeyframePlane() {
  return row.readKeyframe(payload, payload_bytes, weights, earlier_weights);
}
SPINDRIFT_EXPORT(readDeltaPlane) bool readDeltaPlane() {
  return row.readDelta(payload, payload_bytes, weights);
}
/// The nx x nz samples of the newest plane, row by row, 16 bits each.
SPINDRIFT_EXPORT(surfaceSamples) std::int16_t* surfaceSamples() {
  auto* const out = reinterpret_cast<std::int16_t*>(plain_samples);
  const std::size_t nx = row.countX();
  for (std::size_t z = 0; z < row.countZ(); ++z) std::copy_n(row.row(z), nx, out + z * nx);
  return out;
}
/// The same as bytes, 0 to 255.
SPINDRIFT_EXPORT(foamSamples) std::uint8_t* foamSamples() {
  const std::size_t nx = row.countX();
  for (std::size_t z = 0; z < row.countZ(); ++z) {
    std::transform(row.row(z), row.row(z) + nx, plain_samples + z * nx,
                   [](std::int16_t s) { return static_cast<std::uint8_t>(std::clamp<std::int16_t>(s, 0, 255)); });
  }
  return plain_samples;
}

/// Returns room for the payload of objects in the water. 0: not enough memory.
SPINDRIFT_EXPORT(prepareFloaters) std::uint8_t* prepareFloaters(std::uint32_t byte_count) {
  std::uint8_t* const room = makeRoom(sizeof(FloaterReader), byte_count);
  if (room != nullptr && floaters == nullptr) floaters = new (heapBegin()) FloaterReader;
  return room;
}
/// Decodes a keyframe or a delta and returns the address of the objects, sizeof(FloaterRecord) bytes each. 0: the
/// payload is damaged, or a delta has no frame before it.
SPINDRIFT_EXPORT(readKeyframeFloaters)
const FloaterRecord* readKeyframeFloaters(std::uint32_t count, std::uint32_t rotation_bits) {
  return floaters->readKeyframe(payload, payload_bytes, count, rotation_bits) ? floaters->list().records.data()
                                                                              : nullptr;
}
SPINDRIFT_EXPORT(readDeltaFloaters)
const FloaterRecord* readDeltaFloaters(std::uint32_t count, std::uint32_t rotation_bits, std::uint32_t motion_weight) {
  return floaters->readDelta(payload, payload_bytes, count, rotation_bits, motion_weight)
             ? floaters->list().records.data()
             : nullptr;
}

/// Returns room for any payload whose checksum is wanted. 0: not enough memory.
SPINDRIFT_EXPORT(prepareChecksum) std::uint8_t* prepareChecksum(std::uint32_t byte_count) {
  return makeRoom(0, byte_count);
}
SPINDRIFT_EXPORT(checksum) std::uint32_t checksum() {
  return spindrift::core::crc32cByTables(payload, payload_bytes);
}
