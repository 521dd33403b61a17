#include "surface_predictor.h"

#include <algorithm>
#include <cassert>

#include "group_writer.h"
#include "predicted_row.h"

namespace spindrift::codec {
namespace {

/// Residuals of eight rows, tile by tile.
class TileBand {
 public:
  explicit TileBand(std::size_t n) : n_(n), classes_((n + kTile - 1) / kTile, 0), residuals_(kTile * n), sums_(n) {}

  [[nodiscard]] std::span<std::int16_t> row(std::size_t j) { return std::span(residuals_).subspan(j * n_, n_); }
  [[nodiscard]] std::span<const std::int16_t> rows(std::size_t count) const {
    return std::span(residuals_).first(count * n_);
  }
  /// Class of the newest tile in each column.
  [[nodiscard]] std::span<std::uint32_t> classes() { return classes_; }
  /// Scratch memory of the prediction for one row.
  [[nodiscard]] std::span<std::int32_t> sums() { return sums_; }
  /// Calls code(x, columns, count, left, above) for each tile; it returns the tile's class.
  template <typename Code>
  void forEachTile(std::size_t rows, Code code) {
    std::uint32_t left = 0;
    for (std::size_t tile = 0; tile < classes_.size(); ++tile) {
      const std::size_t columns = std::min(kTile, n_ - tile * kTile);
      left = classes_[tile] = code(tile * kTile, columns, rows * columns, left, classes_[tile]);
    }
  }

 private:
  std::size_t n_;
  std::vector<std::uint32_t> classes_;
  std::vector<std::int16_t> residuals_;
  std::vector<std::int32_t> sums_;
};

/// Calls code(band, top, rows) for each band of eight rows.
template <typename Code>
void forEachBand(core::CellCounts count, Code code) {
  TileBand band(count.x);
  for (std::size_t top = 0; top < count.z; top += kTile) code(band, top, std::min(kTile, count.z - top));
}

}  // namespace

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
  fillBorder();
  is_small_ = bits < 1 << 13;
}

void SurfacePlane::assign(std::span<const std::uint8_t> samples) {
  assert(samples.size() == count_.total());
  const std::size_t nx = count_.x;
  for (std::size_t z = 0; z < count_.z; ++z)
    std::copy_n(samples.data() + z * nx, nx, row(static_cast<std::ptrdiff_t>(z)));
  fillBorder();
  is_small_ = true;
}

void SurfacePlane::fillBorder() {
  const auto last_x = static_cast<std::ptrdiff_t>(count_.x) - 1;
  const auto last = static_cast<std::ptrdiff_t>(count_.z) - 1;
  for (std::ptrdiff_t z = 0; z <= last; ++z) {
    std::int16_t* r = row(z);
    r[-1] = r[-2] = r[0];
    r[last_x + 1] = r[last_x + 2] = r[last_x];
  }
  for (const std::ptrdiff_t z : {std::ptrdiff_t{-2}, std::ptrdiff_t{-1}})
    std::copy_n(row(0) - kBorder, stride(), row(z) - kBorder);
  for (const std::ptrdiff_t z : {last + 1, last + 2}) std::copy_n(row(last) - kBorder, stride(), row(z) - kBorder);
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
      left = writer.putTile(first, n, left, classes[tile]);
    } else {
      ResidualGroup group;
      for (std::size_t j = 0; j < rows; ++j) std::copy_n(first + j * n, columns, group.of.data() + j * columns);
      left = writer.putGroup(group, rows * columns, left, classes[tile]);
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
  forEachBand(plane.count(), [&](TileBand& band, std::size_t top, std::size_t rows) {
    for (std::size_t j = 0; j < rows; ++j) residualsOfRow(plane, history, weights, top + j, band.sums(), band.row(j));
    out.end(put(band.rows(rows), plane.count().x, band.classes(), out.begin(band.classes().size())));
  });
}

}  // namespace spindrift::codec
