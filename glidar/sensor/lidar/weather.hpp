// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace glidar {

class FieldVisitor;

inline constexpr double kContrastDepth = 3.912;  ///< -ln 0.02, with the usual digits
inline constexpr double kOpticalRangeDepth = 2.9957322735539909;  ///< ln 20

inline constexpr double kMaxVisibility_m = 1e6;  ///< larger visibilities are not allowed
inline constexpr unsigned kMaxFogLooks = 64;
inline constexpr double kMaxFall_mm_per_h = 1000.0;  ///< maximum rate of rain and snow

/// Fog, rain and snow. They affect pulsed sensors.
struct Weather {
  /// Definition of the visibility: the distance over which 2 % of contrast remain (Koschmieder,
  /// ln 50), or 5 % of light (meteorological optical range, ln 20).
  enum class Visibility : std::uint8_t { contrast, mor };
  /// Extinction as a function of the wavelength, see fog_extinction_per_m().
  enum class FogModel : std::uint8_t { kim, kruse };
  /// Extinction by rain: from the cross-sections of the drops, or 0.01 / m (mm/h)^-0.6 as measured
  /// (Goodin et al., Electronics 8 (2019) 89), which is about 25 times larger.
  enum class RainModel : std::uint8_t { geometric, goodin };
  /// Gunn and Marshall, J. Meteor. 15 (1958) 452, or Sekhon and Srivastava, J. Atmos. Sci. 27
  /// (1970) 299; see snow_sizes.
  enum class SnowModel : std::uint8_t { gunn_marshall, sekhon_srivastava };

  double visibility_m = 0.0;  ///< in fog or haze; 0: clear
  Visibility visibility_kind = Visibility::contrast;
  FogModel fog_model = FogModel::kim;
  /// Variation of the echoes of fog: the backscatter of fog over the length of a pulse is gamma
  /// distributed with this shape; its relative standard deviation is 1 / sqrt(looks). 0: none.
  unsigned fog_looks = 1;
  /// Backscatter coefficient of fog times its meteorological optical range, 1/sr; 0.023 to 0.092
  /// (Rasshofer, Spies, Spies, Adv. Radio Sci. 9 (2011) 49).
  double fog_backscatter_per_sr = 0.046;
  double rain_mm_per_h = 0.0;
  RainModel rain_model = RainModel::geometric;
  double snow_mm_per_h = 0.0;  ///< water equivalent
  SnowModel snow_model = SnowModel::gunn_marshall;
  double min_signal = 0.1;  ///< weather echoes below this share of the threshold are ignored
};

/// Throws Error with the number that is out of range.
void validate(const Weather& weather);

/// Keys of `weather` in sensor files.
void describe(Weather& weather, FieldVisitor& visitor);

/// Extinction by fog: 3.912 / V (550 nm / wavelength)^q, or 2.996 / V for the optical range. Kruse,
/// McGlauchlin, McQuistan, "Elements of infrared technology", 1962: q = 1.6 above 50 km, 1.3 above
/// 6 km, else 0.585 (V / km)^(1/3). Kim, McArthur, Korevaar, Proc. SPIE 4214 (2001) 26: up to 6 km
/// 0.16 V + 0.34, up to 1 km V - 0.5, up to 0.5 km 0. Throws Error for fog with the wavelength 0.
double fog_extinction_per_m(const Weather& weather, double wavelength_m);

/// Extinction by fog, rain and snow together, per metre.
double extinction_per_m(const Weather& weather, double wavelength_m);

}  // namespace glidar
