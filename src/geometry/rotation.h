#pragma once

#include <array>
#include <cmath>

namespace bole {

struct Vec3 {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalized(const Vec3& a) {
  const double n = norm(a);
  return {a.x / n, a.y / n, a.z / n};
}

/// A 3x3 matrix by rows. Of a rotation, or a reflection for cameras that see a mirrored world, the
/// transpose is the inverse; covariances are symmetric.
struct Mat3 {
  std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
};

inline Vec3 operator*(const Mat3& m, const Vec3& v) {
  return {dot(m.rows[0], v), dot(m.rows[1], v), dot(m.rows[2], v)};
}

inline Mat3 transposed(const Mat3& m) {
  const auto& r = m.rows;
  return {
      {Vec3{r[0].x, r[1].x, r[2].x}, Vec3{r[0].y, r[1].y, r[2].y}, Vec3{r[0].z, r[1].z, r[2].z}}};
}

inline Mat3 operator*(const Mat3& a, const Mat3& b) {
  const Mat3 t = transposed(b);
  return {{t * a.rows[0], t * a.rows[1], t * a.rows[2]}};
}

/// Rotations about the axes by `angle` radians, right-handed.
inline Mat3 rotation_x(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{Vec3{1, 0, 0}, Vec3{0, c, -s}, Vec3{0, s, c}}};
}
inline Mat3 rotation_y(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{Vec3{c, 0, s}, Vec3{0, 1, 0}, Vec3{-s, 0, c}}};
}
inline Mat3 rotation_z(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{Vec3{c, -s, 0}, Vec3{s, c, 0}, Vec3{0, 0, 1}}};
}

}  // namespace bole
