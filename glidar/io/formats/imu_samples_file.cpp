// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/imu_samples_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/json_numbers.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/npz_archive.hpp>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <iterator>
#include <vector>

namespace glidar {
namespace {

using Json = nlohmann::ordered_json;
using Vectors = ImuSamples::Vectors;

constexpr std::string_view kCsv = ".imu.csv";
constexpr std::string_view kNpz = ".imu.npz";

/// Three columns of CSV files and one array of NPZ files.
struct VectorColumn {
  const char* name;
  const char* unit;
  const char* text;
  const Vectors& (*values)(const ImuSamples&);
};

constexpr std::array<VectorColumn, 7> kVectors = {{
    {"gyro", "rad/s", "measured angular velocity, axes of the IMU",
     [](const ImuSamples& s) -> const Vectors& { return s.angular_velocity_rad_s; }},
    {"accel", "m/s^2", "measured specific force, axes of the IMU; at rest +9.81 upwards",
     [](const ImuSamples& s) -> const Vectors& { return s.specific_force_m_s2; }},
    {"true_gyro", "rad/s", "true angular velocity, axes of the IMU",
     [](const ImuSamples& s) -> const Vectors& { return s.ground_truth.angular_velocity_rad_s; }},
    {"true_accel", "m/s^2", "true specific force, axes of the IMU",
     [](const ImuSamples& s) -> const Vectors& { return s.ground_truth.specific_force_m_s2; }},
    {"gyro_bias", "rad/s", "bias of the gyroscopes",
     [](const ImuSamples& s) -> const Vectors& { return s.ground_truth.gyroscope_bias_rad_s; }},
    {"accel_bias", "m/s^2", "bias of the accelerometers",
     [](const ImuSamples& s) -> const Vectors& { return s.ground_truth.accelerometer_bias_m_s2; }},
    {"velocity", "m/s", "true velocity of the IMU in the world",
     [](const ImuSamples& s) -> const Vectors& { return s.ground_truth.velocity_m_s; }},
}};

void write_csv(const ImuSamples& samples, AtomicFile& file) {
  file.write(imu_csv_header() + "\n");
  fmt::memory_buffer line;
  for (std::size_t i = 0; i < samples.t_ns.size(); ++i) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "{}", samples.t_ns[i]);
    for (const VectorColumn& column : kVectors) {
      const Eigen::Vector3d& v = column.values(samples)[i];
      fmt::format_to(std::back_inserter(line), ",{},{},{}", v.x() + 0.0, v.y() + 0.0,
                     v.z() + 0.0);  // no sign of zeros
    }
    const PoseVector pose = to_xyz_wxyz(samples.ground_truth.world_from_imu[i]);
    for (const double number : pose) fmt::format_to(std::back_inserter(line), ",{}", number + 0.0);
    line.push_back('\n');
    file.write(std::string_view(line.data(), line.size()));
  }
}

void write_npz(const ImuSamples& samples, AtomicFile& file) {
  const std::size_t count = samples.t_ns.size();
  std::vector<NpzArray> arrays;
  arrays.push_back(npz_array("t_ns", {count}, std::span(samples.t_ns)));
  for (const VectorColumn& column : kVectors) {
    static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
    const Vectors& values = column.values(samples);
    const double* first = values.empty() ? nullptr : values.front().data();
    arrays.push_back(npz_array(column.name, {count, 3}, std::span(first, 3 * count)));
  }
  using RowMajor4d = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  std::vector<double> poses;
  poses.reserve(16 * count);
  for (const Pose& pose : samples.ground_truth.world_from_imu) {
    const RowMajor4d matrix = pose.matrix();
    poses.insert(poses.end(), matrix.data(), matrix.data() + 16);
  }
  arrays.push_back(npz_array("world_from_imu", {count, 4, 4}, std::span<const double>(poses)));
  write_npz_archive(arrays, file);
}

template <class Matrix>
Json rows_json(const Matrix& matrix) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    Json numbers = Json::array();
    for (Eigen::Index col = 0; col < matrix.cols(); ++col) numbers.push_back(matrix(row, col));
    rows.push_back(std::move(numbers));
  }
  return rows;
}

Json columns_json() {
  Json columns = {{"t_ns", {{"unit", "ns"}, {"text", "time of the sample"}}}};
  for (const VectorColumn& column : kVectors) {
    columns[column.name] = {{"unit", column.unit}, {"text", column.text}};
  }
  columns["world_from_imu"] = {
      {"unit", "m"}, {"text", "true pose; in CSV position x y z and quaternion qw qx qy qz"}};
  return columns;
}

}  // namespace

bool is_imu_samples_path(const std::filesystem::path& path) {
  const std::string name = lower_case(path.filename().string());
  return (name.size() > kCsv.size() && name.ends_with(kCsv)) ||
         (name.size() > kNpz.size() && name.ends_with(kNpz));
}

std::string imu_samples_suffixes() {
  return std::string(kCsv) + " " + std::string(kNpz);
}

std::string imu_csv_header() {
  std::string header = "t_ns";
  for (const VectorColumn& column : kVectors) {
    for (const char* axis : {"_x", "_y", "_z"}) header += std::string(",") + column.name + axis;
  }
  return header + ",x,y,z,qw,qx,qy,qz";
}

std::string imu_description_json(const ImuDescription& description) {
  const ImuRun& run = description.run;
  const ImuConstants constants = imu_constants(description.imu, run);
  Json json = {{"glidar", version()},
               {"name", description.name},
               {"imu", write_struct(FieldVisitor::Mode::report, description.imu)},
               {"rig_from_imu", rows_json(description.rig_from_imu.matrix())},
               {"seed", run.seed},
               {"imu_number", run.imu},
               {"start_ns", run.start_ns},
               {"gravity_m_s2", vector_json(run.gravity_m_s2)},
               {"gyroscope_matrix", rows_json(constants.gyroscope_matrix)},
               {"accelerometer_matrix", rows_json(constants.accelerometer_matrix)},
               {"turn_on_gyroscope_bias_rad_s", vector_json(constants.gyroscope_bias_rad_s)},
               {"turn_on_accelerometer_bias_m_s2", vector_json(constants.accelerometer_bias_m_s2)},
               {"columns", columns_json()}};
  remove_negative_zeros(json);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_imu_samples(const ImuSamples& samples, const ImuDescription& description,
                       const std::filesystem::path& path, std::span<const std::string> read) {
  if (!is_imu_samples_path(path)) {
    throw Error({path.string(), "the name has no suffix of IMU samples", imu_samples_suffixes()});
  }
  StagedFiles files;
  files.protect(read);
  AtomicFile& file = files.add(path);
  const bool is_csv = lower_case(path.string()).ends_with(kCsv);
  is_csv ? write_csv(samples, file) : write_npz(samples, file);
  file.finish();
  AtomicFile& beside = files.add(path.string() + ".json");
  beside.write(imu_description_json(description));
  beside.finish();
  files.commit();
}

}  // namespace glidar
