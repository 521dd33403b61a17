// Bit rate of each level of detail of a scene, compared with its budget and with levels that add to each other.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>

#include <boost/json.hpp>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/core/result.h>
#include <spindrift/sim/water_sim.h>

namespace spindrift::bench {

/// Encodes every level of a scene's frames as the server would. One instance per scene; frames in order.
class LevelMeter {
 public:
  explicit LevelMeter(double frame_rate_hz) : frame_rate_hz_(frame_rate_hz) {}

  /// Requests every level of every layer that the scene has.
  static sim::FrameRequest request(const core::Scene& scene);
  void add(const core::FrameView& frame);
  /// Prints a table, or one line if the scene has only one level. Absent numbers are 0 in the rows.
  boost::json::array print(std::FILE* out) const;

 private:
  struct LevelCost {
    std::uint64_t frame_count = 0;
    std::uint64_t last_frame = 0;  ///< number of the last frame that the level took
    double surface_bytes = 0.0, particle_bytes = 0.0, foam_bytes = 0.0;
    double encode_ms = 0.0;
    double particle_sum = 0.0;  ///< over all frames
    core::CellCounts surface;
  };

  void addParts(const core::FrameView& frame);

  double frame_rate_hz_;
  std::uint64_t frame_count_ = 0;
  core::ReducedCounts counts_;
  codec::FrameEncoder encoder_;
  std::array<LevelCost, core::kLevelCount> levels_;
  /// For levels that add to each other: bits of all particles up to a level, and their number.
  std::array<double, core::kLevelCount> part_bits_{};
  std::array<double, core::kLevelCount> part_counts_{};
};

}  // namespace spindrift::bench
