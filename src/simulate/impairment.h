#pragma once

#include <optional>
#include <string_view>

#include "simulate/picture.h"

namespace bole::simulate {

/// What can befall a camera so that it no longer sees.
enum class Impairment {
  darkness,  ///< next to no light, noise is left
  glare,     ///< low sun in the optics: a veil over most of the picture, half of it blown out
  covered,   ///< something opaque and out of focus before a third of the picture
  smeared,   ///< mud or water on the lens: blurred and milky, in patches over most of it
  frozen,    ///< the same picture again and again
};

/// The impairment of that name; nullopt for any other.
std::optional<Impairment> impairment_from_name(std::string_view name);

/// Impairs pictures of one sequence, simulated or real.
class Impairer {
 public:
  Impairer(Impairment impairment, std::uint64_t seed) : impairment_(impairment), seed_(seed) {}

  /// Pictures in their order. What lies on the lens stays in its place; noise changes.
  Picture apply(const Picture& picture);

 private:
  Impairment impairment_;
  std::uint64_t seed_;
  std::uint32_t count_ = 0;
  Picture first_;  // of a frozen sequence
};

}  // namespace bole::simulate
