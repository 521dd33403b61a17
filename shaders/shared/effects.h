// Effects beside walls.
#ifndef SPINDRIFT_SHARED_EFFECTS_H
#define SPINDRIFT_SHARED_EFFECTS_H

// Where waves disperse, an effect moves less water through so many last faces before a wall.
#define EFFECT_TAPER_CELLS 8

#endif
