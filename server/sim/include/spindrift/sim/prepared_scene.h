// A change of a running room's scene, worked out apart from its simulation: on any thread, without a device.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/sim/derive.h>
#include <spindrift/sim/state_copy.h>

namespace spindrift::sim {

/// What prepareScene() needs to know of a simulation; WaterSim::sceneBasis() makes it. Plain values, about 36 bytes per
/// particle and 8 per wave cell where particles are to be laid out anew.
struct SceneBasis {
  core::Scene scene;
  Derived derived;
  StateCopy state;             ///< position, velocity and elevation; empty when the change keeps the particles
  std::uint64_t revision = 0;  ///< WaterSim::adopt() refuses what was prepared for another one
};

/// Positions and velocities, 4 floats per particle (x, y, z, id; x, y, z, foam), as the device holds them.
struct RelaidParticles {
  std::vector<float> position, velocity;
};

/// For WaterSim::adopt(). Plain values.
struct PreparedScene {
  core::Scene scene;
  Derived derived;
  std::optional<RelaidParticles> particles;  ///< set: buffers of another size
  double flow_ratio = 1.0;                   ///< what the wave's flow is multiplied by
  std::uint64_t revision = 0;
};

/// Checks and works out the change from `basis` to `scene`: everything of WaterSim::setScene() that needs no device. A
/// pure function. Linear in the number of particles: 0.1 s for 200,000. Errors as setScene()'s.
core::Result<PreparedScene> prepareScene(const core::Scene& scene, const SceneBasis& basis);

}  // namespace spindrift::sim
