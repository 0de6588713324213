// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cfloat>
#include <cmath>
#include <compare>

// The exact error of a product of two doubles. Reassociation, contraction or excess precision would
// make it wrong.
#ifdef __FAST_MATH__
#error "GLIDAR's hit rule is exact only without -ffast-math; remove that flag"
#endif

namespace glidar {

static_assert(FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 16,
              "doubles must be computed in double precision (no x87: use -mfpmath=sse)");

/// error(a, b, fl(a b)) = a b - fl(a b), exactly, by a fused multiply-add. Holds unless the error
/// underflows.
struct FusedProduct {
  static double error(double a, double b, double product) { return std::fma(a, b, -product); }
};

/// The same bits without a fused multiply-add, for |a|, |b| < 2^995: T. J. Dekker, "A
/// floating-point technique for extending the available precision", Numer. Math. 18 (1971), with
/// Veltkamp's split.
struct DekkerProduct {
  static double error(double a, double b, double product) {
    const Halves x = split(a);
    const Halves y = split(b);
    const double high = x.high * y.high - product;
    const double middle = (high + x.high * y.low) + x.low * y.high;
    return middle + x.low * y.low;
  }

 private:
  struct Halves {
    double high;
    double low;
  };
  /// The upper 26 bits and the rest.
  static Halves split(double value) {
    constexpr double kSplitter = 0x1p27 + 1.0;
    const double scaled = kSplitter * value;
    const double high = scaled - (scaled - value);
    return {high, value - high};
  }
};

/// The faster of the two on the target processor.
#if defined(__FMA__) || defined(__aarch64__)
using ExactProduct = FusedProduct;
#else
using ExactProduct = DekkerProduct;
#endif

/// A number of about 106 bits as the sum high + low, where high is the sum rounded to double.
/// Unlike long double, it has the same bits on every machine. The relative error of a sum, product,
/// quotient or square root is below 2^-102, unless parts overflow or underflow: T. J. Dekker,
/// "A floating-point technique for extending the available precision", Numer. Math. 18 (1971).
struct DoubleDouble {
  double high = 0.0;
  double low = 0.0;

  constexpr DoubleDouble() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): every double is one
  constexpr DoubleDouble(double value) : high(value) {}
  constexpr DoubleDouble(double upper, double lower) : high(upper), low(lower) {}

  /// The nearest double.
  explicit constexpr operator double() const { return high; }

  constexpr auto operator<=>(const DoubleDouble&) const = default;
  constexpr DoubleDouble operator-() const { return {-high, -low}; }
};

/// a + b exactly: Knuth, "The Art of Computer Programming" 2, 4.2.2, theorem B.
inline DoubleDouble exact_sum(double a, double b) {
  const double sum = a + b;
  const double part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// a b exactly.
inline DoubleDouble exact_product(double a, double b) {
  const double product = a * b;
  return {product, ExactProduct::error(a, b, product)};
}

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = exact_sum(a.high, b.high);
  const DoubleDouble low = exact_sum(a.low, b.low);
  const DoubleDouble sum = exact_sum(high.high, high.low + low.high);
  return exact_sum(sum.high, sum.low + low.low);
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
  return a + -b;
}

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = exact_product(a.high, b.high);
  return exact_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

/// Long division: each quotient of the leading parts adds 52 bits.
inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double first = a.high / b.high;
  DoubleDouble rest = a - b * first;
  const double second = rest.high / b.high;
  rest = rest - b * second;
  return exact_sum(first, second) + rest.high / b.high;
}

inline DoubleDouble& operator+=(DoubleDouble& a, const DoubleDouble& b) {
  return a = a + b;
}

inline DoubleDouble& operator-=(DoubleDouble& a, const DoubleDouble& b) {
  return a = a - b;
}

inline DoubleDouble& operator*=(DoubleDouble& a, const DoubleDouble& b) {
  return a = a * b;
}

inline DoubleDouble& operator/=(DoubleDouble& a, const DoubleDouble& b) {
  return a = a / b;
}

inline DoubleDouble abs(const DoubleDouble& a) {
  return a.high < 0.0 ? -a : a;
}

/// One step of Newton's method from the root of the leading part.
inline DoubleDouble sqrt(const DoubleDouble& a) {
  const double root = std::sqrt(a.high);
  if (!(root > 0.0)) return root;
  return exact_sum(root, (a - exact_product(root, root)).high / (2.0 * root));
}

}  // namespace glidar
