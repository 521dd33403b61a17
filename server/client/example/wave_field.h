// A provider of waves for a robot simulator, with what such simulators usually ask for: elevation and velocity at any
// point and time.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <spindrift_client.h>

/// The interface on the simulator's side. Lengths in metres, y up from the water at rest, times in seconds of the room.
class WaveField {
 public:
  struct Velocity {
    double x_mps, y_mps, z_mps;
  };
  virtual ~WaveField() = default;
  virtual double elevation_m(double x_m, double z_m, double time_s) const = 0;
  /// Returns that of the water at the surface.
  virtual Velocity velocity(double x_m, double z_m, double time_s) const = 0;
};

/// The water of a room in a square patch that the server sends once per tick. Between its points it is interpolated
/// bilinearly; between ticks the elevation continues with its vertical speed. Used by one thread at a time.
class RoomWaves final : public WaveField {
 public:
  /// A patch of kSide x kSide points, `spacing_m` apart, around (x_m, z_m). Throws std::runtime_error.
  RoomWaves(spindrift_room* room, double x_m, double z_m, double spacing_m)
      : room_(room),
        x0_m_(x_m - 0.5 * (kSide - 1) * spacing_m),
        z0_m_(z_m - 0.5 * (kSide - 1) * spacing_m),
        spacing_m_(spacing_m),
        samples_(kSide * kSide) {
    std::vector<float> xs_m, zs_m;
    for (int k = 0; k < kSide; ++k) {
      for (int i = 0; i < kSide; ++i) {
        xs_m.push_back(static_cast<float>(x0_m_ + i * spacing_m));
        zs_m.push_back(static_cast<float>(z0_m_ + k * spacing_m));
      }
    }
    if (spindrift_follow(room, xs_m.data(), zs_m.data(), xs_m.size(), 1) != SPINDRIFT_OK)
      throw std::runtime_error(spindrift_error());
  }

  /// Waits for the water of a later tick. Returns false if none came within `patience_s`: the water stands still, or
  /// the connection is lost, which spindrift_state() tells; the library connects again by itself.
  bool update(double patience_s) {
    return spindrift_newest(room_, moment_.number, patience_s, &moment_, samples_.data(), samples_.size()) ==
           SPINDRIFT_OK;
  }
  const spindrift_moment& moment() const { return moment_; }

  double elevation_m(double x_m, double z_m, double time_s) const override {
    return at(x_m, z_m, &spindrift_sample::elevation_m) +
           at(x_m, z_m, &spindrift_sample::vertical_speed_mps) * (time_s - moment_.time_s);
  }
  Velocity velocity(double x_m, double z_m, double /*time_s*/) const override {
    return {at(x_m, z_m, &spindrift_sample::velocity_x_mps), at(x_m, z_m, &spindrift_sample::vertical_speed_mps),
            at(x_m, z_m, &spindrift_sample::velocity_z_mps)};
  }

 private:
  static constexpr int kSide = 25;  // 625 of the 1024 points that a client may ask for

  /// Outside of the patch: as at its edge.
  double at(double x_m, double z_m, float spindrift_sample::*value) const {
    const double column = std::clamp((x_m - x0_m_) / spacing_m_, 0.0, kSide - 1.0);
    const double row = std::clamp((z_m - z0_m_) / spacing_m_, 0.0, kSide - 1.0);
    const int i = std::min(static_cast<int>(column), kSide - 2), k = std::min(static_cast<int>(row), kSide - 2);
    const double u = column - i, v = row - k;
    const auto sample = [&](int di, int dk) {
      return static_cast<double>(samples_[static_cast<std::size_t>((k + dk) * kSide + i + di)].*value);
    };
    return (1 - v) * ((1 - u) * sample(0, 0) + u * sample(1, 0)) + v * ((1 - u) * sample(0, 1) + u * sample(1, 1));
  }

  spindrift_room* room_;
  double x0_m_, z0_m_, spacing_m_;
  std::vector<spindrift_sample> samples_;
  spindrift_moment moment_ = {};
};
