// Include: how large particles are drawn, in particle radii (half the spacing of the resting lattice), and which are alone.
const float kBulkRadius = 1.9;
const float kDropRadius = 0.37;
// Tint (density) below which a particle flies alone and above which it has neighbours on all sides but one; over a wave, only drops are
// to be seen besides its crests.
const float kAloneTint = 0.0;
const float kBulkTint = 0.2;
const float kBulkTintOverWave = 0.35;
// A drop is drawn as long as it flies in this time, at most so many times its width.
const float kExposureS = 0.028;
const float kMostStretch = 5.0;
const float kLeastPx = 2.6;
// Coverage of one submerged particle's foam: too little to show it alone.
const float kAfloat = 0.4;
// Coverage (fluid_thickness.frag) between which the fluid's outline lies.
const float kCoveredFrom = 0.55;
const float kCoveredTo = 0.75;
