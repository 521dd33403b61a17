// Sides of the water as bits, which sets of sides add up. Plain numbers, so that the preprocessor understands them.
#ifndef SPINDRIFT_SHARED_SIDE_BITS_H
#define SPINDRIFT_SHARED_SIDE_BITS_H

#define MINUS_X_BIT 1
#define PLUS_X_BIT 2
#define MINUS_Z_BIT 4
#define PLUS_Z_BIT 8

#endif
