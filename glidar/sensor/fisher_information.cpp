// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/fisher_information.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace glidar {
namespace {

constexpr double kNegligible = 1e-3;

std::string rounded_text(double value) {
  constexpr std::size_t kRoom = 32;
  std::array<char, kRoom> text{};
  const int length = std::snprintf(text.data(), text.size(), "%.4g", value + 0.0);
  return {text.data(), static_cast<std::size_t>(length)};
}

std::string triple_text(const Eigen::Vector3d& v, double negligible) {
  std::string text;
  for (const double value : {v.x(), v.y(), v.z()}) {
    text += (text.empty() ? "(" : ", ") + rounded_text(std::abs(value) < negligible ? 0.0 : value);
  }
  return text + ")";
}

/// "x" for the directions +x and -x, and so on, else the components.
std::string axis_text(const Eigen::Vector3d& direction) {
  Eigen::Index axis = 0;
  const double length = direction.cwiseAbs().maxCoeff(&axis);
  const double others = std::sqrt(std::max(0.0, direction.squaredNorm() - length * length));
  if (others < kNegligible * length) return std::string(1, "xyz"[axis]);
  return triple_text(direction[axis] < 0.0 ? Eigen::Vector3d(-direction) : direction, 1e-4);
}

}  // namespace

std::string describe_displacement(const Vector6& displacement, double length_m) {
  const Eigen::Vector3d rotation = displacement.head<3>();
  const Eigen::Vector3d translation = displacement.tail<3>();
  if (rotation.norm() * length_m < kNegligible * translation.norm()) {
    return "translation along " + axis_text(translation.normalized());
  }
  // Chasles: every displacement is a screw. Lynch & Park, "Modern Robotics" (2017),
  // section 3.3.2.2.
  const double turn2 = rotation.squaredNorm();
  const Eigen::Vector3d point = rotation.cross(translation) / turn2;
  const double pitch = rotation.dot(translation) / turn2;
  const double negligible = kNegligible * length_m;
  std::string text = "rotation about " + axis_text(rotation.normalized());
  if (point.norm() > negligible) text += " through " + triple_text(point, negligible) + " m";
  if (std::abs(pitch) > negligible) text += ", with " + rounded_text(pitch) + " m along it per rad";
  return text;
}

namespace {

using Eigen::Vector3d;

// Normals have single precision: a degenerate direction gets (1e-7)^2 of the best direction's
// information from each of them, and more if the points are far from their centroid.
constexpr double kDegenerate = 1e-11;

void check(const Frame& frame, const Beams& beams, const FisherOptions& options) {
  if (frame.ground_truth.normal.size() != beams.size() || frame.status.size() != beams.size() ||
      frame.ground_truth.range_m.size() != beams.size()) {
    throw Error({"pose information", "a frame without normals, or of other beams",
                 "a frame cast with the field 'normal'"});
  }
  if (!(options.sigma_m > 0.0) || !std::isfinite(options.sigma_m)) {
    throw Error({"pose information, sigma", std::to_string(options.sigma_m), "metres above 0"});
  }
  if (!(options.least_cosine > 0.0 && options.least_cosine < 1.0)) {
    throw Error({"pose information, minimum cosine", std::to_string(options.least_cosine),
                 "above 0 and below 1"});
  }
  if (!is_rigid(options.sensor_from_reference)) {
    throw Error({"pose information, reference", "not a rigid transform", "a pose"});
  }
}

/// One return, in the reference frame.
struct Sample {
  Vector3d point;
  Vector3d normal;
  double weight = 0.0;  ///< 1 / (sigma n d)^2; 0: ignored
  bool grazes = false;
};

/// The inputs for reading a return.
class Returns {
 public:
  Returns(const Frame& frame, const Beams& beams, const FisherOptions& options)
      : frame_(frame),
        beams_(beams),
        options_(options),
        reference_from_sensor_(options.sensor_from_reference.inverse()) {}

