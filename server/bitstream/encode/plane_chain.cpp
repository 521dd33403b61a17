#include <utility>

#include <spindrift/bitstream/encode/plane_chain.h>

namespace spindrift::codec {

PlaneChainEncoder::Forms PlaneChainEncoder::encode(bool wants_keyframe) {
  const bool is_first = before_.count() != next_.count();
  if (is_first) {
    before_ = earlier_ = next_;
    guess_.reset();
  }
  Forms out;
  if (!is_first) {
    const SurfaceHistory history{&before_, &earlier_};
    Form& delta = out.delta.emplace();
    delta.weights = fitWeights(next_, history, guess_ ? &*guess_ : nullptr);
    guess_ = delta.weights;
    encodePlane(next_, history, delta.weights, residuals_);
    residuals_.finish(delta.payload);
  }
  if (is_first || wants_keyframe) out.keyframe = keyframeOf(next_, before_, residuals_);
  std::swap(earlier_, before_);
  std::swap(before_, next_);
  return out;
}

PlaneChainEncoder::Form PlaneChainEncoder::keyframeOf(const SurfacePlane& newest, const SurfacePlane& before,
                                                      ResidualEncoder& residuals) {
  Form out;
  out.weights = fitWeights(newest, {}, nullptr);
  encodePlane(newest, {}, out.weights, residuals);
  const SurfaceHistory history{&newest, nullptr};
  out.earlier_weights = fitWeights(before, history, nullptr);
  encodePlane(before, history, out.earlier_weights, residuals);
  residuals.finish(out.payload);
  return out;
}

}  // namespace spindrift::codec
