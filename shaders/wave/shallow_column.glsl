// Columns of nonlinear shallow water: elevation, bed and what stands between them, and the difference of level that drives
// the flow through the face between two of them. Used by passes of scenes with BULK_NONLINEAR.
// Dry cells have their surface on the bed: elevation = -still depth, which is positive on land.
#ifndef SPINDRIFT_SHALLOW_COLUMN
#define SPINDRIFT_SHALLOW_COLUMN

#include "wave/transfer.glsl"
#include "wave/water_column.glsl"

struct Column {
  int eta;        // elevation [units]
  int depth;      // still depth [units]; negative on land
  float water_m;  // height of the water over the bed
};

/// The column of cell i with the elevation eta [units].
Column columnOf(int i, int eta) {
  const int depth = int(stillDepth(i) * ELEVATION_UNITS_PER_M);
  return Column(eta, depth, float(max(eta + depth, 0)) * ELEVATION_UNIT_M);
}

/// A bed that rises by more than one cell's edge between two cells is a step: water falls over it instead of running down
/// a slope. [units]
int slopeStep() { return int(sim.wave_cell_m * ELEVATION_UNITS_PER_M); }

/// Rise of level across a face, as far as it drives water: a level below the bed of the other cell pulls no more than
/// one at that bed, one step lower. `head_rise` is that of the pressure head. [units]
float drivingRise(Column here, Column there, int head_rise) {
  const float step_units = float(slopeStep());
  return clamp(float(there.eta - here.eta + head_rise), -(float(max(here.eta + here.depth, 0)) + step_units), float(max(there.eta + there.depth, 0)) + step_units);
}

/// Height of the water that flows from one cell into another, over the higher bed of both; that of a step counts as the
/// bed of the upper cell. Not positive if none can flow. [m]
float passingWater_m(Column from, Column to) {
  const int sill = max(-from.depth, -to.depth - slopeStep());
  return float(from.eta - sill) * ELEVATION_UNIT_M;
}

#endif