  [[nodiscard]] Sample at(std::size_t beam) const {
    Sample sample;
    if (frame_.status[beam] != Status::hit) return sample;
    if (options_.instance && frame_.ground_truth.instance[beam] != *options_.instance)
      return sample;
    const Vector3d& direction = beams_.directions[beam];
    const Vector3d normal = frame_.ground_truth.normal[beam].cast<double>();
    const double cosine = normal.dot(direction);
    if (std::isnan(cosine)) return sample;
    sample.grazes = std::abs(cosine) < options_.least_cosine;
    if (sample.grazes) return sample;
    Vector3d point = frame_.ground_truth.range_m[beam] * direction;
    if (!beams_.origins_m.empty()) point += beams_.origins_m[beam];
    sample.point = reference_from_sensor_ * point;
    sample.normal = reference_from_sensor_.linear() * normal;
    const double sigma_m = sigma(beam);
    sample.weight = 1.0 / (sigma_m * sigma_m * cosine * cosine);
    return sample;
  }

 private:
  [[nodiscard]] double sigma(std::size_t beam) const {
    if (frame_.sigma_m.empty()) return options_.sigma_m;
    const double sigma_m = frame_.sigma_m[beam];
    if (sigma_m > 0.0 && std::isfinite(sigma_m)) return sigma_m;
    throw Error({"pose information, sigma",
                 std::to_string(sigma_m) + " m at beam " + std::to_string(beam),
                 "a standard deviation above 0 for every return"});
  }

  const Frame& frame_;
  const Beams& beams_;
  const FisherOptions& options_;
  Pose reference_from_sensor_;
};

/// Counts returns and computes their centroid and their root mean square distance from it.
void survey(const Returns& returns, std::size_t beams, FisherInformation& result) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < beams; ++i) {
    const Sample sample = returns.at(i);
    result.left_out += sample.grazes ? 1 : 0;
    if (sample.weight <= 0.0) continue;
    ++result.returns;
    sum += sample.point;
  }
  if (result.returns == 0) return;
  result.middle_m = sum / static_cast<double>(result.returns);
  double squares = 0.0;
  for (std::size_t i = 0; i < beams; ++i) {
    const Sample sample = returns.at(i);
    if (sample.weight > 0.0) squares += (sample.point - result.middle_m).squaredNorm();
  }
  result.length_m = std::sqrt(squares / static_cast<double>(result.returns));
}

/// Fisher information of displacements about the points' centroid, where rotation and translation
/// are best separated at any distance from the sensor.
Matrix6 information_at_middle(const Returns& returns, std::size_t beams, const Vector3d& middle) {
  Matrix6 sum = Matrix6::Zero();
  for (std::size_t i = 0; i < beams; ++i) {
    const Sample sample = returns.at(i);
    if (sample.weight <= 0.0) continue;
    Vector6 j;
    j << (sample.point - middle).cross(sample.normal), sample.normal;
    sum.selfadjointView<Eigen::Lower>().rankUpdate(j, sample.weight);
  }
  return sum.selfadjointView<Eigen::Lower>();
}

/// Transforms displacements about a point to displacements about the origin: rho = rho_point +
/// point x theta.
Matrix6 origin_from_point(const Vector3d& point) {
  Matrix6 shift = Matrix6::Identity();
  shift.bottomLeftCorner<3, 3>() << 0.0, -point.z(), point.y(), point.z(), 0.0, -point.x(),
      -point.y(), point.x(), 0.0;
  return shift;
}

/// A basis of the space spanned by the columns in which as many components as possible are zero
/// (reduced echelon form with the largest pivots, rotations first): "about x" and "along y" instead
/// of a mixture of both.
Eigen::MatrixXd simplest_basis(Eigen::MatrixXd basis) {
  constexpr double kSmallAngle = 1e-3;  // unit vectors with less rotation are translations
  for (Eigen::Index column = 0; column < basis.cols(); ++column) {
    Eigen::Index row = 0;
    Eigen::Index from = 0;
    const Eigen::MatrixXd rest = basis.rightCols(basis.cols() - column).cwiseAbs();
    if (rest.topRows<3>().maxCoeff(&row, &from) < kSmallAngle) rest.maxCoeff(&row, &from);
    basis.col(column).swap(basis.col(column + from));
    basis.col(column) /= basis(row, column);
    for (Eigen::Index other = 0; other < basis.cols(); ++other) {
      if (other != column) basis.col(other) -= basis(row, other) * basis.col(column).eval();
    }
  }
  return basis.colwise().normalized();
}

