// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/fisher_information_file.hpp>

#include <glidar/io/config/json_numbers.hpp>
#include <glidar/io/files/atomic_file.hpp>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 6> kAxes = {"rotation about x",    "rotation about y",
                                              "rotation about z",    "translation along x",
                                              "translation along y", "translation along z"};

constexpr const char* kConvention =
    "displacement (rotation x y z in rad, translation x y z in m) of the sensor, counted in its "
    "own "
    "frame: map_from_sensor * exp(displacement)";

Json matrix_json(const Matrix6& matrix) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < 6; ++row) rows.push_back(vector_json(matrix.row(row)));
  return rows;
}

std::string bound_text(double bound, bool is_angle) {
  if (std::isinf(bound)) return "unbounded";
  if (!is_angle) return fmt::format("{:.4g} m", bound);
  return fmt::format("{:.4g} deg", bound * 180.0 / std::numbers::pi);
}

}  // namespace

std::string information_text(const FisherInformation& information) {
  std::string text = fmt::format("pose information of {} returns", information.returns);
  if (information.left_out > 0) {
    text += fmt::format(" ({} that graze are left out)", information.left_out);
  }
  if (information.assumed_sigma_m) {
    text += fmt::format(", sigma of ranges assumed: {:g} m", *information.assumed_sigma_m);
  }
  text += "\nleast standard deviation (Cramer-Rao), sensor's frame:\n";
  for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
    const double bound = information.bound[static_cast<Eigen::Index>(axis)];
    text += fmt::format("  {:<20} {}\n", kAxes[axis], bound_text(bound, axis < 3));
  }
  text += fmt::format("directions, best known first (rotations times {:.4g} m):\n",
                      information.length_m);
  for (const EigenDirection& direction : information.directions) {
    const std::string deviation =
        direction.degenerate ? "DEGENERATE"
                             : fmt::format("{:.4g} m", 1.0 / std::sqrt(direction.eigenvalue));
    text += fmt::format("  {:<12} {}\n", deviation, direction.words);
  }
  return text;
}

std::string information_json(const FisherInformation& information) {
  Json directions = Json::array();
  for (const EigenDirection& direction : information.directions) {
    directions.push_back({{"words", direction.words},
                          {"degenerate", direction.degenerate},
                          {"eigenvalue_per_m2", direction.eigenvalue},
                          {"displacement", vector_json(direction.displacement)}});
  }
  Json all = {{"convention", kConvention},
              {"returns", information.returns},
              {"left_out", information.left_out},
              {"assumed_sigma_m",
               information.assumed_sigma_m ? Json(*information.assumed_sigma_m) : Json()},
              {"information", matrix_json(information.matrix)},
              {"covariance", matrix_json(information.covariance)},
              {"bound", vector_json(information.bound)},
              {"condition", information.condition},
              {"length_m", information.length_m},
              {"middle_m", vector_json(information.middle_m)},
              {"directions", directions}};
  remove_negative_zeros(all);
  return all.dump(2) + "\n";
}

void write_information(const FisherInformation& information, const std::filesystem::path& path) {
  AtomicFile file(path);
  file.write(information_json(information));
  file.commit();
}

}  // namespace glidar
