#include "encoder_thread.h"

#include <chrono>
#include <utility>

namespace spindrift::app {

EncoderThread::EncoderThread(net::Hub& hub) : hub_(hub), thread_([this] { loop(); }) {}

EncoderThread::~EncoderThread() {
  stop();
}

void EncoderThread::submit(const std::string& room, core::FrameView frame) {
  {
    const std::lock_guard lock(mutex_);
    auto [it, is_new] = waiting_.try_emplace(room);
    if (!is_new) {
      ++replaced_count_;
      // Diagnostics are news, not a picture: they survive a newer frame without any.
      if (!frame.diagnostics) frame.diagnostics = std::move(it->second.diagnostics);
    }
    it->second = std::move(frame);
  }
  wake_.notify_one();
}

void EncoderThread::forget(const std::string& room) {
  const std::lock_guard lock(mutex_);
  waiting_.erase(room);
  encoders_.erase(room);
}

std::array<EncoderThread::StreamCost, stream::kStreamCount> EncoderThread::costs() const {
  const std::lock_guard lock(mutex_);
  return costs_;
}

void EncoderThread::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

std::uint64_t EncoderThread::replacedCount() const {
  const std::lock_guard lock(mutex_);
  return replaced_count_;
}

std::uint64_t EncoderThread::encodeCount(const std::string& room, stream::Stream stream) const {
  const std::lock_guard lock(mutex_);
  const auto it = encoders_.find(room);
  return it == encoders_.end() ? 0 : it->second->encodeCount(stream);
}

void EncoderThread::loop() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
    if (stopping_) return;
    auto node = waiting_.extract(waiting_.begin());
    auto& kept = encoders_[node.key()];
    if (!kept) kept = std::make_shared<stream::FrameEncoder>();
    const auto encoder = kept;  // the room may be forgotten meanwhile
    lock.unlock();
    std::array<StreamCost, stream::kStreamCount> spent{};
    for (const stream::Stream stream : stream::allStreams()) {
      const auto index = static_cast<net::LayerIndex>(stream::indexOf(stream));
      if (hub_.watcherCount(node.key(), index) == 0) continue;
      const bool wants_whole = hub_.wantsWhole(node.key(), index);
      const auto begin = std::chrono::steady_clock::now();
      const stream::EncodedFrame encoded = encoder->encode(stream, node.mapped(), wants_whole);
      StreamCost& cost = spent[index];
      cost.encode_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      for (const core::SharedBytes& form : {encoded.whole, encoded.continuing}) {
        if (form) cost.bytes_count += form->size();
      }
      cost.frame_count = encoded.whole || encoded.continuing ? 1 : 0;
      if (encoded.whole || encoded.continuing) hub_.publish(node.key(), index, {encoded.whole, encoded.continuing});
    }
    node.mapped() = {};  // frees the readback slot
    lock.lock();
    for (std::size_t k = 0; k < costs_.size(); ++k) {
      costs_[k].frame_count += spent[k].frame_count;
      costs_[k].bytes_count += spent[k].bytes_count;
      costs_[k].encode_s += spent[k].encode_s;
    }
  }
}

}  // namespace spindrift::app
