#include <spindrift/core/frame_view.h>

namespace spindrift::core {

FrameView frameAt(const FrameView& frame, Level level) {
  if (level == Level::kFull) return frame;
  const ReducedView& reduced = frame.reduced[indexOf(level)];
  FrameView out;
  out.tick = frame.tick;
  out.time_s = frame.time_s;
  out.asked_s = frame.asked_s;
  out.state_id = frame.state_id;
  out.level = level;
  out.surface = reduced.surface;
  out.particles = reduced.particles;
  out.foam = reduced.foam;
  out.reduced_counts = frame.reduced_counts;
  out.lease = frame.lease;
  return out;
}

}  // namespace spindrift::core
