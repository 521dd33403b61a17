// Strokes: what people draw through the water, each with a tool. A finger presses a dent that moves with it, so it
// leaves a wake; rain falls under a cloud; a calmed disc slows the flow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <shared/event_uniforms.h>

#include <spindrift/core/result.h>

namespace spindrift::sim {

/// Radius of a rain drop's dent: as wide as the wave grid can represent without ringing.
inline constexpr double kDropRadius_cells = 2.5;

enum class StrokeTool { kFinger, kRain, kCalm };

/// Position of a finger at a time.
struct StrokePoint {
  double time_s = 0.0;  ///< on the stroke's own clock
  double x_m = 0.0;
  double z_m = 0.0;
  double pressure_ratio = 1.0;  ///< 0 to 1
};

/// The beginning of a stroke, or more of it.
struct StrokePart {
  std::uint32_t person_id = 0;
  std::uint32_t stroke_id = 0;  ///< of this person
  double radius_m = 0.0;        ///< of the dent, the cloud or the calmed disc; what the first part says counts
  double depth_m = 0.0;         ///< of the dent or of a drop; likewise
  std::vector<StrokePoint> points{};
  bool ends = false;  ///< the finger is lifted after the last point
  StrokeTool tool = StrokeTool::kFinger;
};

/// A stroke on the water.
struct Stroke {
  std::uint32_t person_id = 0;
  std::uint32_t stroke_id = 0;
  StrokeTool tool = StrokeTool::kFinger;
  double radius_m = 0.0;
  double depth_m = 0.0;
  std::vector<StrokePoint> path{};  ///< what is still to be drawn, from the point before play_s on; never empty
  bool is_lifted = false;
  bool is_whole = false;  ///< came in one part
  double play_s = 0.0;    ///< time on the path, up to which it is drawn
  double still_s = 0.0;   ///< since the last part
  /// As the last step left it: the position, and the share of the full depth, rain or calm.
  double x_m = 0.0;
  double z_m = 0.0;
  double level_ratio = 0.0;
};

/// The water under the strokes.
struct StrokeWater {
  double dt_s = 0.0;  ///< length of a step
  double cell_m = 0.0;
};

/// The path is drawn a little after its points have come, so that a trace does not depend on the rhythm in which the
/// network delivers them. A dent goes from one position to the next by two splashes: one fills it, one presses it.
/// So a stroke conserves the water to the last unit, as splashes do, and moves none while the finger rests. Drops are
/// splashes at random positions, which repeat with the run.
class Strokes {
 public:
  /// Limits of strokes at the same time: of all, and of one person, the fingers of two hands.
  static constexpr std::size_t kMaxCount = 128;
  static constexpr std::size_t kPersonMaxCount = 10;
  /// Points of a path that wait; the oldest give way.
  static constexpr std::size_t kPathMaxCount = 256;
  /// Longest that a path may lie ahead of the play clock, and that of a stroke that came in one part; beyond that the
  /// finger jumps.
  static constexpr double kMaxDelay_s = 2.0;
  static constexpr double kMaxWholeDelay_s = 10.0;
  /// A finger of which nothing has been heard for this long is lifted.
  static constexpr double kMaxSilence_s = 2.0;

  /// Begins a stroke or continues it. Precondition: times ascend within the part; one that begins has a point. Points
  /// that are not later than what is there are omitted. kUnavailable: there are kMaxCount, or kPersonMaxCount of the
  /// person.
  core::Result<void> add(const StrokePart& part);

  /// Draws a step: appends to out.splashes what moves the dents, and the drops; fills out.calms.
  void advance(const StrokeWater& water, shared::EventUniforms& out);

  [[nodiscard]] const std::vector<Stroke>& active() const { return active_; }
  /// Replaces them all. Returns false, with nothing changed, if there are more than can be, or one has no path.
  bool resume(std::vector<Stroke> active);
  void clear() { active_.clear(); }

 private:
  std::vector<Stroke> active_;
};

}  // namespace spindrift::sim
