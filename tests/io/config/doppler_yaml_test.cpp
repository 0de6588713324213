// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/sensor_document.hpp>
#include <glidar/io/config/sensor_file.hpp>

#include <gtest/gtest.h>
#include <io/yaml_files.hpp>

#include <cmath>

namespace glidar {
namespace {

const std::string kCamera = "optics: {width: 4, height: 2, fov_deg: 20}\n";
const std::string kEvery = "{sigma_m_s: 0.03, signal_sigma_m_s: 0.4, step_m_s: 0.01, max_m_s: 75}";

Doppler doppler(const std::string& map) {
  const TestFolder folder;
  return *load_sensor_file(folder.write("s.yaml", kCamera + "doppler: " + map + "\n")).doppler;
}

TEST(DopplerYaml, IsAbsentUnlessGiven) {
  const TestFolder folder;
  EXPECT_FALSE(load_sensor_file(folder.write("s.yaml", kCamera)).doppler.has_value());
}

TEST(DopplerYaml, GivesEveryNumber) {
  const Doppler read = doppler(kEvery);
  EXPECT_EQ(read.sigma_m_s, 0.03);
  EXPECT_EQ(read.signal_sigma_m_s, 0.4);
  EXPECT_EQ(read.step_m_s, 0.01);
  EXPECT_EQ(read.max_m_s, 75.0);
}

TEST(DopplerYaml, IsExactAndUnlimitedByDefault) {
  const Doppler read = doppler("{}");
  EXPECT_EQ(read.sigma_m_s, 0.0);
  EXPECT_EQ(read.signal_sigma_m_s, 0.0);
  EXPECT_EQ(read.step_m_s, 0.0);
  EXPECT_TRUE(std::isinf(read.max_m_s));
}

TEST(DopplerYaml, ComesBackInTheSidecarAsTheFileSaysIt) {
  const nlohmann::ordered_json reported = write_struct(FieldVisitor::Mode::report, doppler(kEvery));
  EXPECT_EQ(reported.dump(),
            R"({"sigma_m_s":0.03,"signal_sigma_m_s":0.4,"step_m_s":0.01,"max_m_s":75.0})");
}

TEST(DopplerYaml, DocumentsReadBackTheSame) {
  for (const std::string map : {"{}", "{sigma_m_s: 0.1}", kEvery.c_str()}) {
    const TestFolder folder;
    const Sensor first =
        load_sensor_file(folder.write("s.yaml", kCamera + "doppler: " + map + "\n"));
    const std::string document = sensor_document(first);
    const Sensor again = load_sensor_file(folder.write("again.yaml", document));
    ASSERT_TRUE(again.doppler.has_value()) << map;
    EXPECT_EQ(again.doppler->sigma_m_s, first.doppler->sigma_m_s);
    EXPECT_EQ(again.doppler->max_m_s, first.doppler->max_m_s);
    EXPECT_EQ(sensor_document(again), document);
  }
}

class DopplerYamlError : public ::testing::TestWithParam<BadFile> {};

TEST_P(DopplerYamlError, NamesPlaceFieldAndWhatIsAllowed) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", GetParam().content);
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(file); }), GetParam().error);
}

const BadFile kBadFiles[] = {
    {"UnknownKey", kCamera + "doppler: {sigma_m: 3}\n",
     "s.yaml:2:11: doppler.sigma_m: unknown key 'sigma_m'; allowed: sigma_m_s, signal_sigma_m_s, "
     "step_m_s, max_m_s; did you mean 'sigma_m_s'?"},
    {"NegativeSigma", kCamera + "doppler: {sigma_m_s: -1}\n",
     "s.yaml:2:22: doppler.sigma_m_s: -1; allowed: m/s from 0 to 1e6"},
    {"NoLimitAtAll", kCamera + "doppler: {max_m_s: 0}\n",
     "s.yaml:2:20: doppler.max_m_s: 0; allowed: a finite number above 0"},
    {"StepAboveTheLimit", kCamera + "doppler: {step_m_s: 3, max_m_s: 2}\n",
     "s.yaml:2:21: doppler.step_m_s: 3, above max_m_s; allowed: a step of at most max_m_s"},
    {"FalseAlarmsWithoutALimit",
     kCamera + "doppler: {}\nnoise:\n  - {type: false_alarms, rate_hz: 100, far_m: 50}\n",
     "s.yaml:2:10: doppler: no max_m_s beside the noise step 'false_alarms'; allowed: a limit up "
     "to which the velocities of false alarms are uniform; add 'max_m_s: ...' to 'doppler'"},
};

INSTANTIATE_TEST_SUITE_P(All, DopplerYamlError, ::testing::ValuesIn(kBadFiles), bad_file_name);

}  // namespace
}  // namespace glidar
