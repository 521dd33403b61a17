#include "dispersion_grid.h"

#include <algorithm>
#include <cmath>

#include <spindrift/core/parallel.h>

namespace spindrift::sim {
namespace {

using Four = std::array<double, 4>;

/// The four cells of a block: (0, 0), (1, 0), (0, 1), (1, 1). Its inner faces lead from one of them to another.
struct InnerFace {
  int from, to, axis;
};
constexpr InnerFace kInnerFaces[] = {{0, 1, 0}, {2, 3, 0}, {0, 2, 1}, {1, 3, 1}};

std::array<std::size_t, 4> blockOf(const DispersionGrid& fine, int x, int z) {
  return {fine.at(2 * x, 2 * z), fine.at(2 * x + 1, 2 * z), fine.at(2 * x, 2 * z + 1), fine.at(2 * x + 1, 2 * z + 1)};
}

/// Faces that lead out of a cell of a block toward -x and -z: their open shares.
std::array<double, 2> wayOut(const DispersionGrid& fine, int x, int z, int k) {
  const bool is_left = k % 2 == 0;
  const bool is_low = k < 2;
  return {is_left ? fine.open[fine.at(2 * x - 1, 2 * z + k / 2)][0] : 0.0,
          is_low ? fine.open[fine.at(2 * x + k % 2, 2 * z - 1)][1] : 0.0};
}

/// Returns the parts of a block that are connected inside it: the number of its first cell for each cell.
std::array<int, 4> partsOf(const DispersionGrid& fine, const std::array<std::size_t, 4>& block) {
  std::array<int, 4> part{0, 1, 2, 3};
  if (std::ranges::all_of(kInnerFaces, [&](const auto& f) { return fine.open[block[f.from]][f.axis] > 0.0; }))
    return {};
  for (int round = 0; round < 3; ++round) {
    for (const InnerFace& face : kInnerFaces) {
      if (fine.open[block[face.from]][face.axis] <= 0.0) continue;
      part[face.from] = part[face.to] = std::min(part[face.from], part[face.to]);
    }
  }
  return part;
}

/// Chooses the part that the coarse cell of a block stands for: the one of most cells, where parts count less whose
/// cells all have a way out toward -x or -z.
int mainPartOf(const DispersionGrid& fine, int x, int z, const std::array<std::size_t, 4>& block,
               const std::array<int, 4>& part) {
  constexpr double kWithWayOut = 0.35;
  std::array<double, 4> size{};
  std::array<bool, 4> has_way_out{true, true, true, true};
  for (int k = 0; k < 4; ++k) {
    if (fine.wet[block[k]] > 0.0) size[part[k]] += 1.0;
    const auto [west, south] = wayOut(fine, x, z, k);
    if (west <= 0.0 && south <= 0.0) has_way_out[part[k]] = false;
  }
  const auto countOf = [&](int k) { return size[k] * (has_way_out[k] ? kWithWayOut : 1.0); };
  int best = 0;
  for (int k = 1; k < 4; ++k) {
    if (countOf(k) > countOf(best)) best = k;
  }
  return best;
}

/// `coarse_nx`: columns of the coarser grid's storage.
CellOwners findOwners(const DispersionGrid& fine, int coarse_nx) {
  const int half_x = fine.nx / 2;
  const int half_z = fine.nz / 2;
  std::vector<bool> is_main(fine.wet.size(), false);
  const auto forEachBlock = [&](const auto& visit) {
    for (int z = 0; z < half_z; ++z) {
      for (int x = 0; x < half_x; ++x) {
        const auto block = blockOf(fine, x, z);
        visit(x, z, block, partsOf(fine, block));
      }
    }
  };
  const auto numberOf = [&](int x, int z) {
    return static_cast<std::size_t>((x + half_x) % half_x + coarse_nx * ((z + half_z) % half_z));
  };
  forEachBlock([&](int x, int z, const auto& block, const auto& part) {
    const int main = mainPartOf(fine, x, z, block, part);
    for (int k = 0; k < 4; ++k) is_main[block[k]] = part[k] == main && fine.wet[block[k]] > 0.0;
  });
  CellOwners owner(fine.wet.size());
  forEachBlock([&](int x, int z, const auto& block, const auto& part) {
    for (int k = 0; k < 4; ++k) {
      if (fine.wet[block[k]] <= 0.0) continue;
      if (is_main[block[k]]) {
        owner[block[k]] = numberOf(x, z);
        continue;
      }
      // Toward the side to which more of this part leads.
      double west = 0.0;
      double south = 0.0;
      for (int other = 0; other < 4; ++other) {
        if (part[other] != part[k]) continue;
        const auto [to_west, to_south] = wayOut(fine, x, z, other);
        west += to_west;
        south += to_south;
      }
      const auto [to_west, to_south] = wayOut(fine, x, z, k);
      const bool can_west = to_west > 0.0 && is_main[fine.at(2 * x - 1, 2 * z + k / 2)];
      const bool can_south = to_south > 0.0 && is_main[fine.at(2 * x + k % 2, 2 * z - 1)];
      if (can_west && (west >= south || !can_south))
        owner[block[k]] = numberOf(x - 1, z);
      else if (can_south)
        owner[block[k]] = numberOf(x, z - 1);
    }
  });
  return owner;
}

/// The two fine faces that a coarse face toward +x (axis 0) or +z covers, and the cells behind them.
struct Covered {
  std::array<std::size_t, 2> face;
  std::array<std::size_t, 2> behind;
};
Covered coveredBy(const DispersionGrid& fine, int x, int z, int axis) {
  if (axis == 0) {
    return {{fine.at(2 * x + 1, 2 * z), fine.at(2 * x + 1, 2 * z + 1)},
            {fine.at(2 * x + 2, 2 * z), fine.at(2 * x + 2, 2 * z + 1)}};
  }
  return {{fine.at(2 * x, 2 * z + 1), fine.at(2 * x + 1, 2 * z + 1)},
          {fine.at(2 * x, 2 * z + 2), fine.at(2 * x + 1, 2 * z + 2)}};
}

/// The fine cells that a coarse cell stands for, and the open faces between them.
struct Area {
  struct Face {
    std::size_t from, to;  ///< numbers of its cells in `cells`
    std::size_t cell;      ///< the fine cell that owns it
    int axis;
    double open;
  };
  std::vector<std::size_t> cells;
  std::vector<Face> faces;
  double wet = 0.0;
};

Area areaOf(const DispersionGrid& fine, const CellOwners& owner, int x, int z, std::size_t own) {
  Area area;
  const auto block = blockOf(fine, x, z);
  for (const std::size_t cell : block) {
    if (owner[cell] == own) area.cells.push_back(cell);
  }
  for (int axis = 0; axis < 2; ++axis) {
    for (const std::size_t cell : coveredBy(fine, x, z, axis).behind) {
      // Along an axis of two cells these are the block's own.
      if (owner[cell] == own && std::ranges::find(block, cell) == block.end()) area.cells.push_back(cell);
    }
  }
  for (std::size_t k = 0; k < area.cells.size(); ++k) {
    area.wet += fine.wet[area.cells[k]];
    // The faces of the block's own cells alone can have weights in its coarse fluxes.
    if (std::ranges::find(block, area.cells[k]) == block.end()) continue;
    for (int axis = 0; axis < 2; ++axis) {
      const double open = fine.open[area.cells[k]][axis];
      const auto to = std::ranges::find(area.cells, fine.behind(area.cells[k], axis));
      if (open > 0.0 && to != area.cells.end())
        area.faces.push_back({k, static_cast<std::size_t>(to - area.cells.begin()), area.cells[k], axis, open});
    }
  }
  return area;
}

/// Flux through the inner faces of an area for a net inflow of each cell: the one of least energy. The flux is the
/// difference of a potential, found by Gauss-Seidel iteration over at most eight cells.
std::vector<double> innerFlux(const Area& area, const std::vector<double>& inflow) {
  constexpr int kRounds = 400;
  std::vector<double> potential(area.cells.size(), 0.0);
  for (int round = 0; round < kRounds; ++round) {
    double largest_change = 0.0;
    for (std::size_t k = 0; k < potential.size(); ++k) {
      double sum = -inflow[k];
      double weight = 0.0;
      for (const Area::Face& face : area.faces) {
        if (face.from != k && face.to != k) continue;
        weight += face.open;
        sum += face.open * potential[face.from == k ? face.to : face.from];
      }
      if (weight <= 0.0) continue;
      largest_change = std::max(largest_change, std::abs(sum / weight - potential[k]));
      potential[k] = sum / weight;
    }
    if (largest_change < 1e-15) break;
  }
  std::vector<double> flux;
  for (const Area::Face& face : area.faces) flux.push_back(face.open * (potential[face.from] - potential[face.to]));
  return flux;
}

/// Wet shares, depths and faces of the coarse cells; weights of the fine faces that a coarse face covers.
void coverFaces(const DispersionGrid& fine, Coarsened& out) {
  DispersionGrid& coarse = out.grid;
  for (std::size_t cell = 0; cell < fine.wet.size(); ++cell) {
    if (!out.owner[cell]) continue;
    const std::size_t i = *out.owner[cell];
    coarse.wet[i] += fine.wet[cell] / 4;
    coarse.depth_m[i] += fine.wet[cell] * fine.depth_m[cell] / 4;
  }
  for (int z = 0; z < fine.nz / 2; ++z) {
    for (int x = 0; x < fine.nx / 2; ++x) {
      const std::size_t i = coarse.at(x, z);
      if (coarse.wet[i] > 0.0) coarse.depth_m[i] /= coarse.wet[i];
      for (int axis = 0; axis < 2; ++axis) {
        // A single cell between periodic sides has no neighbour but itself, and a dry one beside it in the storage.
        if (axis == 0 ? fine.nx == 2 && coarse.nx == 2 : fine.nz == 2 && coarse.nz == 2) continue;
        const Covered covered = coveredBy(fine, x, z, axis);
        const std::size_t next =
            axis == 0 ? coarse.at((x + 1) % (fine.nx / 2), z) : coarse.at(x, (z + 1) % (fine.nz / 2));
        const auto isCovered = [&](int k) {
          return out.owner[covered.face[k]] == i && out.owner[covered.behind[k]] == next;
        };
        double open = 0.0;
        double resistance = 0.0;
        for (int k = 0; k < 2; ++k) {
          if (!isCovered(k)) continue;
          open += fine.open[covered.face[k]][axis];
          resistance += fine.open[covered.face[k]][axis] * fine.resistance_pm[covered.face[k]][axis];
        }
        if (open <= 0.0) continue;
        coarse.open[i][axis] = open / 2;
        coarse.resistance_pm[i][axis] = resistance / open;
        for (int k = 0; k < 2; ++k) {
          if (!isCovered(k)) continue;
          (axis == 0 ? out.from_coarse_x : out.from_coarse_z)[covered.face[k]][axis == 0 ? 0 : 2] =
              fine.open[covered.face[k]][axis] / coarse.open[i][axis];
        }
      }
    }
  }
}

/// The faces around a block and the direction in which a flux through them leaves it.
struct Side {
  int x, z, axis;
  double outward;
};
constexpr Side kSides[] = {{0, 0, 0, 1.0}, {-1, 0, 0, -1.0}, {0, 0, 1, 1.0}, {0, -1, 1, -1.0}};

/// The same as fillInside() for a block of four open cells without a strip of a neighbour, each of whose sides is open
/// or closed: half of a coarse flux passes each inner face of its axis. Returns false for other blocks.
bool fillOpen(const DispersionGrid& fine, int x, int z, Coarsened& out) {
  if (fine.nx == 2 || fine.nz == 2) return false;
  const std::size_t own = out.grid.at(x, z);
  const auto block = blockOf(fine, x, z);
  for (const std::size_t cell : block)
    if (out.owner[cell] != own || fine.wet[cell] != 1.0) return false;
  for (const InnerFace& face : kInnerFaces)
    if (fine.open[block[face.from]][face.axis] != 1.0) return false;
  for (int axis = 0; axis < 2; ++axis)
    for (const std::size_t cell : coveredBy(fine, x, z, axis).behind)
      if (out.owner[cell] == own) return false;
  std::array<double, 4> open{};
  for (std::size_t side = 0; side < 4; ++side) {
    const auto& [dx, dz, axis, outward] = kSides[side];
    open[side] = out.grid.open[out.grid.at(x + dx, z + dz)][axis];
    if (open[side] > 0.0 && open[side] != 1.0) return false;
  }
  for (const InnerFace& face : kInnerFaces) {
    Four& weights = (face.axis == 0 ? out.from_coarse_x : out.from_coarse_z)[block[face.from]];
    for (std::size_t side = 0; side < 4; ++side)
      if (open[side] == 1.0) weights[side] = kSides[side].axis == face.axis ? 0.5 : 0.0;
  }
  return true;
}

/// Weights of the faces inside the area of a coarse cell.
void fillInside(const DispersionGrid& fine, int x, int z, Coarsened& out) {
  const DispersionGrid& coarse = out.grid;
  const auto weightsOf = [&](int axis) -> std::vector<Four>& {
    return axis == 0 ? out.from_coarse_x : out.from_coarse_z;
  };
  const Area area = areaOf(fine, out.owner, x, z, coarse.at(x, z));
  if (area.cells.empty()) return;
  const bool is_open = area.cells.size() == 4 && area.wet == 4.0 && area.faces.size() == 4 &&
                       std::ranges::all_of(area.faces, [](const Area::Face& face) { return face.open == 1.0; });
  for (std::size_t side = 0; side < 4; ++side) {
    const auto& [dx, dz, axis, outward] = kSides[side];
    if (coarse.open[coarse.at(x + dx, z + dz)][axis] <= 0.0) continue;
    // Outflow of each cell through this side for a unit of coarse flux, and what it lacks to lose as much per area as
    // the others.
    std::vector<double> inflow(area.cells.size(), 0.0);
    double total = 0.0;
    const Covered covered = coveredBy(fine, x + dx, z + dz, axis);
    for (int k = 0; k < 2; ++k) {
      const std::size_t cell = outward > 0 ? covered.face[k] : covered.behind[k];
      const double share = weightsOf(axis)[covered.face[k]][axis == 0 ? 0 : 2];
      const auto number = std::ranges::find(area.cells, cell);
      if (number == area.cells.end()) continue;
      inflow[static_cast<std::size_t>(number - area.cells.begin())] += outward * share;
      total += outward * share;
    }
    for (std::size_t k = 0; k < inflow.size(); ++k) inflow[k] -= total * fine.wet[area.cells[k]] / area.wet;
    // Through a side that is open, half of the coarse flux passes each inner face of its axis.
    const bool is_even = is_open && coarse.open[coarse.at(x + dx, z + dz)][axis] == 1.0;
    const std::vector<double> flux = is_even ? std::vector<double>{} : innerFlux(area, inflow);
    for (std::size_t e = 0; e < area.faces.size(); ++e) {
      const Area::Face& face = area.faces[e];
      weightsOf(face.axis)[face.cell][side] = is_even ? (face.axis == axis ? 0.5 : 0.0) : flux[e];
    }
  }
}

}  // namespace

DispersionGrid::DispersionGrid(CellCounts counts, std::array<double, 2> water)
    : nx(static_cast<int>(counts.x)), nz(static_cast<int>(counts.z)), extent(water) {
  const auto cells = static_cast<std::size_t>(nx) * static_cast<std::size_t>(nz);
  open.resize(cells);
  resistance_pm.resize(cells);
  wet.resize(cells);
  depth_m.resize(cells);
}

Coarsened coarsen(const DispersionGrid& fine, CellCounts counts) {
  Coarsened out{DispersionGrid(counts, {fine.extent[0] / 2, fine.extent[1] / 2}),
                findOwners(fine, static_cast<int>(counts.x)),
                {},
                {}};
  out.from_coarse_x.assign(fine.wet.size(), Four{});
  out.from_coarse_z.assign(fine.wet.size(), Four{});
  coverFaces(fine, out);
  core::forEachInParallel(static_cast<std::size_t>(fine.nz / 2), [&](std::size_t row) {
    const int z = static_cast<int>(row);
    for (int x = 0; x < fine.nx / 2; ++x) {
      if (!fillOpen(fine, x, z, out)) fillInside(fine, x, z, out);
    }
  });
  return out;
}

}  // namespace spindrift::sim
