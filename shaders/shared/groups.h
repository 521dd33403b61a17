// Work group sizes. The host reads them back from the linked programs (GL_COMPUTE_WORK_GROUP_SIZE), never from here;
// only the scan's block length is a number that both sides compute with.
#ifndef SPINDRIFT_SHARED_GROUPS_H
#define SPINDRIFT_SHARED_GROUPS_H

// One invocation a particle. 64 is two warps on NVIDIA and eight SIMD vectors of llvmpipe; 8 and 256 were slower there.
#define PARTICLE_GROUP 64
// One invocation a wave cell.
#define WAVE_GROUP_X 64
#define WAVE_GROUP_Y 1
// One invocation a cell of a small square of the wave, z is what lies there (a splash, a boat).
#define PATCH_GROUP 8
// The scan: SCAN_GROUP invocations, SCAN_ITEMS cells each. 16 instead of 4 halved the grid's time on llvmpipe, whose barriers are
// dear.
#define SCAN_GROUP 256
#define SCAN_ITEMS 16
#define SCAN_BLOCK (SCAN_GROUP * SCAN_ITEMS)
// Groups along x that every device of OpenGL 4.5 dispatches at once. Passes over more cells than this many groups have loop.
#define MAX_GROUPS 65535
// Diagnostics: every invocation sums a strided share of about REDUCE_ITEMS items by itself and writes one partial result; the
// host sums those. No shared memory: its barriers cost llvmpipe 15 times the reduction itself.
#define REDUCE_GROUP 64
#define REDUCE_ITEMS 64

#endif
