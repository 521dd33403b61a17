// The elevation is an integer: the neighbour gains exactly what a cell loses, so the volume of water is conserved
// exactly. 2^-24 m is 60 nm; the range is +-128 m.
#ifndef SPINDRIFT_SHARED_FIXED_POINT_H
#define SPINDRIFT_SHARED_FIXED_POINT_H

#define ELEVATION_UNITS_PER_M 16777216.0f
#define ELEVATION_UNIT_M 5.9604644775390625e-8f
// A transfer or a pressure head beyond this many units (16 m) is an error of the simulation and is replaced by 0.
#define TRANSFER_MAX_UNITS 268435456.0f
// Half of the range: water beyond it (64 m) is an error, too; the watchdog acts before the value overflows.
#define ELEVATION_MAX_UNITS 1073741824

#endif
