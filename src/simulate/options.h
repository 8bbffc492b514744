#pragma once

#include <string>
#include <string_view>

namespace bole::simulate {

/// Drawn uniformly between the two, anew for every world.
struct Span {
  float low = 0;
  float high = 0;
};

/// What worlds and cameras may be like. Presets:
///   drive    one wood on nearly even ground, a robot that rocks a little: what figures are read on
///   varied   a new world every frame, all that a detector must be ready for: what it is trained on
///   treeless varied worlds without a trunk: whatever is found there is wrong
struct SimOptions {
  int frames_per_world = 0;          ///< 0: one world for the whole drive
  Span trees_per_ha{150, 600};       ///< 0: treeless, no distant stems either
  Span diameter{0.12F, 0.85F};       ///< metres, of trunks
  Span bright_share{0.05F, 0.4F};    ///< of trunks
  Span crooked_share{0, 0.25F};      ///< of trunks: they lean and bend
  Span slope{0, 0.02F};              ///< rise over run of the ground as a whole
  Span undulation{0, 0.04F};         ///< metres, standard deviation of the ground about its slope
  Span attitude_deg{0.1F, 0.4F};     ///< standard deviation of the robot's unknown roll and pitch
  Span foot_cover{0.2F, 0.7F};       ///< share of trunks with grass or litter before their feet
  Span bushes_per_ha{50, 400};       ///< also branches that hang before trunks
  Span clutter_per_ha{10, 80};       ///< rocks, stumps, fallen logs, posts, people
  Span walls{0, 1};                  ///< number of hedges, walls and cliffs
  Span exposure_stops{-0.4F, 0.4F};  ///< against automatic exposure
  Span contrast{0.9F, 1.2F};         ///< exponent on the grey levels after exposure
  Span fog{0, 0.008F};               ///< extinction a metre
  Span glare{0, 0.1F};               ///< veil of stray light around the sun, share of white
  Span blur_px{0.3F, 0.7F};          ///< standard deviation
  Span noise{1, 3};                  ///< standard deviation in grey levels at mid grey
  Span jpeg_quality{96, 100};        ///< of an encoding before the frame is written; 100: none
};

/// The preset of that name; throws ConfigError for any other, naming those that there are.
SimOptions preset(std::string_view name);

}  // namespace bole::simulate
