// How far the dispersion drives a face of nonlinear shallow water; the rest of the slope drives it at once.
// Equation: with the share w, the still depth d, the water h and the operator F of the dispersion (docs/dispersion.md),
//   u_t = -g [(1 - w) grad eta + w_after F (w_before grad eta)],  w_before = sqrt(w h/d), w_after = sqrt(w/(h d)).
// The weight of water that moves, h, times this operator is symmetric and positive whatever w and h are, so the waves of frozen
// coefficients keep an energy. A share on one side of F alone makes waves grow where it varies.
#ifndef SPINDRIFT_DISPERSED_SHARE
#define SPINDRIFT_DISPERSED_SHARE

#include "wave/shallow_column.glsl"

#if DISPERSE
layout(binding = BREAKING) uniform samplerBuffer breaking;

float breakingAt(int i) { return texelFetch(breaking, i).y; }

struct DispersedShare {
  float all;     // w
  float before;  // factor of the slopes that the dispersion filters
  float after;   // factor of what comes out [1/m]
};

/// The share at a face of still depth `depth_m`: 0 where waves are high for their depth, water is missing or breaks.
DispersedShare dispersedShare(float depth_m, Column here, Column there, float breaks) {
  if (depth_m <= 0.0 || min(here.water_m, there.water_m) <= 0.0) return DispersedShare(0.0, 0.0, 0.0);
  const float high = 0.5 * (here.water_m + there.water_m) / depth_m;
  const float share = (1.0 - smoothstep(1.6, 1.9, high)) * smoothstep(0.2, 0.5, high) * (1.0 - breaks);
  return DispersedShare(share, sqrt(share * high), sqrt(share / high) / depth_m);
}
#endif

#endif
