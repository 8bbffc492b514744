#include "simulate/surface.h"

#include <algorithm>
#include <cmath>

namespace bole::simulate {
namespace {

constexpr float kSkyLight = 0.5F;  // of an open sky on level ground, beside the sun's strength

Colour bark(const Bark& b, float x, float y, float along, float footprint, std::uint32_t seed) {
  const float fine = b.scale, coarse = b.scale * 0.3F;
  float ridge = 0;
  ridge +=
      0.6F * resolved(fine, footprint) * noise(x * fine, y * fine, along * fine / b.stretch, seed);
  ridge += 0.4F * resolved(coarse, footprint) *
           noise(x * coarse, y * coarse, along * coarse / b.stretch, seed + 1);
  const float slow = noise(x * 2, y * 2, along * 0.6F, seed + 2);
  return mix(b.dark, b.light,
             std::clamp(0.5F + b.contrast * 0.9F * ridge + 0.15F * slow, 0.0F, 1.0F)) *
         (1 + 0.2F * b.contrast * slow);
}

}  // namespace

Surfaces::Place Surfaces::place(float way, const Ray& ray) const {
  return {x_ + way * ray.dx, y_ + way * ray.dy, z_ + way * ray.tangent, way * ray.pixel};
}

Colour Surfaces::lit(Colour reflectance, const Hit& hit, const Place& at, int self) const {
  const float length = std::sqrt(1 + look_.sun_slope * look_.sun_slope);
  const float facing =
      (hit.nx * look_.sun_x + hit.ny * look_.sun_y + hit.nz * look_.sun_slope) / length;
  const float sky = kSkyLight * (0.7F + 0.3F * hit.nz);
  const float sun = facing <= 0 || look_.sun_strength <= 0
                        ? 0
                        : look_.sun_strength * facing * sunlight_.at(at.x, at.y, at.z, self);
  return reflectance * (sky + sun);
}

Colour Surfaces::through_air(Colour colour, float way, const Ray& ray) const {
  const float far = way * std::sqrt(1 + ray.tangent * ray.tangent);
  return mix(look_.haze, colour, std::exp(-look_.fog * far));
}

Colour Surfaces::column(const Column& c, int index, const Hit& hit, const Ray& ray) const {
  const Place at = place(hit.way, ray);
  const float r = c.radius_at(std::clamp(hit.v, 0.0F, c.height));
  const Bark& b = c.bark;
  Colour skin = bark(b, hit.nx * r, hit.ny * r, hit.v, at.footprint, c.seed);
  if (hit.nz > 0) skin = b.light * 1.3F;
  if (b.birch) {
    const float bars = noise((hit.nx + hit.ny) * 2, hit.v * 9, c.seed + 5) +
                       0.5F * noise(hit.nx * 5, hit.ny * 5, hit.v * 25, c.seed + 6);
    skin = mix(skin, Colour{0.05F, 0.045F, 0.04F},
               smooth_step(0.5F, 0.7F, bars) * resolved(5, at.footprint));
  }
  if (b.moss > 0) {
    const float grown =
        noise(hit.nx * 3, hit.ny * 3, hit.v * 2.5F, c.seed + 8) +
        0.5F * fractal(hit.nx * r + at.z, hit.ny * r + at.z, 15, 2, 0.5F, at.footprint, c.seed + 9);
    const float high = b.moss * 2 - 0.8F - 0.25F * hit.v;
    skin = mix(skin, look_.moss * 0.8F, smooth_step(-0.15F, 0.15F, grown * 0.7F + high));
  }
  // Little light reaches the foot: ground and undergrowth keep it off.
  const float open = 0.6F + 0.4F * smooth_step(-0.1F, 0.5F, hit.v);
  return through_air(lit(skin, hit, at, index) * open, hit.way, ray);
}

Colour Surfaces::boulder(const Boulder& b, const Hit& hit, const Ray& ray) const {
  const Place at = place(hit.way, ray);
  const float grain =
      fractal(at.x + at.z * 0.7F, at.y - at.z * 0.6F, 3, 4, 0.6F, at.footprint, b.seed);
  const float moss = smooth_step(0.3F, 0.6F, hit.nz + 0.6F * grain) * b.roughness;
  const Colour skin = mix(b.colour * (1 + 0.7F * b.roughness * grain), look_.moss, 0.6F * moss);
  return through_air(lit(skin, hit, at, -1) * (0.75F + 0.25F * hit.nz), hit.way, ray);
}

Colour Surfaces::log(const Log& l, const Hit& hit, const Ray& ray) const {
  const Place at = place(hit.way, ray);
  const Colour skin =
      bark(l.bark, (hit.nx + hit.ny) * l.radius, hit.nz * l.radius, hit.u, at.footprint, l.seed);
  return through_air(lit(skin, hit, at, -1), hit.way, ray);
}

Colour Surfaces::wall(const Wall& w, const Hit& hit, const Ray& ray) const {
  const Place at = place(hit.way, ray);
  Colour skin = w.colour;
  if (w.kind == Wall::Kind::masonry) {
    const float course = hit.v * 6, joint = std::abs(course - std::round(course));
    skin = skin * (1 + 0.35F * noise(hit.u * 3, std::floor(course + 0.5F), w.seed)) *
           mix(1.0F, 0.6F + 0.4F * smooth_step(0.03F, 0.1F, joint), resolved(6, at.footprint));
  } else if (w.kind == Wall::Kind::hedge) {
    skin = skin * (1 + 0.9F * fractal(hit.u, hit.v, 6, 4, 0.8F, at.footprint, w.seed));
  } else {
    const float cracks = fractal(hit.u * 0.8F, hit.v * 1.7F, 0.7F, 5, 0.65F, at.footprint, w.seed);
    skin = skin * (0.75F + 0.9F * cracks);
  }
  const float grain = 1 + 0.2F * fractal(hit.u, hit.v, 20, 2, 0.6F, at.footprint, w.seed + 9);
  return through_air(lit(skin * std::max(0.1F, grain), hit, at, -1), hit.way, ray);
}

float Surfaces::opacity(const Leaves& l, const Hit& hit, const Ray& ray) {
  const float footprint = hit.way * ray.pixel;
  const float across = hit.u * l.half_width, up = hit.v * l.height;
  if (l.blades) {
    const float edge = 1 - hit.u * hit.u;
    const float tip =
        edge * (0.65F + 0.35F * noise(across / l.leaf, l.seed) * resolved(1 / l.leaf, footprint));
    const float gaps = resolved(1 / l.leaf, footprint) *
                       noise((across + 0.3F * up) / l.leaf, up / (l.leaf * 8), l.seed + 3);
    const float soft = 0.08F + footprint / l.height;
    const float closed = smooth_step(-1, 1 - 2 * l.density + 0.3F, gaps + 1 - 1.2F * hit.v);
    return smooth_step(-soft, soft, tip - hit.v) * closed;
  }
  const float inside = 1 - hit.u * hit.u - hit.v * hit.v;
  if (inside <= 0) return 0;
  const float frequency = 1 / l.leaf;
  const float leaf = fractal(across, up, frequency * 0.25F, 3, 0.9F, footprint, l.seed);
  const float filled = leaf + 1.6F * l.density - 1.2F + 0.8F * std::min(inside, 0.6F);
  const float soft = 0.08F + 0.3F * (1 - resolved(frequency, footprint));
  return smooth_step(-soft, soft, filled);
}

Colour Surfaces::leaves(const Leaves& l, const Hit& hit, const Ray& ray) const {
  const Place at = place(hit.way, ray);
  const float across = hit.u * l.half_width, up = hit.v * l.height;
  const float shade = fractal(across, up, 0.6F / l.leaf, 3, 0.8F, at.footprint, l.seed + 11);
  const float deep = l.blades ? 0.55F + 0.45F * hit.v : 0.8F + 0.3F * hit.v;
  // Leaves let light through: they are lit from every side.
  return through_air(lit(l.colour * std::max(0.15F, (1 + 0.6F * shade) * deep), hit, at, -1),
                     hit.way, ray);
}

Colour Surfaces::ground(float way, const Ray& ray) const {
  const Place at = place(way, ray);
  const float steep = std::max(0.05F, std::abs(ray.tangent));
  const float footprint = at.footprint * std::min(4.0F, 0.5F + 0.5F / steep);
  const std::uint32_t seed = world_.seed;
  const float patch = fractal(at.x, at.y, look_.patch_scale, 3, 0.55F, footprint, seed + 1);
  const float path = fractal(at.x, at.y, look_.patch_scale * 0.5F, 2, 0.5F, footprint, seed + 31);
  Colour skin = mix(look_.litter, look_.soil, smooth_step(0.05F, 0.5F, path));
  const float fine = fractal(at.x, at.y, look_.litter_scale, 3, 0.85F, footprint, seed + 51);
  const float blotch =
      fractal(at.x, at.y, look_.litter_scale * 0.2F, 2, 0.7F, footprint, seed + 61);
  skin = skin * std::max(0.12F, 1 + look_.litter_contrast * (0.9F * fine + 0.5F * blotch));
  const float green = patch + 0.25F * fine - 0.5F + look_.patches + 0.6F * look_.grass;
  skin = mix(skin, look_.moss * std::max(0.2F, 1 + 0.6F * fine), smooth_step(-0.12F, 0.12F, green));
  return through_air(lit(skin, Hit{way, 0, 0, 1, 0, 0}, at, -1), way, ray);
}

// Stems of the far wood as stripes over the bearing, in ranks: coverage of the ray, and colour.
float Surfaces::stems(float bearing, const Ray& ray, Colour& colour) const {
  float covered = 0;
  for (std::uint32_t rank = 0; rank < 2; ++rank) {
    const float cells = rank == 0 ? 220.0F : 420.0F;
    const float place = (bearing / 6.2831853F + 0.5F) * cells;
    const int cell = floor_to_int(place);
    const std::uint32_t seed = world_.seed + 900 + rank;
    const std::uint32_t key = hash(cell, 1, seed);
    if (unit(key) > look_.stems) continue;
    const float lean = 0.5F * (unit(hash(cell, 2, seed)) - 0.5F) * ray.tangent;
    const float middle = 0.3F + 0.4F * unit(hash(cell, 3, seed)) + lean;
    const float half = 0.06F + 0.2F * unit(hash(cell, 4, seed)) * (rank == 0 ? 1.0F : 0.8F);
    const float soft = ray.pixel * cells / 6.2831853F;
    const float beside = std::abs(place - static_cast<float>(cell) - middle);
    const float share = smooth_step(half + soft, half - soft, beside) * (1 - covered);
    if (share <= 0) continue;
    const float level = look_.stem_light * (0.3F + 0.9F * unit(hash(cell, 5, seed)));
    const float grain = 1 + 0.25F * noise(ray.tangent * 14, static_cast<float>(cell), seed + 7);
    colour = mix(colour, Colour{1.05F, 1, 0.9F} * (level * 0.6F * grain), share);
    covered += share;
  }
  return covered;
}

Colour Surfaces::backdrop(const Ray& ray) const {
  const float t = ray.tangent, height = t / std::sqrt(1 + t * t);
  const std::uint32_t seed = world_.seed;
  const float px = 1.6F * ray.pixel;
  const float clouds = fractal(ray.dx * 2, ray.dy * 2 + t, 1.2F, 4, 0.55F, px, seed + 201);
  Colour sky = mix(look_.sky_low, look_.sky_high, std::clamp(height * 1.4F, 0.0F, 1.0F));
  sky = mix(sky, look_.sky_low * 1.1F, smooth_step(-0.1F, 0.5F, clouds));

  const float profile = look_.backdrop_top * (1 + 0.5F * noise(ray.dx * 4, ray.dy * 4, seed + 202) +
                                              0.2F * noise(ray.dx * 21, ray.dy * 21, seed + 203));
  if (t > profile * 1.3F + 0.05F) return sky;
  const float bearing = std::atan2(ray.dy, ray.dx);
  const float twigs = fractal(bearing * 6, t * 6, 1, 5, 0.75F, px * 6, seed + 204);
  const float low = 1 - std::clamp(t / (profile + 0.01F), 0.0F, 1.0F);
  const float cover =
      smooth_step(-0.15F, 0.15F, twigs + 1.6F * look_.backdrop_cover - 1.1F + 1.1F * low) *
      smooth_step(profile * 1.2F + 0.01F, profile, t);
  const float shade = fractal(bearing * 14, t * 14, 1, 4, 0.8F, px * 14, seed + 205);
  Colour colour = mix(sky, look_.foliage * std::max(0.2F, 0.7F + 0.9F * shade), cover);
  if (look_.stems > 0 && t > -0.1F) stems(bearing, ray, colour);
  // Leaves hang before some of the stems.
  const float front =
      smooth_step(0.1F, 0.3F, twigs - 0.1F + 0.5F * shade) * smooth_step(profile, 0, t);
  colour = mix(colour, look_.foliage * std::max(0.2F, 0.9F + 0.9F * shade), 0.85F * front);
  return mix(look_.haze, colour, std::exp(-look_.fog * 60 * (1 - 0.6F * std::max(0.0F, height))));
}

}  // namespace bole::simulate
