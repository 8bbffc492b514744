#include "simulate/look.h"

#include <cmath>

namespace bole::simulate {
namespace {

float draw(Random& random, Span span) { return random.uniform(span.low, span.high); }

/// A tint with the given mean reflectance.
Colour tinted(Random& random, Colour tint, float level) {
  const float spread = 0.15F;
  const Colour c{tint.r * random.uniform(1 - spread, 1 + spread),
                 tint.g * random.uniform(1 - spread, 1 + spread),
                 tint.b * random.uniform(1 - spread, 1 + spread)};
  return c * (level * 3 / (c.r + c.g + c.b));
}

void draw_ground(Random& random, Look& look) {
  static constexpr Colour kTints[] = {
      {1.15F, 0.95F, 0.75F}, {1.25F, 0.9F, 0.8F}, {1, 1, 0.9F}, {0.8F, 1.1F, 0.5F}};
  look.litter = tinted(random, kTints[random.bits() % 4], random.uniform(0.1F, 0.42F));
  look.soil = tinted(random, {1.1F, 1, 0.85F}, random.uniform(0.06F, 0.5F));
  look.moss = tinted(
      random, mix(Colour{0.8F, 1.15F, 0.4F}, Colour{1.15F, 1.05F, 0.6F}, random.uniform(0, 1)),
      random.uniform(0.06F, 0.35F));
  look.litter_scale = random.uniform(6, 25);
  look.litter_contrast = random.uniform(0.25F, 0.9F);
  look.patches = random.uniform(0, 0.6F);
  look.patch_scale = random.uniform(0.15F, 0.8F);
  look.grass = random.chance(0.4F) ? random.uniform(0, 0.8F) : 0;
}

void draw_light(Random& random, Look& look) {
  const float bearing = random.uniform(0, 6.2831853F);
  look.sun_x = std::cos(bearing);
  look.sun_y = std::sin(bearing);
  look.sun_slope = std::tan(random.uniform(0.3F, 1.2F));
  look.sun_strength = random.chance(0.25F) ? random.uniform(0, 0.4F) : random.uniform(0.8F, 3.5F);
  look.canopy = random.uniform(0.1F, 0.8F);
  look.canopy_scale = 0.25F * std::pow(10.0F, random.uniform(0, 1));
  const float sky = random.uniform(0.7F, 2.2F);
  look.sky_high =
      tinted(random, mix(Colour{0.7F, 0.9F, 1.4F}, Colour{1, 1, 1}, random.uniform(0, 1)),
             sky * random.uniform(0.6F, 1));
  look.sky_low = tinted(random, {0.95F, 1, 1.05F}, sky);
  look.haze = mix(look.sky_low, Colour{0.5F, 0.55F, 0.5F}, 0.6F) * random.uniform(0.3F, 0.7F);
}

void draw_backdrop(Random& random, Look& look, bool treeless) {
  look.foliage = draw_green(random) * random.uniform(0.3F, 0.8F);
  const bool open = random.chance(treeless ? 0.7F : 0.2F);
  look.backdrop_top = open ? random.uniform(0.02F, 0.25F) : random.uniform(0.4F, 2.0F);
  look.backdrop_cover = random.uniform(0.35F, 0.95F);
  look.stems = treeless || open ? 0 : random.uniform(0.1F, 0.8F);
  look.stem_light = random.uniform(0.1F, 0.7F);
  look.interior = random.uniform(0.15F, 1.1F);
  look.veil = random.uniform(-0.5F, 0.5F);
}

}  // namespace

Look draw_look(const SimOptions& o, Random& random, bool treeless) {
  Look look;
  draw_ground(random, look);
  draw_light(random, look);
  draw_backdrop(random, look, treeless);
  look.fog = draw(random, o.fog) * random.uniform(0, 1);
  look.glare = draw(random, o.glare) * random.uniform(0, 1);
  look.stops = draw(random, o.exposure_stops);
  look.contrast = draw(random, o.contrast);
  look.vignetting = random.uniform(0.05F, 0.45F);
  look.blur_px = draw(random, o.blur_px);
  look.noise = draw(random, o.noise);
  look.jpeg_quality = static_cast<int>(draw(random, o.jpeg_quality));
  return look;
}

Bark draw_bark(Random& random, bool bright) {
  Bark bark;
  const Colour tint =
      bright ? mix(Colour{1.05F, 1, 0.92F}, Colour{0.95F, 1.05F, 0.8F}, random.uniform(0, 1))
             : mix(Colour{1.2F, 1, 0.85F}, Colour{1, 1, 0.95F}, random.uniform(0, 1));
  const float level = bright ? random.uniform(0.35F, 0.75F) : random.uniform(0.05F, 0.22F);
  bark.light = tinted(random, tint, level);
  bark.dark = bark.light * random.uniform(0.15F, 0.65F);
  bark.scale = random.uniform(10, 45);
  bark.stretch = random.uniform(2, 9);
  bark.contrast = random.uniform(0.3F, 1.2F);
  bark.moss = random.chance(0.35F) ? random.uniform(0.1F, 0.8F) : 0;
  bark.birch = bright && random.chance(0.5F);
  return bark;
}

Colour draw_green(Random& random) {
  const Colour tint = mix(Colour{0.7F, 1.15F, 0.45F}, Colour{1.25F, 1, 0.5F}, random.uniform(0, 1));
  return tinted(random, tint, random.uniform(0.05F, 0.35F));
}

Colour draw_dull(Random& random) {
  const Colour tint = mix(Colour{1.1F, 1, 0.85F}, Colour{0.95F, 1, 1}, random.uniform(0, 1));
  return tinted(random, tint, random.uniform(0.05F, 0.55F));
}

Colour draw_vivid(Random& random) {
  const Colour tint{random.uniform(0.2F, 1.6F), random.uniform(0.2F, 1.6F),
                    random.uniform(0.2F, 1.6F)};
  return tinted(random, tint, random.uniform(0.04F, 0.6F));
}

}  // namespace bole::simulate
