#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include <spindrift/rooms/encoder_thread.h>

namespace spindrift::rooms {

EncoderThread::EncoderThread(FrameOutlet& outlet)
    : EncoderThread(outlet, std::clamp(std::thread::hardware_concurrency() / 4, 1u, 4u)) {}

EncoderThread::EncoderThread(FrameOutlet& outlet, unsigned thread_count) : outlet_(outlet) {
  for (unsigned k = 0; k < thread_count; ++k) threads_.emplace_back([this] { loop(); });
}

EncoderThread::~EncoderThread() {
  stop();
}

void EncoderThread::submit(const std::string& room, std::shared_ptr<const core::DemandTable> demand,
                           core::FrameView frame) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return;
    const auto waiting = std::ranges::find(waiting_, room, &Waiting::room);
    if (waiting == waiting_.end()) {
      waiting_.push_back({room, std::move(demand), std::move(frame)});
    } else {
      ++rooms_[room].counts.replaced_count;
      // Keep the diagnostics of the replaced frame if the newer one has none: they are sent once only.
      if (!frame.diagnostics) frame.diagnostics = std::move(waiting->frame.diagnostics);
      waiting->frame = std::move(frame);
    }
  }
  wake_.notify_one();
}

void EncoderThread::forget(const std::string& room) {
  const std::lock_guard lock(mutex_);
  std::erase_if(waiting_, [&](const Waiting& waiting) { return waiting.room == room; });
  rooms_.erase(room);
}

EncoderThread::Costs EncoderThread::costs() const {
  const std::lock_guard lock(mutex_);
  return costs_;
}

void EncoderThread::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
  const std::lock_guard lock(mutex_);
  waiting_.clear();  // frames are read from the memory of their device, which is destroyed next
}

EncoderThread::FrameCounts EncoderThread::frameCounts(const std::string& room) const {
  const std::lock_guard lock(mutex_);
  const auto known = rooms_.find(room);
  return known == rooms_.end() ? FrameCounts{} : known->second.counts;
}

std::deque<EncoderThread::Waiting>::iterator EncoderThread::next() {
  return std::ranges::find_if(waiting_, [&](const Waiting& waiting) { return !rooms_[waiting.room].is_busy; });
}

void EncoderThread::loop() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return stopping_ || next() != waiting_.end(); });
    if (stopping_) return;
    const auto first = next();
    Waiting oldest = std::move(*first);
    waiting_.erase(first);
    KnownRoom& known = rooms_[oldest.room];
    known.is_busy = true;
    if (!known.encoder) known.encoder = std::make_shared<codec::FrameEncoder>();
    ++known.counts.encoded_count;
    const auto encoder = known.encoder;  // the room may be forgotten while this runs
    lock.unlock();
    const Costs spent = encode(oldest, *encoder);
    oldest.frame = {};  // releases the readback slot
    lock.lock();
    if (const auto found = rooms_.find(oldest.room); found != rooms_.end() && found->second.encoder == encoder)
      found->second.is_busy = false;
    if (!waiting_.empty()) wake_.notify_one();  // another thread can take a newer frame of this room
    for (std::size_t k = 0; k < costs_.size(); ++k) {
      for (std::size_t level = 0; level < core::kLevelCount; ++level) {
        costs_[k][level].frame_count += spent[k][level].frame_count;
        costs_[k][level].bytes_count += spent[k][level].bytes_count;
        costs_[k][level].encode_s += spent[k][level].encode_s;
      }
    }
  }
}

EncoderThread::Costs EncoderThread::encode(const Waiting& job, codec::FrameEncoder& encoder) {
  const core::FrameView& frame = job.frame;
  Costs spent{};
  // All layers are published together, so that they can leave in one write per session.
  struct Ready {
    codec::Stream stream;
    codec::EncodedFrame encoded;
    core::FrameLevels levels;
  };
  std::vector<Ready> ready;
  for (const codec::Stream stream : codec::allStreams()) {
    const std::uint32_t reduced_count = codec::reducedCountOf(stream, frame.reduced_counts);
    const core::LevelSet due = codec::levelsTaking(stream.layer, frame.due);
    const core::StreamDemand asked = job.demand->of(codec::indexOf(stream), std::chrono::steady_clock::now());
    const core::StreamDemand demand = core::demandOfFrame(asked, reduced_count, due);
    for (const core::Level level : core::kLevels) {
      const core::LevelDemand& wanted = demand[core::indexOf(level)];
      if (wanted.watcher_count == 0) continue;
      const auto begin = std::chrono::steady_clock::now();
      const codec::EncodedFrame encoded = encoder.encode(stream, frame, level, wanted.wants_keyframe);
      StreamCost& cost = spent[codec::indexOf(stream)][core::indexOf(level)];
      cost.encode_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (!encoded.keyframe && !encoded.delta) continue;
      cost.frame_count = 1;
      for (const core::SharedBytes& form : {encoded.keyframe, encoded.delta}) {
        if (form) cost.bytes_count += form->size();
      }
      ready.push_back({stream, encoded, {.level = level, .reduced_count = reduced_count, .due = due}});
    }
  }
  for (const Ready& one : ready) outlet_.publish(job.room, one.stream, one.encoded, one.levels);
  return spent;
}

}  // namespace spindrift::rooms
