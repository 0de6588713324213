// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/las_crs.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/files/input_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <string_view>

namespace glidar {
namespace {

constexpr const char* kAllowedCrs =
    "EPSG:CODE of a UTM zone, well-known text (OGC 01-009) in metres, or a file that contains it";
constexpr const char* kCrsRemedy =
    "write the text of another code to a file: projinfo -q -o WKT1:GDAL EPSG:2154 > crs.wkt";

[[noreturn]] void refuse_crs(std::string found) {
  throw Error({"crs", std::move(found), kAllowedCrs, kCrsRemedy});
}

/// A family of UTM zones: zone z has the code first_code + z.
struct UtmFamily {
  int first_code;
  int min_zone;
  int max_zone;
  char hemisphere;
  const char* name;
  const char* datum;
  const char* ellipsoid;  ///< with its EPSG code
  int datum_code;
  int geographic_code;
};

constexpr const char* kGrs80 = R"("GRS 1980",6378137,298.257222101,AUTHORITY["EPSG","7019"])";
constexpr const char* kWgs84 = R"("WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"])";

constexpr std::array<UtmFamily, 4> kUtmFamilies = {{
    {32600, 1, 60, 'N', "WGS 84", "WGS_1984", kWgs84, 6326, 4326},
    {32700, 1, 60, 'S', "WGS 84", "WGS_1984", kWgs84, 6326, 4326},
    {25800, 28, 38, 'N', "ETRS89", "European_Terrestrial_Reference_System_1989", kGrs80, 6258,
     4258},
    {26900, 1, 23, 'N', "NAD83", "North_American_Datum_1983", kGrs80, 6269, 4269},
}};

std::string utm_text(const UtmFamily& utm, int zone) {
  return fmt::format(
      R"(PROJCS["{} / UTM zone {}{}",GEOGCS["{}",DATUM["{}",SPHEROID[{}],AUTHORITY["EPSG","{}"]],)"
      R"(PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],)"
      R"(UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","{}"]],)"
      R"(PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],)"
      R"(PARAMETER["central_meridian",{}],PARAMETER["scale_factor",0.9996],)"
      R"(PARAMETER["false_easting",500000],PARAMETER["false_northing",{}],)"
      R"(UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["Easting",EAST],AXIS["Northing",NORTH],)"
      R"(AUTHORITY["EPSG","{}"]])",
      utm.name, zone, utm.hemisphere, utm.name, utm.datum, utm.ellipsoid, utm.datum_code,
      utm.geographic_code, 6 * zone - 183, utm.hemisphere == 'S' ? 10'000'000 : 0,
      utm.first_code + zone);
}

/// The code of "EPSG:CODE", in any case; empty: another text.
std::optional<int> epsg_code(std::string_view crs) {
  constexpr std::string_view kPrefix = "epsg:";
  const auto is_same = [](char a, char b) {
    return a == std::tolower(static_cast<unsigned char>(b));
  };
  if (crs.size() < kPrefix.size() ||
      !std::equal(kPrefix.begin(), kPrefix.end(), crs.begin(), is_same))
    return std::nullopt;
  int code = 0;
  const char* end = crs.data() + crs.size();
  const auto [stop, error] = std::from_chars(crs.data() + kPrefix.size(), end, code);
  if (error != std::errc() || stop != end) refuse_crs(fmt::format("'{}'", excerpt(crs)));
  return code;
}

std::string text_of_code(int code) {
  for (const UtmFamily& utm : kUtmFamilies) {
    const int zone = code - utm.first_code;
    if (zone >= utm.min_zone && zone <= utm.max_zone) return utm_text(utm, zone);
  }
  refuse_crs(fmt::format("EPSG:{} is not a UTM zone of WGS 84, ETRS89 or NAD83", code));
}

bool is_well_known_text(std::string_view text) {
  constexpr std::array<std::string_view, 4> kKinds = {"PROJCS[", "COMPD_CS[", "GEOCCS[",
                                                      "LOCAL_CS["};
  return std::ranges::any_of(kKinds, [&](std::string_view kind) { return text.starts_with(kind); });
}

/// Whether all brackets and quotes are closed, and nothing follows.
bool is_complete_crs(std::string_view text) {
  int depth = 0;
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') is_quoted = !is_quoted;
    if (is_quoted) continue;
    depth += text[i] == '[' ? 1 : text[i] == ']' ? -1 : 0;
    if (depth == 0 && text[i] == ']') return i + 1 == text.size();
  }
  return false;
}

/// Throws Error unless coordinates are in metres: the last unit of the text that is not of angles.
void check_crs_unit(std::string_view text) {
  for (std::size_t at = text.find("UNIT["); at != std::string_view::npos;
       at = text.find("UNIT[", at + 1)) {
    const std::size_t comma = text.find(',', at);
    if (comma == std::string_view::npos) return;
    double factor = 0.0;
    const std::size_t digits = std::min(text.find_first_not_of(" \t\r\n", comma + 1), text.size());
    std::from_chars(text.data() + digits, text.data() + text.size(), factor);
    const std::string_view name = text.substr(at + 5, comma - at - 5);
    const bool is_angle = name.find("egree") != std::string_view::npos ||
                          name.find("rad") != std::string_view::npos ||
                          name.find("grad") != std::string_view::npos;
    if (!is_angle && factor != 1.0) refuse_crs(fmt::format("the unit {}", excerpt(name)));
  }
}

std::string checked_crs(std::string text) {
  std::erase_if(text, [](char c) { return c == '\n' || c == '\r' || c == '\t'; });
  while (!text.empty() && text.back() == ' ') text.pop_back();
  constexpr std::size_t kMaxBytes = 65'534;  // of a record, with the zero at its end
  if (!is_well_known_text(text)) refuse_crs(fmt::format("'{}'", excerpt(text)));
  if (text.size() > kMaxBytes) refuse_crs(fmt::format("{} bytes of text", text.size()));
  if (!is_complete_crs(text)) refuse_crs("text whose brackets or quotes do not match");
  check_crs_unit(text);
  return text;
}

}  // namespace

std::string crs_text(const std::string& crs) {
  if (const auto code = epsg_code(crs)) return text_of_code(*code);
  if (is_well_known_text(crs)) return checked_crs(crs);
  if (crs.find('[') != std::string::npos) refuse_crs(fmt::format("'{}'", excerpt(crs)));
  return checked_crs(
      read_text_file(crs, {"a file with the well-known text of a coordinate system", 1, ""}));
}

}  // namespace glidar
