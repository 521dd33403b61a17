// Resistances of the coarse grids of the dispersion's V-cycle beside walls.
#pragma once

#include <vector>

#include "dispersion_grid.h"

namespace spindrift::sim {

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
