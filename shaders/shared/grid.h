// Constants of the neighbour grid (shaders/grid, grid/grid_hash.glsl).
#ifndef SPINDRIFT_SHARED_GRID_H
#define SPINDRIFT_SHARED_GRID_H

// Cell of a removed particle: it gets no index in the sorted arrays.
#define NO_CELL 0xffffffffu
// Maximum number of particles per cell that grid/reorder.comp sorts into a reproducible order, at quadratic cost.
// Further ones stay in their order of arrival: so many in a cell are not physical, but they must not stall the device.
#define ORDERED_MAX 2048

#endif
