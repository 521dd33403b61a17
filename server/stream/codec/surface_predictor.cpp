#include "surface_predictor.h"

#include <algorithm>
#include <cassert>

#include "predicted_row.h"

namespace spindrift::stream {
namespace {

/// Residuals of eight rows, tile by tile.
class TileBand {
 public:
  explicit TileBand(std::size_t n) : n_(n), classes_((n + kTile - 1) / kTile, 0), residuals_(kTile * n), sums_(n) {}

  [[nodiscard]] std::span<std::int16_t> row(std::size_t j) { return std::span(residuals_).subspan(j * n_, n_); }
  /// Of one row, for whoever predicts it.
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
  std::vector<std::uint32_t> classes_;  ///< of the tiles coded last in each column
  std::vector<std::int16_t> residuals_;
  std::vector<std::int32_t> sums_;
};

/// Calls code(band, top, rows) for each eight rows.
template <typename Code>
void forEachBand(std::size_t n, Code code) {
  TileBand band(n);
  for (std::size_t top = 0; top < n; top += kTile) code(band, top, std::min(kTile, n - top));
}

}  // namespace

void SurfacePlane::resize(std::size_t resolution_count) {
  n_ = resolution_count;
  samples_.resize(stride() * stride());
}

void SurfacePlane::assign(std::span<const std::int16_t> samples) {
  assert(samples.size() == n_ * n_);
  for (std::size_t z = 0; z < n_; ++z) std::copy_n(samples.data() + z * n_, n_, row(static_cast<std::ptrdiff_t>(z)));
  fillBorder();
}

void SurfacePlane::assign(std::span<const std::uint8_t> samples) {
  assert(samples.size() == n_ * n_);
  for (std::size_t z = 0; z < n_; ++z) std::copy_n(samples.data() + z * n_, n_, row(static_cast<std::ptrdiff_t>(z)));
  fillBorder();
}

void SurfacePlane::fillBorder() {
  const auto last = static_cast<std::ptrdiff_t>(n_) - 1;
  for (std::ptrdiff_t z = 0; z <= last; ++z) {
    std::int16_t* r = row(z);
    r[-1] = r[-2] = r[0];
    r[last + 1] = r[last + 2] = r[last];
  }
  for (const std::ptrdiff_t z : {std::ptrdiff_t{-2}, std::ptrdiff_t{-1}})
    std::copy_n(row(0) - kBorder, stride(), row(z) - kBorder);
  for (const std::ptrdiff_t z : {last + 1, last + 2}) std::copy_n(row(last) - kBorder, stride(), row(z) - kBorder);
}

void encodePlane(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights& weights,
                 ResidualEncoder& out) {
  forEachBand(plane.resolution(), [&](TileBand& band, std::size_t top, std::size_t rows) {
    for (std::size_t j = 0; j < rows; ++j) residualsOfRow(plane, history, weights, top + j, band.sums(), band.row(j));
    band.forEachTile(rows, [&](std::size_t x, std::size_t columns, std::size_t count, auto left, auto above) {
      ResidualGroup group;
      if (columns == kTile) {
        for (std::size_t j = 0; j < rows; ++j) std::copy_n(band.row(j).data() + x, kTile, group.of.data() + j * kTile);
      } else {
        for (std::size_t j = 0; j < rows; ++j)
          std::copy_n(band.row(j).data() + x, columns, group.of.data() + j * columns);
      }
      return out.putGroup(group, count, left, above);
    });
  });
}

}  // namespace spindrift::stream
