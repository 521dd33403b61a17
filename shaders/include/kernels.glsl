// Smoothing kernels in 3D with support radius H, as shape functions: the caller multiplies by the norm, which depends on
// H alone and is a uniform. All are zero for r >= H.
//   poly6      W = 315/(64 pi H^9) (H^2 - r^2)^3                      Mueller et al. 2003, eq. 20
//   spiky      dW/dr = -45/(pi H^6) (H - r)^2                         Desbrun & Gascuel 1996; Mueller eq. 21
//   viscosity  laplacian W = 45/(pi H^6) (H - r)                      Mueller eq. 22
//   cubic      W = 8/(pi H^3) {6 q^2 (q - 1) + 1 | 2 (1 - q)^3}, q = r/H, halves at q = 1/2    thesis, algorithm 11
#ifndef SPINDRIFT_KERNELS
#define SPINDRIFT_KERNELS

/// poly6 / norm, from squared distance. [m^6]
float poly6Shape(float r2, float H2) {
  const float u = max(H2 - r2, 0.0);
  return u * u * u;
}

/// -(dW/dr) of spiky / norm: positive, pushes outwards. [m^2]
float spikySlope(float r, float H) {
  const float u = max(H - r, 0.0);
  return u * u;
}

/// Laplacian of the viscosity kernel / norm. [m]
float viscosityLaplacian(float r, float H) {
  return max(H - r, 0.0);
}

/// Cubic spline / norm, from q = r/H.
float cubicShape(float q) {
  const float u = max(1.0 - q, 0.0);
  return q <= 0.5 ? 6.0 * q * q * (q - 1.0) + 1.0 : 2.0 * u * u * u;
}

/// -(dW/dq) of the cubic spline / norm: positive.
float cubicSlope(float q) {
  const float u = max(1.0 - q, 0.0);
  return q <= 0.5 ? 6.0 * q * (2.0 - 3.0 * q) : 6.0 * u * u;
}

#endif
