// What gauges have read at the last ticks: those of a scene together, one that was placed later for itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace spindrift::sim {

/// Values of one gauge at the end of one tick; shaders/diagnostics/gauges.comp. On dry ground without flow, at the
/// ground's elevation with BULK_NONLINEAR and at 0 with BULK_LINEAR.
struct GaugeReading {
  float elevation_m = 0.0F;     ///< over the rest level
  float velocity_x_mps = 0.0F;  ///< of the flow over the depth
  float velocity_z_mps = 0.0F;
};

/// A position that is measured beside the gauges of the scene.
struct GaugePlace {
  std::uint32_t gauge_id = 0;  ///< chosen by the caller, one per place
  double x_m = 0.0;
  double z_m = 0.0;
};

/// The reading of a GaugePlace.
struct PlacedReading {
  std::uint32_t gauge_id = 0;
  GaugeReading reading;
};

/// A bounded ring. The room's thread writes it; any thread may read it.
class GaugeHistory {
 public:
  /// Ticks that are kept: 68 s at 60 Hz.
  static constexpr std::size_t kTickMaxCount = 4096;

  /// The newest reading of a gauge, with the extremes since it was placed or the last clear().
  struct Now {
    GaugeReading reading;
    float highest_m = 0.0F;
    float lowest_m = 0.0F;
  };
  struct Series {
    std::vector<double> time_s;  ///< simulation time since the start of the scene; ascending
    std::vector<GaugeReading> readings;
  };

  explicit GaugeHistory(std::size_t gauge_count);

  // The room's thread.
  /// Adds one reading per gauge. Overwrites the oldest tick when the ring is full.
  void add(double time_s, std::span<const GaugeReading> readings);
  void clear();

  // Any thread.
  /// Returns one value per gauge; zeros before the first reading.
  [[nodiscard]] std::vector<Now> now() const;
  /// Returns the time of the newest readings; 0 before the first.
  [[nodiscard]] double newestTime_s() const;
  /// Returns the kept ticks of a gauge, oldest first. Precondition: gauge < gauge_count.
  [[nodiscard]] Series series(std::size_t gauge) const;

 private:
  const std::size_t gauge_count_;
  mutable std::mutex mutex_;
  std::vector<double> times_s_;         ///< ring of ticks
  std::vector<GaugeReading> readings_;  ///< the same ticks, gauge fastest
  std::vector<Now> now_;
  std::size_t next_ = 0;  ///< tick of the ring that is written next
  double newest_time_s_ = 0.0;
  bool is_empty_ = true;
};

}  // namespace spindrift::sim
