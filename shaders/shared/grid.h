// Numbers of the neighbour grid (shaders/grid, grid/grid_hash.glsl).
#ifndef SPINDRIFT_SHARED_GRID_H
#define SPINDRIFT_SHARED_GRID_H

// Cell of a particle that has left: it gets no place in the sorted arrays.
#define NO_CELL 0xffffffffu
// Particles in one cell that grid/reorder.comp puts into a repeatable order, at a cost of their square. More than these stay in
// the order in which they arrived: such a pile-up is no water any more, but it must not stall the device.
#define ORDERED_MAX 2048

#endif
