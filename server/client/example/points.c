/* Prints the water at two points once per second: points http://localhost:8080 */
#include <spindrift_client.h>
#include <stdio.h>

int main(int argc, char** argv) {
  const float x_m[] = {0.0f, 2.0f};
  const float z_m[] = {0.0f, -1.0f};
  spindrift_options options = {0};
  spindrift_room* room;
  spindrift_moment moment;
  spindrift_sample samples[2];
  int count;

  options.url = argc > 1 ? argv[1] : "http://localhost:8080";
  if (spindrift_connect(&options, 10.0, &room) != SPINDRIFT_OK) {
    fprintf(stderr, "%s\n", spindrift_error());
    return 1;
  }
  if (spindrift_follow(room, x_m, z_m, 2, 60) != SPINDRIFT_OK) fprintf(stderr, "%s\n", spindrift_error());
  moment.number = 0;
  for (count = 0; count < 3; ++count) {
    if (spindrift_newest(room, moment.number, 10.0, &moment, samples, 2) != SPINDRIFT_OK) {
      fprintf(stderr, "%s\n", spindrift_error());
      break;
    }
    printf("%.2f s: %.4f m and %.4f m, moving at %.3f and %.3f m/s\n", moment.time_s, samples[0].elevation_m,
           samples[1].elevation_m, samples[0].velocity_x_mps, samples[0].velocity_z_mps);
  }
  spindrift_disconnect(room);
  return count == 3 ? 0 : 1;
}
