#include "simulate/impairment.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulate/noise.h"

namespace bole::simulate {
namespace {

constexpr std::array<std::string_view, 5> kNames = {"darkness", "glare", "covered", "smeared",
                                                    "frozen"};

// Calls change(pixel's three bytes, x, y, its index), x and y from -1 to 1 over the shorter side.
template <typename Change>
void for_each_pixel(Picture& picture, Change change) {
  const float half = 0.5F * static_cast<float>(std::min(picture.size.width, picture.size.height));
  std::uint32_t index = 0;
  for (int row = 0; row < picture.size.height; ++row) {
    for (int column = 0; column < picture.size.width; ++column, ++index) {
      const float x =
          (static_cast<float>(column) - 0.5F * static_cast<float>(picture.size.width)) / half;
      const float y =
          (static_cast<float>(row) - 0.5F * static_cast<float>(picture.size.height)) / half;
      change(picture.rgb.data() + 3 * static_cast<std::size_t>(index), x, y, index);
    }
  }
}

std::uint8_t grey(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
}

void darken(Picture& picture, std::uint32_t seed) {
  for_each_pixel(picture, [&](std::uint8_t* rgb, float, float, std::uint32_t i) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      rgb[k] = grey(static_cast<float>(rgb[k]) * 0.03F + 3 * unit(hash(i, k, seed)));
    }
  });
}

void blow_out(Picture& picture, float bearing) {
  const float sx = std::cos(bearing), sy = std::sin(bearing);
  for_each_pixel(picture, [&](std::uint8_t* rgb, float x, float y, std::uint32_t) {
    const float towards = 0.5F + 0.5F * (x * sx + y * sy);
    const float veil = 300 * smooth_step(-0.1F, 0.75F, towards);
    for (int k = 0; k < 3; ++k) rgb[k] = grey(static_cast<float>(rgb[k]) * 0.8F + veil);
  });
}

void cover(Picture& picture, float bearing, std::uint32_t seed) {
  const float sx = std::cos(bearing), sy = std::sin(bearing);
  const Colour mud{0.5F + unit(seed), 0.5F + unit(scramble(seed)), 0.5F + unit(scramble(seed + 1))};
  for_each_pixel(picture, [&](std::uint8_t* rgb, float x, float y, std::uint32_t) {
    // A third of the bearings: cos 60 degrees.
    const float radius = std::sqrt(x * x + y * y) + 1e-3F;
    const float edge = 0.5F + 0.08F * noise(6 * x, 6 * y, seed);
    const float share = smooth_step(edge - 0.06F, edge + 0.06F, (x * sx + y * sy) / radius);
    const std::array<float, 3> tint = {mud.r, mud.g, mud.b};
    for (std::size_t k = 0; k < 3; ++k) {
      rgb[k] = grey(mix(static_cast<float>(rgb[k]), 24 * tint.at(k), share));
    }
  });
}

// Means over squares of 2 `radius` + 1, by sums along rows, then columns.
Picture averaged(const Picture& picture, int radius) {
  Picture result = picture;
  const auto pass = [&](std::ptrdiff_t first, std::ptrdiff_t step, int count) {
    std::vector<int> sums(static_cast<std::size_t>(count) + 1);
    for (int i = 0; i < count; ++i) sums[i + 1] = sums[i] + result.rgb[first + i * step];
    for (int i = 0; i < count; ++i) {
      const int a = std::max(0, i - radius), b = std::min(count, i + radius + 1);
      result.rgb[first + i * step] = static_cast<std::uint8_t>((sums[b] - sums[a]) / (b - a));
    }
  };
  const int width = picture.size.width, height = picture.size.height;
  for (int k = 0; k < 3; ++k) {
    for (std::ptrdiff_t row = 0; row < height; ++row) pass(3 * row * width + k, 3, width);
    for (std::ptrdiff_t column = 0; column < width; ++column) {
      pass(3 * column + k, std::ptrdiff_t{3} * width, height);
    }
  }
  return result;
}

void smear(Picture& picture, std::uint32_t seed) {
  const Picture soft =
      averaged(averaged(picture, picture.size.height / 60), picture.size.height / 60);
  for_each_pixel(picture, [&](std::uint8_t* rgb, float x, float y, std::uint32_t i) {
    const float wet = smooth_step(-0.6F, -0.2F, noise(2.5F * x, 2.5F * y, seed));
    for (std::size_t k = 0; k < 3; ++k) {
      const float blurred = static_cast<float>(soft.rgb[3 * static_cast<std::size_t>(i) + k]);
      rgb[k] = grey(mix(static_cast<float>(rgb[k]), 0.55F * blurred + 55, wet));
    }
  });
}

}  // namespace

std::optional<Impairment> impairment_from_name(std::string_view name) {
  const auto* const found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Impairment>(found - kNames.begin());
}

Picture Impairer::apply(const Picture& picture) {
  const std::uint32_t index = count_++;
  Random random(seed_, 6);
  const float bearing = random.uniform(0, 6.2831853F);
  const std::uint32_t key = random.bits();
  if (impairment_ == Impairment::frozen) {
    if (index == 0) first_ = picture;
    return first_;
  }
  Picture result = picture;
  if (impairment_ == Impairment::darkness) darken(result, hash(index, 0, key));
  if (impairment_ == Impairment::glare) blow_out(result, bearing);
  if (impairment_ == Impairment::covered) cover(result, bearing, key);
  if (impairment_ == Impairment::smeared) smear(result, key);
  return result;
}

}  // namespace bole::simulate
