// Values of the surface at a point, for shaders/diagnostics/points.comp.
#ifndef SPINDRIFT_SHARED_SURFACE_POINTS_H
#define SPINDRIFT_SHARED_SURFACE_POINTS_H

// Texels of four words per point: elevation [m], rate [m/s], velocity along x and z [m/s]; slope along x and z, depth [m], share of
// wet cells; share of white water, 0, 0, 0.
#define SURFACE_POINT_TEXELS 3

#endif
