/* The decoder of Spindrift's packed frames behind a plain C interface, for programs in other languages: the same code
 * that the page uses as WebAssembly. proto/README.md says what the arguments are in a LayerFrame; the caller reads its
 * Protobuf header.
 *
 * Functions that read return 1, or 0 if the payload is damaged, a number is outside of its bounds, a delta has no frame
 * before it, or there is no memory. After 0 a reader waits for a keyframe. No function keeps a pointer of the caller. A
 * reader is used by one thread at a time; different readers are independent. */
#ifndef SPINDRIFT_DECODER_H
#define SPINDRIFT_DECODER_H

#include <stddef.h>
#include <stdint.h>

/* Only these are visible outside of the library. */
#define SPINDRIFT_API __attribute__((visibility("default")))

#ifdef __cplusplus
extern "C" {
#endif

/** Reads one layer of one subscription: planes (surface, foam) or objects in the water. */
typedef struct spindrift_reader spindrift_reader;

/** NULL: no memory. */
SPINDRIFT_API spindrift_reader* spindrift_reader_new(void);
SPINDRIFT_API void spindrift_reader_delete(spindrift_reader* reader);
/** Only a keyframe can follow: after a new subscription. */
SPINDRIFT_API void spindrift_reader_forget(spindrift_reader* reader);

/** Reads a packed surface or foam of nx times nz samples, 1 to 4096 along each axis. `weights`: ten; `earlier_weights`:
 * ten for a keyframe, NULL for a delta. Writes nx * nz samples to `samples`, row by row, x fastest. */
SPINDRIFT_API int spindrift_read_plane(spindrift_reader* reader, const uint8_t* payload, size_t payload_bytes,
                                       uint32_t nx, uint32_t nz, const int32_t* weights, const int32_t* earlier_weights,
                                       int16_t* samples);

/** Reads packed objects in the water, at most 1024. `keyframe`: 0 for a delta. Writes 28 bytes for each to `records`,
 * as in floaters_fixed28 but with positions in quanta. */
SPINDRIFT_API int spindrift_read_floaters(spindrift_reader* reader, const uint8_t* payload, size_t payload_bytes,
                                          uint32_t count, uint32_t rotation_bits, uint32_t motion_weight, int keyframe,
                                          uint8_t* records);

/** Reads packed particles, at most 4,194,304. Writes 12 bytes for each to `records`, as in particles_fixed12 but with
 * positions and velocities in quanta. */
SPINDRIFT_API int spindrift_read_particles(const uint8_t* payload, size_t payload_bytes, uint32_t count,
                                           uint32_t cells_x, uint32_t cells_y, uint32_t cells_z, uint32_t offset_bits,
                                           uint8_t* records);

/** CRC-32C (Castagnoli), as in LayerFrame.crc32c. */
SPINDRIFT_API uint32_t spindrift_crc32c(const uint8_t* bytes, size_t byte_count);

#ifdef __cplusplus
}
#endif
#endif
