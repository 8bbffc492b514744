#include "simulate/surface.h"

#include <algorithm>
#include <cmath>

namespace bole::simulate {
namespace {

constexpr float kSkyLight = 0.5F;  // of an open sky on level ground, beside the sun's strength

// Furrows are narrow and dark, ridges broad: the value of the noise's magnitude.
Colour bark(const Bark& b, float x, float y, float along, float footprint, std::uint32_t seed) {
  float ridge = 0, strength = 0.55F, scale = b.scale;
  for (std::uint32_t octave = 0; octave < 3; ++octave, scale *= 0.4F, strength *= 0.8F) {
    const float left = resolved(scale, footprint);
    if (left <= 0) continue;
    const float wave = noise(x * scale, y * scale, along * scale / b.stretch, seed + octave);
    ridge += left * strength * (2.4F * std::sqrt(std::abs(wave)) - 1.2F);
  }
  const float slow = noise((x + y) * 2, along * 0.6F, seed + 7);
  return mix(b.dark, b.light, std::clamp(0.55F + b.contrast * ridge, 0.0F, 1.0F)) *
         (1 + 0.25F * slow);
}

}  // namespace

Surfaces::Place Surfaces::place(float way, const Ray& ray) const {
  return {x_ + way * ray.dx, y_ + way * ray.dy, z_ + way * ray.tangent, way * ray.pixel};
}

Colour Surfaces::lit(Colour reflectance, const Hit& hit, const Place& at, int self) const {
  const float length = std::sqrt(1 + look_.sun_slope * look_.sun_slope);
  const float facing =
      (hit.nx * look_.sun_x + hit.ny * look_.sun_y + hit.nz * look_.sun_slope) / length;
  // More of the sky stands open on the sun's side and above.
  const float side = hit.nx * look_.sun_x + hit.ny * look_.sun_y;
  const float sky = kSkyLight * (0.7F + 0.3F * hit.nz + 0.25F * side);
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
    // Scars: wide around the trunk, low along it.
    const float bars = noise(hit.nx * 1.7F, hit.ny * 1.7F, hit.v * 7, c.seed + 5) +
                       0.8F * noise(hit.nx * r * 14, hit.ny * r * 14, hit.v * 40, c.seed + 6);
    skin = mix(skin, Colour{0.05F, 0.045F, 0.04F},
               smooth_step(0.65F, 0.85F, bars) * (0.3F + 0.7F * resolved(12, at.footprint)));
  }
  if (b.moss > 0) {
    const float grown =
        noise(hit.nx * 3, hit.ny * 3, hit.v * 2.5F, c.seed + 8) +
        0.5F * fractal(hit.nx * r + at.z, hit.ny * r + at.z, 15, 2, 0.5F, at.footprint, c.seed + 9);
    const float high = b.moss * 2 - 0.8F - 0.25F * hit.v;
    skin = mix(skin, look_.moss * 0.8F, smooth_step(-0.15F, 0.15F, grown * 0.7F + high));
  }
  if (c.heap > 0) {
    const float top = c.heap * (1 + 0.7F * noise(hit.nx * 4, hit.ny * 4, c.seed + 12));
    const float grain =
        fractal(at.x + at.z, at.y, look_.litter_scale, 3, 0.9F, at.footprint, world_.seed + 51);
    skin = mix(look_.litter * std::exp(look_.litter_contrast * grain), skin,
               smooth_step(top - 0.015F, top + 0.015F, hit.v));
  }
  // Little light reaches the foot: ground and undergrowth keep it off.
  const float open = 1 - c.shade * (1 - smooth_step(-0.1F, 0.5F, hit.v));
  return through_air(lit(skin, hit, at, index) * open, hit.way, ray);
}

Colour Surfaces::boulder(const Boulder& b, const Hit& hit, const Ray& ray) const {
  const Place at = place(hit.way, ray);
  const float grain =
      fractal(at.x + at.z * 0.7F, at.y - at.z * 0.6F, 3, 4, 0.6F, at.footprint, b.seed);
  const float moss = smooth_step(0.3F, 0.6F, hit.nz + 0.6F * grain) * b.roughness;
  const Colour skin = mix(b.colour * std::exp(1.2F * b.roughness * grain), look_.moss, 0.6F * moss);
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
    skin = skin * std::exp(1.4F * fractal(hit.u, hit.v, 5, 4, 0.9F, at.footprint, w.seed));
  } else {
    const float cracks = fractal(hit.u * 0.8F, hit.v * 1.7F, 0.7F, 5, 0.65F, at.footprint, w.seed);
    skin = skin * std::exp(1.6F * cracks);
  }
  const float grain = 1 + 0.3F * fractal(hit.u, hit.v, 20, 2, 0.6F, at.footprint, w.seed + 9);
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
  const float leaf = fractal(across, up, frequency * 0.12F, 4, 0.95F, footprint, l.seed);
  const float filled = leaf + 1.6F * l.density - 1.3F + 0.8F * std::min(inside, 0.6F);
  const float soft = 0.08F + 0.3F * (1 - resolved(frequency, footprint));
  return smooth_step(-soft, soft, filled);
}

