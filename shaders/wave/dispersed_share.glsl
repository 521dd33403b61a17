// How far the dispersion drives a face of nonlinear shallow water; the rest of the slope drives it at once.
// Equation: with the share w, the still depth d, the water h and the operator F of the dispersion (docs/dispersion.md),
//   u_t = -g [(1 - w) grad eta + w_after F_h (w_before grad eta)],  w_before = sqrt(w h/d), w_after = sqrt(w/(h d)).
// The weight of water that moves, h, times this operator is symmetric and positive whatever w and h are, so the waves of frozen
// coefficients keep an energy. A share on one side of F alone makes waves grow where it varies.
// F has the still depth in its tables; F_h disperses by the water that there is. For F = d/(1 + X), with X = (k d)^2/3 of
// long waves, and m = (d/h)^2, Serre's equations (1953) have d/(1 + X/m) in its place:
//   F_h s = sqrt(m) psi,   psi = F (sqrt(m) s + (1 - m) psi/d)
// psi on the right is that of the two steps before, extrapolated: as a mode of frozen coefficients it stays bounded while
// -1/3 < 1 - m < 1. A face without psi in the step before disperses by the still depth.
#ifndef SPINDRIFT_DISPERSED_SHARE
#define SPINDRIFT_DISPERSED_SHARE

#include "shared/side_bits.h"
#include "wave/shallow_column.glsl"

#if DISPERSE
layout(binding = BREAKING) uniform samplerBuffer breaking;
// psi of the x and the z face, then the same a step earlier [m * units per cell].
layout(binding = DISPERSED) uniform samplerBuffer dispersed;

/// Bounds of m: they are reached at 1.6 and 0.88 times the still depth.
#define LEAST_RATIO 0.4
#define MOST_RATIO 1.28

float breakingAt(int i) { return texelFetch(breaking, i).y; }

/// Share of what high waves add to the dispersion at a position [cells] near wave-makers: within two depths water stretches as the
/// maker lets it in, by the linear dispersion that the maker counts on, and a dynamic head would draw in more.
float awayFromMakers(vec2 from_minus, ivec2 n) {
#if MAKERS
  const vec2 from_plus = vec2(n) - from_minus;
  float cells = 1e9;
#if MAKERS & MINUS_X_BIT
  cells = min(cells, from_minus.x);
#endif
#if MAKERS & PLUS_X_BIT
  cells = min(cells, from_plus.x);
#endif
#if MAKERS & MINUS_Z_BIT
  cells = min(cells, from_minus.y);
#endif
#if MAKERS & PLUS_Z_BIT
  cells = min(cells, from_plus.y);
#endif
  return smoothstep(0.0, 2.0 * sim.wave_depth_m, cells * sim.wave_cell_m);
#else
  return 1.0;
#endif
}

struct DispersedShare {
  float all;     // w
  float before;  // factor of the slopes that the dispersion filters
  float fed;     // factor of psi, which it filters, too [1/m]
  float after;   // factor of what comes out [1/m]
};

/// The share at a face of still depth `depth_m`: 0 where waves are high for their depth, water is missing or breaks.
/// `psi_before`: psi of the step before; `away`: awayFromMakers().
DispersedShare dispersedShare(float depth_m, Column here, Column there, float breaks, float psi_before, float away) {
  if (depth_m <= 0.0 || min(here.water_m, there.water_m) <= 0.0) return DispersedShare(0.0, 0.0, 0.0, 0.0);
  const float high = 0.5 * (here.water_m + there.water_m) / depth_m;
  const float share = (1.0 - smoothstep(1.6, 1.9, high)) * smoothstep(0.2, 0.5, high) * (1.0 - breaks);
  const float ratio = psi_before == 0.0 ? 1.0 : mix(1.0, clamp(1.0 / (high * high), LEAST_RATIO, MOST_RATIO), share * away);
  return DispersedShare(share, sqrt(share * high * ratio), (1.0 - ratio) / depth_m, sqrt(share * ratio / high) / depth_m);
}

/// Extrapolates psi from a step and the one before; from one alone if there is no other.
float extrapolated(float now, float before) { return before == 0.0 ? now : 2.0 * now - before; }
#endif

#endif