/// Eigenvalues in decreasing order with their vectors, degenerate ones in their simplest basis.
struct Spectrum {
  Vector6 values;
  Matrix6 vectors;
  Eigen::Index degenerate = 0;  ///< number of degenerate ones, which are the last
};

Spectrum spectrum_of(const Matrix6& scaled) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scaled);
  Spectrum spectrum{.values = solver.eigenvalues().reverse().cwiseMax(0.0),
                    .vectors = solver.eigenvectors().rowwise().reverse()};
  const double min_eigenvalue = kDegenerate * spectrum.values[0];
  for (Eigen::Index k = 5; k >= 0 && !(spectrum.values[k] > min_eigenvalue); --k)
    ++spectrum.degenerate;
  if (spectrum.degenerate > 0) {
    spectrum.vectors.rightCols(spectrum.degenerate) =
        simplest_basis(spectrum.vectors.rightCols(spectrum.degenerate));
  }
  return spectrum;
}

/// The bound in the reference frame; `vectors` are the eigenvectors in it.
void bound_from(const Spectrum& spectrum, const Matrix6& vectors, FisherInformation& result) {
  constexpr double kPart = 1e-6;  // smaller components of a unit displacement are rounding
  for (Eigen::Index k = 0; k < 6 - spectrum.degenerate; ++k) {
    result.covariance += vectors.col(k) * vectors.col(k).transpose() / spectrum.values[k];
  }
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    const double part = vectors.rightCols(spectrum.degenerate).row(axis).norm();
    const double scale = axis < 3 ? 1.0 / result.length_m : 1.0;
    if (spectrum.degenerate > 0 && part > kPart * scale) {
      result.covariance.row(axis).setZero();
      result.covariance.col(axis).setZero();
      result.covariance(axis, axis) = kInfinity;
    }
    result.bound[axis] = std::sqrt(result.covariance(axis, axis));
  }
}

}  // namespace

FisherInformation pose_information(const Frame& frame, const Beams& beams,
                                   const FisherOptions& options) {
  check(frame, beams, options);
  FisherInformation result;
  if (frame.sigma_m.empty()) result.assumed_sigma_m = options.sigma_m;
  const Returns returns(frame, beams, options);
  survey(returns, beams.size(), result);
  if (!(result.length_m > 0.0)) result.length_m = 1.0;  // a single point, or none

  const Matrix6 at_middle = information_at_middle(returns, beams.size(), result.middle_m);
  const Matrix6 shift = origin_from_point(result.middle_m);
  const Matrix6 back = origin_from_point(-result.middle_m);
  result.matrix = back.transpose() * at_middle * back;

  Vector6 unit;  // scales rotations so that they move the points as far as translations
  unit << Vector3d::Constant(1.0 / result.length_m), Vector3d::Ones();
  const Spectrum spectrum = spectrum_of(unit.asDiagonal() * at_middle * unit.asDiagonal());
  const Matrix6 vectors = shift * unit.asDiagonal() * spectrum.vectors;
  bound_from(spectrum, vectors, result);
  for (Eigen::Index k = 0; k < 6; ++k) {
    const Vector6 displacement = vectors.col(k);
    result.directions[static_cast<std::size_t>(k)] = {
        .eigenvalue = spectrum.values[k],
        .degenerate = k >= 6 - spectrum.degenerate,
        .displacement = displacement,
        .words = describe_displacement(displacement, result.length_m)};
  }
  result.condition = spectrum.degenerate > 0 ? kInfinity : spectrum.values[0] / spectrum.values[5];
  return result;
}

}  // namespace glidar
