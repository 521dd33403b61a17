#include "encoder_thread.h"

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
    auto& encoder = encoders_[node.key()];
    if (!encoder) encoder = std::make_unique<stream::FrameEncoder>();
    lock.unlock();
    for (const stream::Stream stream : stream::allStreams()) {
      const auto index = static_cast<net::LayerIndex>(stream::indexOf(stream));
      if (hub_.watcherCount(node.key(), index) == 0) continue;
      const bool wants_whole = hub_.wantsWhole(node.key(), index);
      const stream::EncodedFrame encoded = encoder->encode(stream, node.mapped(), wants_whole);
      if (encoded.whole || encoded.continuing) hub_.publish(node.key(), index, {encoded.whole, encoded.continuing});
    }
    node.mapped() = {};  // frees the readback slot
    lock.lock();
  }
}

}  // namespace spindrift::app
