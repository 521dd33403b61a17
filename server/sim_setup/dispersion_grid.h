// The grids of the dispersion's V-cycle while they are laid out: which cells a coarse cell stands for, and how a coarse
// flux passes the faces of the finer grid.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <spindrift/sim_setup/dispersion.h>

namespace spindrift::sim {

/// A grid in doubles, nx x nz cells, x fastest. Each cell owns the faces toward +x and +z.
struct DispersionGrid {
  int nx = 0;
  int nz = 0;
  std::vector<std::array<double, 2>> open;           ///< open share of the x and z face; 0 where closed
  std::vector<std::array<double, 2>> resistance_pm;  ///< mean of 1/d over the open part [1/m]
  std::vector<double> wet;      ///< wet area over that of a cell; above 1 with a strip of a neighbour
  std::vector<double> depth_m;  ///< mean over the wet area; 0 where dry
  /// Extent of the water along x and z [cells of this grid]: the rest of the storage is beyond its sides.
  std::array<double, 2> extent;

  DispersionGrid(CellCounts counts, std::array<double, 2> extent);
  /// Number of a cell along an axis.
  [[nodiscard]] int along(std::size_t cell, std::size_t axis) const {
    return axis == 0 ? static_cast<int>(cell) % nx : static_cast<int>(cell) / nx;
  }
  /// Returns which share of a cell's width lies between the sides of the water.
  [[nodiscard]] double shareInside(std::size_t cell, std::size_t axis) const {
    return std::clamp(extent[axis] - along(cell, axis), 0.0, 1.0);
  }
  /// Returns whether the face that a cell owns leads out of the water, or is beyond it.
  [[nodiscard]] bool isAtSide(std::size_t cell, std::size_t axis) const {
    return along(cell, axis) + 1 >= extent[axis];
  }
  /// Returns whether walls or ground close at least a part of a face.
  [[nodiscard]] bool isObstructed(std::size_t cell, std::size_t axis) const {
    return !isAtSide(cell, axis) && open[cell][axis] < shareInside(cell, 1 - axis);
  }
  /// Returns whether any face is obstructed.
  [[nodiscard]] bool hasWalls() const {
    for (std::size_t i = 0; i < wet.size(); ++i) {
      if (isObstructed(i, 0) || isObstructed(i, 1)) return true;
    }
    return false;
  }
  [[nodiscard]] std::size_t at(int x, int z) const {
    if (x < 0 || x >= nx) x = (x + nx) % nx;
    if (z < 0 || z >= nz) z = (z + nz) % nz;
    return static_cast<std::size_t>(x + nx * z);
  }
  [[nodiscard]] std::size_t behind(std::size_t cell, std::size_t axis) const {
    const int x = along(cell, 0);
    const int z = along(cell, 1);
    return axis == 0 ? at(x + 1, z) : at(x, z + 1);
  }
};

/// Per cell: the cell of the next coarser grid that stands for it. A wall can divide a block of four cells. Then the
/// block's coarse cell stands for one part, and what the wall cuts off toward -x or -z belongs to the coarse cell
/// there. None where dry, and for the few parts that lie otherwise.
using CellOwners = std::vector<std::optional<std::size_t>>;

/// A grid of half as many cells along each axis; `counts` of coarsen() may add a row or a column of dry cells.
struct Coarsened {
  DispersionGrid grid;
  CellOwners owner;
  /// As in DispersionLevel.
  std::vector<std::array<double, 4>> from_coarse_x;
  std::vector<std::array<double, 4>> from_coarse_z;
};

/// Returns the next coarser grid and the weights of the fine faces in the coarse ones. A coarse flux passes the open
/// part of its face evenly; inside the area of its cell it goes where every fine cell gains the same height.
/// Precondition: an even number of cells along each axis, of which `counts` has at least half.
[[nodiscard]] Coarsened coarsen(const DispersionGrid& fine, CellCounts counts);

/// Changes the resistances of the coarse faces beside closed ones. `grids`: finest first, with the mean resistances
/// that coarsen() gives them; `owners`: Coarsened::owner of each grid but the coarsest.
///
/// The coarse correction is right for a motion if the coarse grid lets the motion's flux pass at its mean levels. Where
/// water turns around the end of a wall, most of it passes the nearest cells, and a coarse face with the mean
/// resistance of its cells lets too little pass. Therefore the slowest motions of the basin are computed on the finest
/// grid, and the resistances of coarse faces follow from their fluxes and levels by least squares (as in
/// Holden and Nielsen 2000, Global upscaling of permeability, Transport in Porous Media 40).
void fitResistances(std::vector<DispersionGrid>& grids, const std::vector<CellOwners>& owners);

}  // namespace spindrift::sim
