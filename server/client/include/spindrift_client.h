/* The water of a Spindrift room at points, for programs in C and in languages that call C. The library is
 * libspindrift_client.so, of the CMake target spindrift_client; docs/c.md has examples.
 *
 * A thread of the library keeps the connection: it connects again by itself, as the same person, and follows a server
 * that is about to end to the one that it names. Functions may be called from any thread. Those that wait say for how
 * long. Lengths are in metres, x and z level, y up, elevations over the water at rest; times in seconds. */
#ifndef SPINDRIFT_CLIENT_H
#define SPINDRIFT_CLIENT_H

#include <stddef.h>
#include <stdint.h>

#define SPINDRIFT_API __attribute__((visibility("default")))

#ifdef __cplusplus
extern "C" {
#endif

/** What a call came to. spindrift_error() has a line of text for all but SPINDRIFT_OK. */
typedef enum spindrift_status {
  SPINDRIFT_OK = 0,
  SPINDRIFT_BAD_ARGUMENT = 1,
  /** At present; the library connects again by itself. A command may or may not have been carried out if the text says
   * so. */
  SPINDRIFT_NOT_CONNECTED = 2,
  /** The server does not want this client: another major version, an unknown token, no such room. It stays so. */
  SPINDRIFT_REFUSED = 3,
  /** The server did not carry out a command. The text names the field, its value and the bound. */
  SPINDRIFT_REJECTED = 4,
  /** No answer in time. A command may still be carried out. */
  SPINDRIFT_NO_ANSWER = 5,
  SPINDRIFT_NO_MEMORY = 6
} spindrift_status;

/** The text of the last call of this thread that failed; valid until its next call. Never NULL. */
SPINDRIFT_API const char* spindrift_error(void);

/** A connection to a room. */
typedef struct spindrift_room spindrift_room;

/** Texts may be NULL, which is as empty. They are copied. */
typedef struct spindrift_options {
  const char* url;        /**< "http://HOST:PORT", or ws, or https, or wss */
  const char* room;       /**< the server's first one if empty */
  const char* name;       /**< shown to the others in the room */
  const char* token;      /**< gives a role; a guest's without one */
  const char* ca_file;    /**< PEM, for https with an authority of one's own */
  double answer_within_s; /**< of commands and queries; 0: 10 s */
} spindrift_options;

/** Connects, and waits for at most `patience_s` until the server has let the client in. Writes NULL to `room` unless it
 * returns SPINDRIFT_OK. */
SPINDRIFT_API spindrift_status spindrift_connect(const spindrift_options* options, double patience_s,
                                                 spindrift_room** room);
/** Leaves the room. No other call may use it meanwhile or afterwards. NULL is allowed. */
SPINDRIFT_API void spindrift_disconnect(spindrift_room* room);

/** SPINDRIFT_OK: connected at present. Otherwise SPINDRIFT_NOT_CONNECTED or SPINDRIFT_REFUSED, and why. Does not wait.
 */
SPINDRIFT_API spindrift_status spindrift_state(spindrift_room* room);
/** How often it has been connected: greater than 1 after a loss. */
SPINDRIFT_API uint64_t spindrift_connection_count(spindrift_room* room);

/** When the water was so. */
typedef struct spindrift_moment {
  uint64_t tick;
  double time_s;     /**< simulation time since the scene began or was reset */
  uint64_t state_id; /**< those with the same number show the same water */
  uint64_t number;   /**< of the answer, from 1; gaps are answers that came while nobody asked for them */
} spindrift_moment;

/** The water at a point. Of elevation, speeds and slopes only wet cells count; on dry ground alone elevation_m is that
 * of the ground where water can come, and otherwise 0. */
typedef struct spindrift_sample {
  float elevation_m;
  float vertical_speed_mps; /**< rate at which the elevation at this position changes */
  float velocity_x_mps;     /**< of the water, as a mean over its depth */
  float velocity_z_mps;
  float slope_x; /**< of the elevation along x and z */
  float slope_z;
  float depth_m;   /**< from the bed to the surface */
  float wet_ratio; /**< share of wet cells around the point */
  float foam_ratio;
  int outside; /**< 1: there is no water, and the rest is 0 */
} spindrift_sample;

/** Of one client, in all that it asks at a time. */
#define SPINDRIFT_MAX_POINTS 1024

/** Asks for the water at `count` points now, and waits for the answer: of one tick, in the order of the points. */
SPINDRIFT_API spindrift_status spindrift_query(spindrift_room* room, const float* x_m, const float* z_m, size_t count,
                                               spindrift_moment* moment, spindrift_sample* samples);

/** From now on the server sends the water at these points whenever `interval_ticks` (1 to 3600) have passed, and the
 * library keeps the newest answer. Replaces the points of before; count 0 ends it. It continues by itself after a lost
 * connection and in another scene. Waits for the server's agreement. */
SPINDRIFT_API spindrift_status spindrift_follow(spindrift_room* room, const float* x_m, const float* z_m, size_t count,
                                                uint32_t interval_ticks);
/** Gives the newest answer at the followed points whose number is above `after`, and waits for one for at most
 * `patience_s`: with 0 for both it never waits once there is one. `count`: as many points as are followed. */
SPINDRIFT_API spindrift_status spindrift_newest(spindrift_room* room, uint64_t after, double patience_s,
                                                spindrift_moment* moment, spindrift_sample* samples, size_t count);

/** Stops the room's clock: from then on it advances only by spindrift_step() of this client, and of others who hold the
 * clock. For operators, and for players who are alone. `speed`: simulated seconds per second, 0: as fast as the machine
 * can. A client that sends no step for `timeout_s` while the room waits for it loses the clock, and so does one that
 * loses its connection. Since version 1.11 of the wire. */
SPINDRIFT_API spindrift_status spindrift_take_clock(spindrift_room* room, double speed, double timeout_s);
/** Advances the room by 1 to 600 ticks, and waits as long as they take. Then `*tick` is the last of them, and
 * `*state_hash` that of the state after it; either may be NULL. */
SPINDRIFT_API spindrift_status spindrift_step(spindrift_room* room, uint32_t tick_count, uint64_t* tick,
                                              uint64_t* state_hash);
SPINDRIFT_API spindrift_status spindrift_release_clock(spindrift_room* room);

#ifdef __cplusplus
}
#endif
#endif
