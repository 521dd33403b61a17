// Our step of the particles beside the structure of the thesis, on the same particles.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>

#include <boost/json/array.hpp>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/context.h>

namespace spindrift::bench {

/// Largest differences between the two after one substep, each as a part of the largest value of ours; positions as a
/// part of the particle spacing.
struct ThesisDifference {
  double density = 0.0;
  double acceleration = 0.0;
  double position = 0.0;
};
inline constexpr ThesisDifference kThesisTolerance{.density = 1e-5, .acceleration = 1e-4, .position = 1e-5};

/// Both simulations of the particles of a scene, as they are after 1.25 s; the wave stands still.
class ThesisComparison {
 public:
  /// Leaves out boats, floaters, storm and foam. kInvalidInput for a scene whose number of particles is not fixed, or
  /// that has a bed, obstacles, tension, a patch that moves, or a solver of positions; kInternal when the device fails.
  static core::Result<std::unique_ptr<ThesisComparison>> create(gpu::Context& ctx, const core::Scene& scene,
                                                                std::uint32_t particle_count);
  ~ThesisComparison();

  [[nodiscard]] std::uint32_t particleCount() const;
  [[nodiscard]] double meanNeighbours() const;
  /// Puts both at their start.
  void restart();
  void stepOurs();
  void stepThesis();
  /// Of one substep from the start. Waits.
  [[nodiscard]] ThesisDifference difference();
  /// As both are now, each after at least one substep. Waits.
  [[nodiscard]] ThesisDifference differenceNow() const;

 private:
  struct State;
  explicit ThesisComparison(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Compares both at about 8,192, 16,384, 32,768 and 65,536 particles of the scene, then times them in turn, `seconds`
/// and at least five pairs each: CPU time of this process and wall time. Prints two rows per number of particles.
/// Errors: those above; kInternal if they differ by more than kThesisTolerance.
core::Result<boost::json::array> measureThesis(gpu::Context& ctx, const core::Scene& scene, double seconds,
                                               std::FILE* out);

}  // namespace spindrift::bench
