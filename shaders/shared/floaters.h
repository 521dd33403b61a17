// Floaters: FLOATER_TEXELS texels each in FLOATERS, one slot per object. A floater's own axes: x along its length, y up as
// it stands, z across; the origin is its centre of mass.
//   0  x, y, z of the centre of mass [m], age [s] (negative: the slot is free)
//   1  rotation from its own axes to those of the water: unit quaternion x, y, z, w
//   2  velocity [m/s], id
//   3  angular velocity [rad/s], dent: share of its displacement at rest with which it presses on the water [0..1]
//   4  half extents along its axes [m], shape (FLOATER_BOX ...) + 8 * kind (v1::FloaterKind)
//   5  density over the water's, centre of mass above the middle [m], size [m], 0
//   6  where it is held: x, lift over the water, z [m], how much longer [s] (0: nobody holds it)
//   7  acceleration by gravity, water and hold [m/s^2], turn by who holds it [rad/s]
//   8  angular acceleration likewise [rad/s^2], 0
#ifndef SPINDRIFT_SHARED_FLOATERS_H
#define SPINDRIFT_SHARED_FLOATERS_H

#define FLOATER_TEXELS 9
#define FLOATER_BOX 0
#define FLOATER_SPHERE 1
#define FLOATER_CYLINDER_X 2
#define FLOATER_CYLINDER_Y 3
// How long a hold lasts after the last command. [s]
#define FLOATER_HOLD_S 0.5f
// Limits of velocity and spin.
#define FLOATER_MAX_MPS 25.0f
#define FLOATER_MAX_RADPS 25.0f
// Invocations of a group of the passes with one per floater.
#define FLOATER_GROUP 32
// Columns of the volume of a floater, and the points at which it touches; one of each for a ball.
#define FLOATER_COLUMNS 16
#define FLOATER_POINTS 16
// FLOATER_NEAR, FLOATER_NEAR_WORDS per slot: the number of neighbours that a floater can touch in a tick, plus FLOATER_GROUNDED
// if it can touch anything else; then their slots.
#define FLOATER_NEAR_WORDS 32
#define FLOATER_GROUNDED 256u
// FLOATER_PUSH, 8 words per slot, zero between steps: change of velocity, of spin, number of contacts, number of particles that hit.
// BOAT_PUSH, 2 words per slot: change of velocity along x and z. In units of 2^-20 m/s and rad/s, because sums of integers do not depend
// on their order.
#define PUSH_UNITS 1048576.0f
// Squares of the water that list which floaters are there, per axis; one bit per slot in each.
#define FLOATER_TILES_PER_AXIS 16

#endif
