// The weights with which the field pass computes elevation, slope and curvature from samples of the surface, along one axis and for
// samples at distance 0, 1 and 2.

/** Weights at distance 0, 1 and 2. */
type Taps = readonly [number, number, number];

/**
 * Smooths across the quantum's steps: removes waves of 2 samples, and keeps 75 % of the height at 4 samples and 98 % at 8. Binomial
 * weights (2, 1, 0) / 4 would keep 50 and 85 %.
 */
export const kSmooth: Taps = [10 / 16, 4 / 16, -1 / 16];
/** Slope per sample, odd: fourth order, 85 % at 4 samples and 99 % at 8. Central differences have 64 and 90 %. */
export const kSlope: Taps = [0, 8 / 12, -1 / 12];
/** Second derivative per sample squared: second order, because the quantum's steps weigh most here. */
export const kCurvature: Taps = [-2, 1, 0];
