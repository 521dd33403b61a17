// A box of a robot simulator that rides the waves of a room: floating_box URL [X_M Z_M]. It ends when the water stands
// still for three seconds (the room was paused), and says where the box was in the waves.
#include <cstdio>
#include <cstdlib>

#include "wave_field.h"

namespace {

/// A flat box that moves up and down. The water lifts it by Archimedes' law and brakes it.
struct Box {
  static constexpr double kSide_m = 0.6, kHeight_m = 0.2, kDensity_ratio = 0.35;
  static constexpr double kGravity_mps2 = 9.81;
  static constexpr double kDamping_per_s = 8.0;
  static constexpr int kColumns = 3;  // of the bottom, along each side

  double x_m, z_m;
  double y_m;  // of the bottom, over the water at rest
  double speed_mps = 0.0;

  void step(const WaveField& waves, double time_s, double dt_s) {
    double lift_ratio = 0.0, water_speed_mps = 0.0;
    for (int k = 0; k < kColumns; ++k) {
      for (int i = 0; i < kColumns; ++i) {
        const double px_m = x_m + ((i + 0.5) / kColumns - 0.5) * kSide_m,
                     pz_m = z_m + ((k + 0.5) / kColumns - 0.5) * kSide_m;
        const double under_m = std::clamp(waves.elevation_m(px_m, pz_m, time_s) - y_m, 0.0, kHeight_m);
        lift_ratio += under_m / kHeight_m / (kColumns * kColumns);
        water_speed_mps += waves.velocity(px_m, pz_m, time_s).y_mps / (kColumns * kColumns);
      }
    }
    const double brake_mps2 = lift_ratio > 0.0 ? kDamping_per_s * (water_speed_mps - speed_mps) : 0.0;
    speed_mps += dt_s * (kGravity_mps2 * (lift_ratio / kDensity_ratio - 1.0) + brake_mps2);
    y_m += dt_s * speed_mps;
  }
  /// Of the bottom under the surface, at rest.
  static constexpr double kDraught_m = kDensity_ratio * kHeight_m;
};

int run(spindrift_room* room, double x_m, double z_m) {
  RoomWaves waves(room, x_m, z_m, 0.1);
  if (!waves.update(10.0)) throw std::runtime_error(spindrift_error());
  Box box{.x_m = x_m, .z_m = z_m, .y_m = waves.elevation_m(x_m, z_m, waves.moment().time_s)};
  std::printf("the box starts at tick %llu, %.3f m too high\n", static_cast<unsigned long long>(waves.moment().tick),
              Box::kDraught_m);
  std::fflush(stdout);
  constexpr double kSettles_s = 3.0, kStep_s = 1.0 / 240.0;
  double time_s = waves.moment().time_s, count = 0.0, water_m2 = 0.0, off_m2 = 0.0;
  const double begun_s = time_s;
  while (waves.update(3.0)) {
    const double now_s = waves.moment().time_s;
    if (now_s < time_s) time_s = now_s;  // the room was reset
    for (; time_s < now_s; time_s += kStep_s) box.step(waves, time_s, kStep_s);
    if (now_s < begun_s + kSettles_s) continue;
    const double water_m = waves.elevation_m(x_m, z_m, now_s), off_m = box.y_m + Box::kDraught_m - water_m;
    count += 1.0;
    water_m2 += water_m * water_m;
    off_m2 += off_m * off_m;
  }
  if (spindrift_state(room) != SPINDRIFT_OK) throw std::runtime_error(spindrift_error());
  const double now_s = waves.moment().time_s;
  std::printf("waves of %.4f m, the box was off by %.4f m (root mean squares of %.0f ticks)\n",
              std::sqrt(water_m2 / count), std::sqrt(off_m2 / count), count);
  const WaveField::Velocity velocity = waves.velocity(x_m, z_m, now_s);
  std::printf("tick %llu time_s %.9g elevation_m %.9g velocity_mps %.9g %.9g %.9g\n",
              static_cast<unsigned long long>(waves.moment().tick), now_s, waves.elevation_m(x_m, z_m, now_s),
              velocity.x_mps, velocity.y_mps, velocity.z_mps);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  spindrift_options options = {};
  options.url = argc > 1 ? argv[1] : "http://localhost:8080";
  options.name = "box";
  spindrift_room* room = nullptr;
  int code = 1;
  try {
    if (spindrift_connect(&options, 10.0, &room) != SPINDRIFT_OK) throw std::runtime_error(spindrift_error());
    code = run(room, argc > 2 ? std::atof(argv[2]) : 0.0, argc > 3 ? std::atof(argv[3]) : 0.0);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "floating_box: %s\n", error.what());
  }
  spindrift_disconnect(room);
  return code;
}
