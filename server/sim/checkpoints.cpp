#include "checkpoints.h"

#include <utility>

namespace spindrift::sim {

Checkpoints::Checkpoints(Creation& create, std::vector<gpu::Buffer*> state) : state_(std::move(state)) {
  for (Copy& copy : copies_) {
    for (const gpu::Buffer* live : state_)
      copy.buffers.push_back(create.buffer("checkpoint of " + live->name(), live->sizeBytes()));
  }
}

void Checkpoints::save(std::uint64_t tick) {
  Copy& copy = copies_[1 - good_];
  if (copy.is_filled) return;
  for (std::size_t k = 0; k < state_.size(); ++k) copy.buffers[k].copyFrom(*state_[k], 0, state_[k]->sizeBytes());
  copy.tick = tick;
  copy.flow_ratio = 1.0;
  copy.is_filled = true;
}

void Checkpoints::confirm(std::uint64_t tick) {
  const Copy& waiting = copies_[1 - good_];
  if (!waiting.is_filled || waiting.tick > tick) return;
  good_ = 1 - good_;
  has_good_ = true;
  is_tried_ = false;
  copies_[1 - good_].is_filled = false;
}

std::optional<double> Checkpoints::restore() {
  if (!has_good_ || is_tried_) {
    forget();
    return std::nullopt;
  }
  is_tried_ = true;
  for (std::size_t k = 0; k < state_.size(); ++k)
    state_[k]->copyFrom(copies_[good_].buffers[k], 0, state_[k]->sizeBytes());
  copies_[1 - good_].is_filled = false;
  return copies_[good_].flow_ratio;
}

void Checkpoints::scaleFlow(double ratio) {
  for (Copy& copy : copies_) copy.flow_ratio *= ratio;
}

void Checkpoints::forget() {
  has_good_ = false;
  is_tried_ = false;
  for (Copy& copy : copies_) copy.is_filled = false;
}

}  // namespace spindrift::sim
