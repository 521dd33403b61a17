#include "spindrift_decoder.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include <spindrift/bitstream/decode/floater_reader.h>
#include <spindrift/bitstream/decode/particle_reader.h>
#include <spindrift/bitstream/decode/plane_reader.h>
#include <spindrift/core/crc32c_tables.h>

using namespace spindrift::codec;

namespace {

static_assert(sizeof(FloaterRecord) == 28);

/// Calls `read` with the payload, behind which are the zeros that readers need, and its size. False if the payload is
/// too long or there is no memory.
template <typename Read>
bool withPayload(const std::uint8_t* payload, std::size_t byte_count, Read read) {
  if (byte_count > BitSource::kMaxBytes) return false;
  try {
    std::vector<std::uint8_t> bytes(byte_count + BitSource::kSlackBytes);
    std::copy_n(payload, byte_count, bytes.begin());
    return read(bytes.data(), static_cast<std::uint32_t>(byte_count));
  } catch (const std::bad_alloc&) {
    return false;
  }
}

SurfaceWeights weightsFrom(const std::int32_t* values) {
  SurfaceWeights weights;
  std::copy_n(values, weights.of.size(), weights.of.begin());
  return weights;
}

struct AlignedDelete {
  void operator()(std::uint8_t* memory) const { ::operator delete (memory, std::align_val_t{PlaneRow::kAlignment}); }
};

}  // namespace

struct spindrift_reader {
  PlaneRow planes;
  std::unique_ptr<std::uint8_t, AlignedDelete> plane_memory;
  FloaterReader floaters;

  /// Forgets planes of another size.
  void resize(std::uint32_t nx, std::uint32_t nz) {
    if (plane_memory && planes.hasSize(nx, nz)) return;
    plane_memory.reset();
    planes = PlaneRow();
    plane_memory.reset(static_cast<std::uint8_t*>(
        ::operator new (PlaneRow::bytesFor(nx, nz), std::align_val_t{PlaneRow::kAlignment})));
    planes.place(plane_memory.get(), nx, nz);
  }
};

spindrift_reader* spindrift_reader_new() {
  return new (std::nothrow) spindrift_reader;
}

void spindrift_reader_delete(spindrift_reader* reader) {
  delete reader;
}

void spindrift_reader_forget(spindrift_reader* reader) {
  reader->planes.forget();
  reader->floaters.forget();
}

int spindrift_read_plane(spindrift_reader* reader, const uint8_t* payload, size_t payload_bytes, uint32_t nx,
                         uint32_t nz, const int32_t* weights, const int32_t* earlier_weights, int16_t* samples) {
  const auto isAllowed = [](std::uint32_t n) { return n >= 1 && n <= PlaneRow::kMaxResolutionCount; };
  if (!isAllowed(nx) || !isAllowed(nz)) return 0;
  PlaneRow& planes = reader->planes;
  const bool is_read = withPayload(payload, payload_bytes, [&](const std::uint8_t* bytes, std::uint32_t byte_count) {
    reader->resize(nx, nz);
    return earlier_weights == nullptr
               ? planes.readDelta(bytes, byte_count, weightsFrom(weights))
               : planes.readKeyframe(bytes, byte_count, weightsFrom(weights), weightsFrom(earlier_weights));
  });
  if (!is_read) return planes.forget(), 0;
  for (std::size_t z = 0; z < nz; ++z) std::copy_n(planes.row(z), nx, samples + z * nx);
  return 1;
}

int spindrift_read_floaters(spindrift_reader* reader, const uint8_t* payload, size_t payload_bytes, uint32_t count,
                            uint32_t rotation_bits, uint32_t motion_weight, int keyframe, uint8_t* records) {
  FloaterReader& floaters = reader->floaters;
  const bool is_read = withPayload(payload, payload_bytes, [&](const std::uint8_t* bytes, std::uint32_t byte_count) {
    return keyframe != 0 ? floaters.readKeyframe(bytes, byte_count, count, rotation_bits)
                         : floaters.readDelta(bytes, byte_count, count, rotation_bits, motion_weight);
  });
  if (!is_read) return floaters.forget(), 0;
  std::memcpy(records, floaters.list().records.data(), count * sizeof(FloaterRecord));
  return 1;
}

int spindrift_read_particles(const uint8_t* payload, size_t payload_bytes, uint32_t count, uint32_t cells_x,
                             uint32_t cells_y, uint32_t cells_z, uint32_t offset_bits, uint8_t* records) {
  if (count > kParticleReadMaxCount) return 0;
  const std::size_t byte_count = count * kParticleWordBytes;
  return withPayload(payload, payload_bytes, [&](const std::uint8_t* bytes, std::uint32_t bytes_count) {
    std::vector<std::uint8_t> words(byte_count + kParticleSlackBytes);
    if (!readParticles(bytes, bytes_count, count, {{cells_x, cells_y, cells_z}, offset_bits}, words.data()))
      return false;
    std::copy_n(words.begin(), byte_count, records);
    return true;
  });
}

uint32_t spindrift_crc32c(const uint8_t* bytes, size_t byte_count) {
  return spindrift::core::crc32cByTables(bytes, byte_count);
}
