#include "plane_chain.h"

#include <cassert>
#include <utility>

namespace spindrift::stream {

PlaneChainEncoder::Forms PlaneChainEncoder::encode(SurfacePlane plane, bool wants_whole) {
  const bool is_first = before_.resolution() != plane.resolution();
  if (is_first) before_ = earlier_ = plane;
  Forms out;
  if (!is_first) out.continuing = continuing(plane);
  if (is_first || wants_whole) out.whole = whole(plane);
  earlier_ = std::exchange(before_, std::move(plane));
  return out;
}

PlaneChainEncoder::Form PlaneChainEncoder::continuing(const SurfacePlane& now) {
  Form out;
  const SurfaceHistory history{&before_, &earlier_};
  out.weights = fitWeights(now, history);
  encodePlane(now, history, out.weights, residuals_);
  residuals_.finish(out.payload);
  return out;
}

PlaneChainEncoder::Form PlaneChainEncoder::whole(const SurfacePlane& now) {
  Form out;
  out.weights = fitWeights(now, {});
  encodePlane(now, {}, out.weights, residuals_);
  const SurfaceHistory history{&now, nullptr};
  out.earlier_weights = fitWeights(before_, history);
  encodePlane(before_, history, out.earlier_weights, residuals_);
  residuals_.finish(out.payload);
  return out;
}

bool PlaneChainDecoder::readWhole(core::ByteView payload, std::size_t resolution_count, const SurfaceWeights& weights,
                                  const SurfaceWeights& earlier_weights) {
  ResidualDecoder residuals(payload);
  before_ = SurfacePlane(resolution_count);
  earlier_ = SurfacePlane(resolution_count);
  decodePlane(residuals, {}, weights, before_);
  decodePlane(residuals, {&before_, nullptr}, earlier_weights, earlier_);
  if (!residuals.isAtEnd()) restart();
  return before_.resolution() > 0;
}

bool PlaneChainDecoder::readContinuing(core::ByteView payload, const SurfaceWeights& weights) {
  assert(before_.resolution() > 0);
  ResidualDecoder residuals(payload);
  SurfacePlane now(before_.resolution());
  decodePlane(residuals, {&before_, &earlier_}, weights, now);
  earlier_ = std::exchange(before_, std::move(now));
  if (!residuals.isAtEnd()) restart();
  return before_.resolution() > 0;
}

}  // namespace spindrift::stream
