// Modes of the 5-point Laplacian between walls, on the host: the shapes and wave numbers of standing waves in a basin
// of even depth.
#pragma once

#include <cstddef>
#include <vector>

#include <spindrift/sim_setup/basin.h>

namespace spindrift::study {

struct BasinMode {
  double k_radpm = 0.0;       ///< -lap(shape) = k^2 shape on the grid
  std::vector<double> shape;  ///< n x n, x fastest; root mean square 1 over the water, 0 on dry cells
};

/// Returns the `count` modes of lowest wave number, without the level surface, ascending. Method: subspace iteration
/// with Chebyshev filters (Zhou et al. 2006, J. Comput. Phys. 219), from a fixed start. Precondition: the water is one
/// connected part; `basin` has the 5-point stencil.
[[nodiscard]] std::vector<BasinMode> lowestModes(const sim::WaveLayout& layout, const sim::Basin& basin,
                                                 std::size_t count);

}  // namespace spindrift::study
