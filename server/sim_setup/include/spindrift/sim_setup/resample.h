// Moves a field from one grid to another one over the same rectangle, keeping its integral. Pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <spindrift/core/cell_counts.h>

namespace spindrift::sim {

/// One axis of the samples. Sample i is the mean over the cells' widths from i + shift to i + 1 + shift, in cells from
/// the minus side: a shift of 0 for cells, of 0.5 for the faces toward plus. What lies beyond a side belongs to the
/// other end; on an axis with sides, shifted samples are those of faces, and the last one is closed.
struct SampleAxis {
  double shift_cells = 0.0;
  bool is_periodic = false;
};

/// nx x nz samples, x fastest.
struct Field {
  std::vector<double> mean;   ///< over the wet part of each cell; 0 in dry cells
  std::vector<double> share;  ///< wet share of each cell, 0 to 1
};

/// Returns the field on `to` cells. The integral over the wet area (the sum of mean x share x cell area)
/// stays the same but for rounding in double precision, and no mean is above or below all means of `from`. Shares are
/// carried by area. Each axis uses the piecewise parabolic method (Colella & Woodward 1984, equations 1.6 to 1.10, with
/// fourth-order edges on the even grid); parabolas do not reach across dry cells.
Field resample(const Field& from, core::CellCounts from_count, core::CellCounts to, SampleAxis x, SampleAxis z);

/// Gives wet cells without water (share of 0 in `field`) the mean of their wet neighbours, from the edge inwards, and
/// 0 where no neighbour has any; dry cells become 0. Afterwards the share is 1 in wet cells and 0 in dry ones.
void settleOn(std::span<const char> wet, core::CellCounts count, bool periodic_x, bool periodic_z, Field& field);

/// Returns whole numbers near `values` (0 where not wet) whose sum is exactly `total`: the difference of the sums is
/// spread evenly over the wet cells, and rounding is passed on from cell to cell. Without a wet cell: all 0.
std::vector<std::int64_t> wholeWithTotal(std::span<const double> values, std::span<const char> wet, std::int64_t total);

}  // namespace spindrift::sim
