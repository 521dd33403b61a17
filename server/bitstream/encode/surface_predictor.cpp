#include <algorithm>
#include <cassert>

#include <spindrift/bitstream/encode/surface_predictor.h>

#include "group_writer.h"

namespace spindrift::codec {

void SurfacePlane::resize(core::CellCounts count) {
  count_ = count;
  is_small_ = false;
  samples_.resize(stride() * (count.z + 2 * kBorder));
}

void SurfacePlane::assign(std::span<const std::int16_t> samples) {
  assert(samples.size() == count_.total());
  constexpr std::size_t kLine = 64 / sizeof(std::int16_t);
  int bits = 0;  // all samples combined by or, negative ones inverted
  const std::size_t nx = count_.x;
  for (std::size_t z = 0; z < count_.z; ++z) {
    const std::int16_t* from = samples.data() + z * nx;
    std::int16_t* to = row(static_cast<std::ptrdiff_t>(z));
    for (std::size_t x = 0; x < nx; x += kLine) fetchAhead(from + x);
    std::int16_t row_bits = 0;
    for (std::size_t x = 0; x < nx; ++x) {
      to[x] = from[x];
      row_bits = static_cast<std::int16_t>(row_bits | (from[x] ^ from[x] >> 15));
    }
    bits |= row_bits;
  }
  fillBorder(row(0), nx, count_.z, stride());
  is_small_ = bits < 1 << 13;
}

void SurfacePlane::assign(std::span<const std::uint8_t> samples) {
  assert(samples.size() == count_.total());
  const std::size_t nx = count_.x;
  for (std::size_t z = 0; z < count_.z; ++z)
    std::copy_n(samples.data() + z * nx, nx, row(static_cast<std::ptrdiff_t>(z)));
  fillBorder(row(0), nx, count_.z, stride());
  is_small_ = true;
}

namespace {

/// Writes the tiles of a band; classes[i] is the class of the tile above, afterwards of tile i.
SPINDRIFT_INLINE GroupWriter putTiles(std::span<const std::int16_t> residuals, std::size_t n,
                                      std::span<std::uint32_t> classes, GroupWriter writer) {
  const std::size_t rows = residuals.size() / n;
  std::uint32_t left = 0;
  for (std::size_t tile = 0; tile < classes.size(); ++tile) {
    const std::int16_t* first = residuals.data() + tile * kTile;
    const std::size_t columns = std::min(kTile, n - tile * kTile);
    if (rows == kTile && columns == kTile) {
      left = writer.putGroup(GroupRows(first, n), kGroupMaxCount, left, classes[tile]);
    } else {
      ResidualGroup group;
      for (std::size_t j = 0; j < rows; ++j) std::copy_n(first + j * n, columns, group.of.data() + j * columns);
      left = writer.putGroup(GroupRows(group.of.data()), rows * columns, left, classes[tile]);
    }
    classes[tile] = left;
  }
  return writer;
}
GroupWriter putTilesPlainly(std::span<const std::int16_t> residuals, std::size_t n, std::span<std::uint32_t> classes,
                            GroupWriter writer) {
  return putTiles(residuals, n, classes, writer);
}
SPINDRIFT_VECTORS GroupWriter putTilesWithVectors(std::span<const std::int16_t> residuals, std::size_t n,
                                                  std::span<std::uint32_t> classes, GroupWriter writer) {
  return putTiles(residuals, n, classes, writer);
}

}  // namespace

void encodePlane(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights& weights,
                 ResidualEncoder& out) {
  const auto put = usesVectors() ? putTilesWithVectors : putTilesPlainly;
  const auto [nx, nz] = plane.count();
  std::vector<std::uint32_t> classes((nx + kTile - 1) / kTile, 0);  // of the newest tile in each column
  std::vector<std::int16_t> residuals(kTile * nx);
  std::vector<std::int32_t> sums(nx);
  for (std::size_t top = 0; top < nz; top += kTile) {
    const std::size_t rows = std::min(kTile, nz - top);
    const std::span<std::int16_t> band = std::span(residuals).first(rows * nx);
    for (std::size_t j = 0; j < rows; ++j)
      residualsOfRow(plane, history, weights, top + j, sums, band.subspan(j * nx, nx));
    out.end(put(band, nx, classes, out.begin(classes.size())));
  }
}

}  // namespace spindrift::codec
