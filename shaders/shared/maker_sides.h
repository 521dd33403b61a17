// Sides of the water that may have wave-makers, as bits of the define MAKERS.
#ifndef SPINDRIFT_SHARED_MAKER_SIDES_H
#define SPINDRIFT_SHARED_MAKER_SIDES_H

#define MAKER_MINUS_X 1
#define MAKER_PLUS_X 2
#define MAKER_MINUS_Z 4
#define MAKER_PLUS_Z 8

#endif
