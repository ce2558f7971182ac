#include "engine/quality/exact_sign.h"

#include <cmath>

namespace toile {

namespace {

constexpr double kUnit = 0x1p-53;                      ///< half an ulp of 1
constexpr double kFilter3 = (7 + 56 * kUnit) * kUnit;  ///< Shewchuk's o3derrboundA
constexpr double kFilter2 = (3 + 16 * kUnit) * kUnit;  ///< Shewchuk's ccwerrboundA

int sign(double x) { return (x > 0) - (x < 0); }

/// a·b as a double. GCC fuses a product with a later sum, also across statements, and then there is nothing to correct.
double rounded_product(double a, double b) {
  double product = a * b;
  asm("" : "+x"(product));
  return product;
}

/// A sum of doubles held without rounding: components that don't overlap, of rising magnitude.
class Expansion {
 public:
  void add(double x) {
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      const double sum = x + parts_[i], virtual_part = sum - x;
      const double error = (x - (sum - virtual_part)) + (parts_[i] - virtual_part);
      if (error != 0) parts_[kept++] = error;
      x = sum;
    }
    if (x != 0) parts_[kept++] = x;
    count_ = kept;
  }
  void add_product(double a, double b) {
    const double product = rounded_product(a, b);
    add(std::fma(a, b, -product));
    add(product);
  }
  void add_product(double a, double b, double c) {
    const double high = rounded_product(a, b), low = std::fma(a, b, -high);
    add_product(low, c);
    add_product(high, c);
  }
  int sign() const { return count_ == 0 ? 0 : toile::sign(parts_[count_ - 1]); }

 private:
  std::array<double, 128> parts_;  ///< 24 triple products of four components each at most
  int count_ = 0;
};

/// det(p, q, r) of the coordinates as they are, times `s`.
void add_determinant(Expansion& sum, const Vec3& p, const Vec3& q, const Vec3& r, double s) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    sum.add_product(s * p[k], q[i], r[j]);
    sum.add_product(-s * p[k], q[j], r[i]);
  }
}

int exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Expansion sum;
  add_determinant(sum, b, c, d, 1);
  add_determinant(sum, a, c, d, -1);
  add_determinant(sum, a, b, d, 1);
  add_determinant(sum, a, b, c, -1);
  return sum.sign();
}

}  // namespace

int orientation_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double yz = v.y() * w.z(), zy = v.z() * w.y(), zx = v.z() * w.x(), xz = v.x() * w.z();
  const double xy = v.x() * w.y(), yx = v.y() * w.x();
  const double determinant = u.x() * (yz - zy) + u.y() * (zx - xz) + u.z() * (xy - yx);
  const double permanent = std::abs(u.x()) * (std::abs(yz) + std::abs(zy)) +
                           std::abs(u.y()) * (std::abs(zx) + std::abs(xz)) +
                           std::abs(u.z()) * (std::abs(xy) + std::abs(yx));
  return std::abs(determinant) > kFilter3 * permanent ? sign(determinant) : exact(a, b, c, d);
}

int orientation_sign(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (b.x() - a.x()) * (c.y() - a.y()), right = (b.y() - a.y()) * (c.x() - a.x());
  const double determinant = left - right;
  if (std::abs(determinant) > kFilter2 * (std::abs(left) + std::abs(right))) return sign(determinant);
  Expansion sum;
  sum.add_product(a.x(), b.y());
  sum.add_product(-a.y(), b.x());
  sum.add_product(b.x(), c.y());
  sum.add_product(-b.y(), c.x());
  sum.add_product(c.x(), a.y());
  sum.add_product(-c.y(), a.x());
  return sum.sign();
}

}  // namespace toile
