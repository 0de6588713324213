// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cfloat>
#include <cmath>

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

}  // namespace glidar
