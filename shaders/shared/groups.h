// Work group sizes. The host reads them from the linked programs (GL_COMPUTE_WORK_GROUP_SIZE), never from here. Those with an #ifndef are
// the values of a CPU, and fields of gpu::TuningProfile.
#ifndef SPINDRIFT_SHARED_GROUPS_H
#define SPINDRIFT_SHARED_GROUPS_H

// One invocation per particle. 64 is two warps on NVIDIA and eight SIMD vectors of llvmpipe; 8 and 256 were slower
// there.
#ifndef PARTICLE_GROUP
#define PARTICLE_GROUP 64
#endif
// The smallest that a profile may have. The pool's group counts are state and so count these; larger groups leave some idle.
#define POOL_GROUP 64
// One invocation per wave cell.
#ifndef WAVE_GROUP_X
#define WAVE_GROUP_X 64
#define WAVE_GROUP_Y 1
#endif
// Rows of cells of an invocation that first looks for rows with work and visits them in a second loop: llvmpipe takes both sides of a
// branch, but repeats a loop only while a lane needs it. At most 32, the bits of a word; short where dispersion_strip is.
// wave/shallow_slope.comp uses the same strips to fetch values that two rows share once.
#define WAVE_STRIP_MAX 32
#define WAVE_STRIP min(DISPERSION_STRIP, WAVE_STRIP_MAX)
// One invocation per cell of a small square of the wave; z is the boat in it.
#define PATCH_GROUP 8
// One invocation per cell of a tile that splashes reach.
#define SPLASH_TILE 8
// The scan. An invocation sums a run of SCAN_ITEMS groups of four cells, without shared memory: barriers are expensive on llvmpipe. One
// group of SCAN_GROUP invocations sums the runs.
#define SCAN_GROUP 256
#ifndef SCAN_ITEMS
#define SCAN_ITEMS 16
#endif
#define SCAN_RUN (4 * SCAN_ITEMS)
#define SCAN_RUNS_GROUP 64
#define SCAN_BLOCK (SCAN_RUNS_GROUP * SCAN_RUN)
// The largest that a profile may have, for the pool's group counts.
#define POOL_SCAN_BLOCK (SCAN_RUNS_GROUP * 4 * 16)
// An invocation of the dispersion's passes owns so many columns, and rows of them; both even. A CPU wants long strips, because
// neighbours of a strip are computed twice; a GPU wants many invocations with few registers (gpu::TuningProfile).
#ifndef DISPERSION_COLUMNS
#define DISPERSION_COLUMNS 4
#define DISPERSION_STRIP 32
#endif
#define DISPERSION_GROUP 16
// In a word of DISPERSION_STRIPS: cells at sides across z have no spread.
#define DISPERSION_SIDES_WITHOUT_SPREAD 0x8000u
// Part of F that acts at once, for the shortest waves: so much of the depth, and at most so much of a cell.
#define DISPERSION_DEPTH_SHARE 0.02
#define DISPERSION_CELL_SHARE 0.4
// Weight of the damped Jacobi sweeps. With more than 1/2 the shortest waves would get a negative F, and grow.
#define DISPERSION_SWEEP_WEIGHT 0.5
// The dispersion's small grids, in one group: from one with as many cells as a square of this side down, or from the coarsest
// grid, which has fewer than a square of DISPERSION_BOTTOM_SIDE_MAX.
#define DISPERSION_BOTTOM_GROUP 64
#define DISPERSION_BOTTOM_SIDE 16
#define DISPERSION_BOTTOM_SIDE_MAX 32
#define DISPERSION_BOTTOM_GRIDS_MAX 16
// Sweeps that solve the coarsest grid.
#define DISPERSION_COARSEST_SWEEPS 12
// Groups along x that every OpenGL 4.5 device can dispatch at once. Passes over more cells loop.
#define MAX_GROUPS 65535
// Diagnostics: every invocation sums a strided share of about REDUCE_ITEMS items by itself and writes one partial result; the
// host sums those. No shared memory: its barriers cost llvmpipe 15 times the reduction itself.
#define REDUCE_GROUP 64
#ifndef REDUCE_ITEMS
#define REDUCE_ITEMS 64
#endif

#endif
