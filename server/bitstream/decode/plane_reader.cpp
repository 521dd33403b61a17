#include <algorithm>
#include <cstring>
#include <utility>

#include <spindrift/bitstream/decode/plane_reader.h>

#include "band_prediction.h"

namespace spindrift::codec {
namespace {

std::size_t sumsStrideOf(const PlaneLayout& layout) {
  return kSumsLeft + kTile * layout.tilesCount() + kSumsRight;
}

}  // namespace

std::size_t PlaneRow::takeParts(std::uint8_t* memory) {
  std::size_t used = 0;
  const auto take = [&]<typename Element>(Element*& part, std::size_t count) {
    part = memory != nullptr ? reinterpret_cast<Element*>(memory + used) : nullptr;
    used += (count * sizeof(Element) + kAlignment - 1) / kAlignment * kAlignment;
  };
  for (std::int16_t** plane : {&next_, &before_, &earlier_}) take(*plane, layout_.sampleCount());
  take(residuals_, layout_.tilesCount());
  take(sums_, kTile * sumsStrideOf(layout_));
  take(classes_, layout_.tilesCount());
  return used;
}

std::size_t PlaneRow::bytesFor(std::size_t nx, std::size_t nz) {
  PlaneRow row;
  row.layout_.nx = nx;
  row.layout_.nz = nz;
  return row.takeParts(nullptr);
}

void PlaneRow::place(std::uint8_t* memory, std::size_t nx, std::size_t nz) {
  layout_.nx = nx;
  layout_.nz = nz;
  std::memset(memory, 0, takeParts(memory));
  has_row_ = false;
}

bool PlaneRow::readKeyframe(const std::uint8_t* payload, std::uint32_t byte_count, const SurfaceWeights& weights,
                            const SurfaceWeights& earlier_weights) {
  has_row_ = false;
  if (byte_count > BitSource::kMaxBytes) return false;
  ResidualReader in(payload, byte_count);
  readPlane(in, {nullptr, nullptr}, weights, before_);
  readPlane(in, {before_, nullptr}, earlier_weights, earlier_);
  has_row_ = in.isAtEnd();
  return has_row_;
}

bool PlaneRow::readDelta(const std::uint8_t* payload, std::uint32_t byte_count, const SurfaceWeights& weights) {
  if (!std::exchange(has_row_, false) || byte_count > BitSource::kMaxBytes) return false;
  ResidualReader in(payload, byte_count);
  readPlane(in, {before_, earlier_}, weights, next_);
  std::swap(earlier_, before_);
  std::swap(before_, next_);
  has_row_ = in.isAtEnd();
  return has_row_;
}

void PlaneRow::readPlane(ResidualReader& in, const History& history, const SurfaceWeights& weights,
                         std::int16_t* plane) {
  // A missing plane has the weight 0.
  SurfaceWeights known = weights;
  if (history.earlier == nullptr) std::fill_n(known.of.begin() + SurfaceWeights::kEarlier, 3, 0);
  const std::int16_t* const earlier = history.earlier != nullptr ? history.earlier : history.before;
  const std::size_t stride = layout_.stride(), sums_stride = sumsStrideOf(layout_);
  std::memset(classes_, 0, layout_.tilesCount());
  std::memset(plane + layout_.placeOf(-1), 0, stride * sizeof *plane);
  for (std::size_t top = 0; top < layout_.nz; top += kTile) {
    readTiles(in, std::min(kTile, layout_.nz - top));
    const std::size_t begin = layout_.placeOf(static_cast<std::ptrdiff_t>(top));
    for (std::size_t j = 0; j < kTile; ++j) {
      const std::size_t row = begin + j * stride;
      std::uint32_t* const sums = sums_ + j * sums_stride + kSumsLeft;
      if (history.before == nullptr)
        sumResiduals(residuals_, j, layout_.tilesCount(), sums);
      else
        sumHistory({history.before + row, earlier + row, stride}, known, residuals_, j, layout_.tilesCount(), sums);
    }
    predictBand(sums_ + kSumsLeft, sums_stride, known, top == 0, plane + begin, stride, layout_.nx);
  }
  fillBorder(plane + layout_.placeOf(0), layout_.nx, layout_.nz, stride);
}

void PlaneRow::readTiles(ResidualReader& in, std::size_t rows) {
  std::uint32_t left = 0;
  for (std::size_t tile = 0; tile < layout_.tilesCount(); ++tile) {
    const std::size_t columns = std::min(kTile, layout_.nx - tile * kTile);
    ResidualGroup& group = residuals_[tile];
    left = in.group(group, rows * columns, left, classes_[tile]);
    classes_[tile] = static_cast<std::uint8_t>(left);
    if (columns == kTile) continue;
    // Move the rows of a narrow tile to their positions in the group, the last one first.
    for (std::size_t j = rows; j-- > 0;)
      std::memmove(group.of.data() + j * kTile, group.of.data() + j * columns, columns * sizeof group.of[0]);
  }
}

}  // namespace spindrift::codec
