// Smoothing kernels in 3D with support radius H, as shape functions: the caller multiplies by the norm, which depends on
// H alone and is a uniform. All are zero for r >= H. KERNEL_SET chooses the density and pressure kernels when a shader is
// specialised:
//   MULLER       W = 315/(64 pi H^9) (H^2 - r^2)^3                                   poly6: Mueller et al. 2003, eq. 20
//                dW/dr = -45/(pi H^6) (H - r)^2                                      spiky: Desbrun & Gascuel 1996
//   CUBIC_SPLINE W = 8/(pi H^3) {6 q^2 (q - 1) + 1 | 2 (1 - q)^3}, halves at q = 1/2  thesis, algorithm 11
//   WENDLAND_C2  W = 21/(2 pi H^3) (1 - q)^4 (4q + 1)                                Wendland 1995
//   viscosity    laplacian W = 45/(pi H^6) (H - r), in every set                     Mueller eq. 22
#ifndef SPINDRIFT_KERNELS
#define SPINDRIFT_KERNELS

#define KERNEL_SET_MULLER 1
#define KERNEL_SET_CUBIC_SPLINE 2
#define KERNEL_SET_WENDLAND_C2 3

/// Laplacian of the viscosity kernel / norm. [m]
float viscosityLaplacian(float r, float H) {
  return max(H - r, 0.0);
}

/// -(dW/dq) of the cubic spline / norm: positive.
float cubicSlope(float q) {
  const float u = max(1.0 - q, 0.0);
  return q <= 0.5 ? 6.0 * q * (2.0 - 3.0 * q) : 6.0 * u * u;
}

/// Cubic spline / norm, from q = r/H.
float cubicShape(float q) {
  const float u = max(1.0 - q, 0.0);
  return q <= 0.5 ? 6.0 * q * q * (q - 1.0) + 1.0 : 2.0 * u * u * u;
}

// For the inner loops: H and its inverse, so that they need no division.
struct Support {
  float H;
  float inverse_H;
};

Support makeSupport(float H) {
  return Support(H, 1.0 / H);
}

// densityShape: W / density norm, from the squared distance.
// pressurePull: -(dW/dr) / r / slope norm, from the squared distance. Multiplied by the vector from the neighbour, it
// points away from it.
#if KERNEL_SET == KERNEL_SET_MULLER
float densityShape(float r2, Support k) {
  const float u = max(k.H * k.H - r2, 0.0);
  return u * u * u;
}
float pressurePull(float r2, Support k) {
  const float inverse_r = inversesqrt(max(r2, 1e-12));
  const float u = max(k.H - r2 * inverse_r, 0.0);
  return u * u * inverse_r;
}
#elif KERNEL_SET == KERNEL_SET_CUBIC_SPLINE
float densityShape(float r2, Support k) {
  return cubicShape(sqrt(r2) * k.inverse_H);
}
float pressurePull(float r2, Support k) {
  const float inverse_r = inversesqrt(max(r2, 1e-12));
  return cubicSlope(r2 * inverse_r * k.inverse_H) * inverse_r;
}
#else
float densityShape(float r2, Support k) {
  const float q = sqrt(r2) * k.inverse_H;
  const float u = max(1.0 - q, 0.0);
  return (u * u) * (u * u) * (4.0 * q + 1.0);
}
float pressurePull(float r2, Support k) {
  const float u = max(1.0 - sqrt(r2) * k.inverse_H, 0.0);
  return u * u * u * k.inverse_H;  // q (1 - q)^3 / r: no pole at r = 0
}
#endif

#endif
