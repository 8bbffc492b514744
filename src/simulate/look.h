#pragma once

#include "simulate/world.h"

namespace bole::simulate {

/// Light, ground, backdrop and camera settings of one world.
Look draw_look(const SimOptions& options, Random& random, bool treeless);

/// A tree's bark, dark or bright.
Bark draw_bark(Random& random, bool bright);

/// Reflectances: of leaves; of rock, dead wood and dry grass; of clothes and paint.
Colour draw_green(Random& random);
Colour draw_dull(Random& random);
Colour draw_vivid(Random& random);

}  // namespace bole::simulate