Colour Surfaces::leaves(const Leaves& l, const Hit& hit, const Ray& ray) const {
  const Place at = place(hit.way, ray);
  const float across = hit.u * l.half_width, up = hit.v * l.height;
  const float shade = fractal(across, up, 0.4F / l.leaf, 3, 0.9F, at.footprint, l.seed + 11);
  const float deep = l.blades ? 0.45F + 0.55F * hit.v : 0.75F + 0.35F * hit.v;
  // Leaves let light through: they are lit from every side.
  return through_air(lit(l.colour * (std::exp(1.3F * shade) * deep), hit, at, -1), hit.way, ray);
}

Colour Surfaces::ground(float way, const Ray& ray) const {
  const Place at = place(way, ray);
  // A pixel spans more of the ground the flatter the view.
  const float steep = std::max(0.1F, std::abs(ray.tangent));
  const float footprint = at.footprint * (0.5F + 0.5F / steep) * 0.6F;
  const std::uint32_t seed = world_.seed;
  const float path = fractal(at.x, at.y, look_.patch_scale * 0.5F, 2, 0.5F, footprint, seed + 31);
  const float patch = fractal(at.x, at.y, look_.patch_scale, 3, 0.7F, footprint, seed + 1);
  const float fine = fractal(at.x, at.y, look_.litter_scale, 3, 0.9F, footprint, seed + 51);
  const float blotch =
      fractal(at.x, at.y, look_.litter_scale * 0.15F, 2, 0.8F, footprint, seed + 61);
  Colour skin = mix(look_.litter, look_.soil, smooth_step(0.1F, 0.4F, path + 0.3F * blotch));
  skin = skin * std::exp(look_.litter_contrast * (1.4F * fine + 0.9F * blotch));
  const float green =
      patch + 0.3F * fine + 0.3F * blotch - 0.5F + look_.patches + 0.6F * look_.grass;
  const Colour grown = look_.moss * std::exp(1.2F * fine - 0.5F * blotch);
  skin = mix(skin, grown, smooth_step(-0.12F, 0.12F, green));
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

Colour Surfaces::sky(const Ray& ray, float height) const {
  const float clouds =
      fractal(ray.dx * 2, ray.dy * 2 + ray.tangent, 1.2F, 3, 0.6F, 0, world_.seed + 201);
  const Colour clear = mix(look_.sky_low, look_.sky_high, std::clamp(height * 1.4F, 0.0F, 1.0F));
  return mix(clear, look_.sky_low * 1.1F, smooth_step(-0.1F, 0.5F, clouds));
}

Colour Surfaces::backdrop(const Ray& ray) const {
  const float t = ray.tangent, height = t / std::sqrt(1 + t * t);
  const std::uint32_t seed = world_.seed;
  const float profile = look_.backdrop_top * (1 + 0.5F * noise(ray.dx * 4, ray.dy * 4, seed + 202) +
                                              0.2F * noise(ray.dx * 21, ray.dy * 21, seed + 203));
  const float air = std::exp(-look_.fog * 45 * (1 - 0.6F * std::max(0.0F, height)));
  if (t > profile * 1.3F + 0.05F) return mix(look_.haze, sky(ray, height), air);
  const float pixel = ray.pixel;
  const float bearing = std::atan2(ray.dy, ray.dx);
  const float boughs = fractal(bearing, t, 5, 5, 0.8F, pixel, seed + 204);
  const float leaves = fractal(bearing, t, 19, 3, 0.9F, pixel, seed + 205);
  const float up = std::clamp(t / (profile + 0.01F), 0.0F, 1.0F);
  const float closed = boughs + 1.5F * look_.backdrop_cover - 1.0F + 0.7F * (1 - up);
  const float cover =
      smooth_step(-0.2F, 0.2F, closed) * smooth_step(profile * 1.2F + 0.01F, profile, t);
  // Clumps in the sun before gaps that no light reaches.
  const float sunlit = smooth_step(-0.05F, 0.5F, boughs + 0.4F * leaves);
  const float light = (0.5F + look_.sun_strength * 0.7F * sunlit) * mix(look_.interior, 1.0F, up) *
                      std::exp(1.3F * leaves + 0.6F * boughs);
  const Colour crowns = look_.foliage * light;
  Colour colour = cover < 1 ? mix(sky(ray, height), crowns, cover) : crowns;
  // Leaves hang before most of the stems.
  const float front = smooth_step(-0.1F, 0.25F, leaves - boughs + look_.veil);
  if (look_.stems > 0 && t > -0.1F && front < 1) {
    Colour behind = colour;
    stems(bearing, ray, behind);
    colour = mix(behind, colour, front);
  }
  return mix(look_.haze, colour, air);
}

}  // namespace bole::simulate
