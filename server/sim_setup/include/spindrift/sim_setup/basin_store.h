// The tables of a wave's basin, kept for the next water of the same scene. Knows no device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/dispersion.h>

namespace spindrift::sim {

/// The scene values from which the tables of a basin are computed.
struct BasinInputs {
  BasinInputs(const core::Scene& scene, const WaveLayout& layout);
  bool operator==(const BasinInputs&) const = default;

  core::WaveScene wave;
  double speed_mps;
  std::vector<core::Obstacle> obstacles;
  std::vector<core::Beach> beaches;
  std::optional<core::Bed> bed;
};

struct BasinTables {
  Basin basin;
  Dispersion dispersion;  ///< empty where waves do not disperse
  Terrain terrain;        ///< empty if not asked for

  [[nodiscard]] std::size_t sizeBytes() const;
};

BasinTables layOutTables(const core::Scene& scene, const WaveLayout& layout, bool with_terrain);

/// One thread at a time. Keeps the tables that were asked for last, at most kMaxBytes of them.
class BasinStore {
 public:
  /// Six harbors. Tables of a sea of 1,024 x 1,024 cells are larger, and not kept.
  static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

  explicit BasinStore(std::size_t max_bytes = kMaxBytes) : max_bytes_(max_bytes) {}

  /// Returns layOutTables() of the scene, computed unless they are kept.
  std::shared_ptr<const BasinTables> of(const core::Scene& scene, const WaveLayout& layout, bool with_terrain);

  /// Returns how often tables were computed.
  [[nodiscard]] std::uint64_t madeCount() const { return made_count_; }

 private:
  struct Entry {
    BasinInputs inputs;
    bool with_terrain;
    std::shared_ptr<const BasinTables> tables;
  };

  std::size_t max_bytes_;
  std::list<Entry> entries_;  ///< last asked for first
  std::uint64_t made_count_ = 0;
};

}  // namespace spindrift::sim
