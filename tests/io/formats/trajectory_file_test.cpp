// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/trajectory_file.hpp>

#include "io/yaml_files.hpp"

#include <clocale>

namespace glidar {
namespace {

TimedPoses load_text(const std::string& content, const TrajectoryFileOptions& options = {}) {
  const TestFolder folder;
  return load_trajectory_file(folder.write("t.txt", content), options);
}

TEST(TrajectoryFile, TumHasThePositionThenTheQuaternionWithWLast) {
  const TimedPoses poses = load_text(
      "# timestamp tx ty tz qx qy qz qw\n"
      "\n"
      "1.5 1 2 3 0.6 0 0 0.8\r\n"
      "  2.5\t4 5 +6 0 0 1 0  # half a turn\n");
  ASSERT_EQ(poses.poses().size(), 2U);
  EXPECT_EQ(poses.first_ns(), 1'500'000'000);
  EXPECT_EQ(poses.poses()[0].position_m, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(poses.poses()[0].orientation.x(), 0.6);
  EXPECT_EQ(poses.poses()[0].orientation.w(), 0.8);
  EXPECT_EQ(poses.poses()[1].orientation.z(), 1.0);
  EXPECT_EQ(poses.poses()[1].position_m.z(), 6.0);
}

TEST(TrajectoryFile, TimesAreExactToTheNanosecond) {
  // EuRoC's first ground truth; a double of this size has steps of 238 ns
  EXPECT_EQ(load_text("1403636580.838555574 0 0 0 0 0 0 1\n").first_ns(),
            1'403'636'580'838'555'574);
  EXPECT_EQ(load_text("-0.000000001 0 0 0 0 0 0 1\n").first_ns(), -1);
  EXPECT_EQ(load_text("0.0000000015 0 0 0 0 0 0 1\n").first_ns(), 2);
  EXPECT_EQ(load_text("1.5e-3 0 0 0 0 0 0 1\n").first_ns(), 1'500'000);
  EXPECT_EQ(load_text("7 0 0 0 0 0 0 1").first_ns(), 7'000'000'000);
  EXPECT_EQ(load_text(".25 0 0 0 0 0 0 1").first_ns(), 250'000'000);
}

TEST(TrajectoryFile, CsvNamesItsColumnsInAnyOrder) {
  const TimedPoses poses = load_text(
      "\xEF\xBB\xBFqw, qx,qy,qz ,t,z,y,x\n"
      "0.8,0.6,0,0, 3 ,30,20,10\n"
      "1,0,0,0,4,0,0,0\n");
  EXPECT_EQ(poses.first_ns(), 3'000'000'000);
  EXPECT_EQ(poses.poses()[0].position_m, Eigen::Vector3d(10.0, 20.0, 30.0));
  EXPECT_EQ(poses.poses()[0].orientation.w(), 0.8);
}

TEST(TrajectoryFile, EurocNamesItsColumnsInACommentAndHasNanoseconds) {
  const char* const kRow = "1403636580838555648,4.6,-1.7,0.7,0.53,-0.15,-0.83,-0.08";
  const std::string others = ",0.1,0.2,0.3,0,0,0,0,0,0\n";
  for (const std::string& content :
       {"#timestamp,p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n" + std::string(kRow),
        "# timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
        "q_RS_y [], q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], "
        "b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], "
        "b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\r\n" +
            std::string(kRow) + others,
        "timestamp [ns],x,y,z,qw,qx,qy,qz\n" + std::string(kRow), std::string(kRow),
        "# without names\n" + std::string(kRow) + others}) {
    const TimedPoses poses = load_text(content);
    ASSERT_EQ(poses.poses().size(), 1U);
    const TimedPose& pose = poses.poses()[0];
    EXPECT_EQ(pose.t_ns, 1'403'636'580'838'555'648);
    EXPECT_EQ(pose.position_m, Eigen::Vector3d(4.6, -1.7, 0.7));
    const Eigen::Quaterniond wxyz(0.53, -0.15, -0.83, -0.08);
    EXPECT_LT((pose.orientation.coeffs() - wxyz.normalized().coeffs()).norm(), 1e-15);
  }
}

TEST(TrajectoryFile, ATimestampInSecondsHasItsUnit) {
  EXPECT_EQ(load_text("timestamp [s],x,y,z,qw,qx,qy,qz\n1.403636580838555574e+09,0,0,0,1,0,0,0\n")
                .first_ns(),
            1'403'636'580'838'555'574);
}

TEST(TrajectoryFile, KittiPosesAreRowsOfAMatrix) {
  // a quarter turn about z: x goes to y
  const std::string rows = "1 0 0 5 0 1 0 6 0 0 1 7\n0 -1 0 1 1 0 0 2 0 0 1 3\n";
  const TimedPoses poses = load_text(rows, {.rate_hz = 10.0});
  EXPECT_EQ(poses.first_ns(), 0);
  EXPECT_EQ(poses.last_ns(), 100'000'000);
  EXPECT_EQ(poses.pose_at(0).translation(), Eigen::Vector3d(5.0, 6.0, 7.0));
  const Pose last = poses.pose_at(100'000'000);
  EXPECT_LT((last * Eigen::Vector3d::UnitX() - Eigen::Vector3d(1.0, 3.0, 3.0)).norm(), 1e-15);
}

TEST(TrajectoryFile, KittiTimesAreReadFromAnotherFile) {
  const TestFolder folder;
  const auto times = folder.write("times.txt", "0.000000e+00\n1.036000e-01\n");
  const auto file = folder.write("00.txt", "1 0 0 5 0 1 0 6 0 0 1 7\n1 0 0 1 0 1 0 2 0 0 1 3\n");
  EXPECT_EQ(load_trajectory_file(file, {.times_file = times}).last_ns(), 103'600'000);
  const auto more = folder.write("more.txt", "0\n1\n2\n");
  EXPECT_EQ(error_of(folder, [&] { load_trajectory_file(file, {.times_file = more}); }),
            "00.txt: 2 poses; allowed: one per time; more.txt has 3");
  const auto fewer = folder.write("fewer.txt", "0\n");
  EXPECT_EQ(error_of(folder, [&] { load_trajectory_file(file, {.times_file = fewer}); }),
            "00.txt:2:1: pose 2; allowed: one per time; fewer.txt has 1");
  const auto back = folder.write("back.txt", "0\n0\n");
  EXPECT_EQ(error_of(folder, [&] { load_trajectory_file(file, {.times_file = back}); }),
            "back.txt:2:1: a time not after the one before; allowed: times that increase");
}

TEST(TrajectoryFile, StartShiftsAllTimes) {
  const TimedPoses poses = load_text("100 0 0 0 0 0 0 1\n101.5 0 0 0 0 0 0 1\n", {.start_ns = 7});
  EXPECT_EQ(poses.first_ns(), 7);
  EXPECT_EQ(poses.last_ns(), 1'500'000'007);
}

TEST(TrajectoryFile, NumbersDoNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) std::setlocale(LC_ALL, name);
  EXPECT_EQ(load_text("1.5 0.25 0 0 0 0 0 1\n").poses()[0].position_m.x(), 0.25);
  std::setlocale(LC_ALL, before.c_str());
}

class BadTrajectory : public ::testing::TestWithParam<BadFile> {};

TEST_P(BadTrajectory, IsReportedWithLocationAndRemedy) {
  const TestFolder folder;
  const auto file = folder.write("t", GetParam().content);
  EXPECT_EQ(error_of(folder, [&] { load_trajectory_file(file); }), GetParam().error);
}

const std::string kGood = "0 0 0 0 0 0 0 1\n";
const std::string kNames =
    "t, x, y, z, qw, qx, qy, qz, each once, in any order, or the names of EuRoC files";

const std::string kNoNames =
    "numbers in the first row, which names the columns of CSV files; allowed: a row of names; "
    "without it, rows of EuRoC files: nanoseconds with 16 digits or more, x, y, z, qw, qx, qy, qz, "
    "8 or 17 columns; add the row 't,x,y,z,qx,qy,qz,qw', in the order of the columns";

const BadFile kBadTrajectories[] = {
    {"Empty", "", "t: no pose; allowed: at least one; see docs/files.md"},
    {"OnlyComments", "# a\n\n", "t: no pose; allowed: at least one; see docs/files.md"},
    {"OnlyAHeader", "t,x,y,z,qx,qy,qz,qw\n",
     "t: no pose; allowed: at least one; see docs/files.md"},
    {"SevenColumns", "0 0 0 0 0 0 1\n",
     "t:1:1: 7 columns; allowed: 8 (TUM: t x y z qx qy qz qw), 12 (KITTI), or names with commas "
     "between (CSV)"},
    {"SevenColumnsLater", kGood + "1 0 0 0 0 0 1\n", "t:2:13: 7 columns; allowed: 8 in every row"},
    {"NineColumnsLater", kGood + "1 0 0 0 0 0 0 1 4\n",
     "t:2:17: 9 columns; allowed: 8 in every row"},
    {"AWord", kGood + "1 0 abc 0 0 0 0 1\n", "t:2:5: 'abc'; allowed: a finite number"},
    {"NotANumber", kGood + "1 0 0 0 0 nan 0 1\n", "t:2:11: 'nan'; allowed: a finite number"},
    {"Infinity", kGood + "1 0 0 0 0 0 0 inf\n", "t:2:15: 'inf'; allowed: a finite number"},
    {"Overflow", kGood + "1 1e999 0 0 0 0 0 1\n", "t:2:3: '1e999'; allowed: a finite number"},
    {"DecimalComma", kGood + "1 0.5x 0 0 0 0 0 1\n", "t:2:3: '0.5x'; allowed: a finite number"},
    {"TimeGoesBack", "5 0 0 0 0 0 0 1\n# c\n 4 0 0 0 0 0 0 1\n",
     "t:3:2: a time before that of the previous pose; allowed: increasing times"},
    {"TimeTwice", kGood + kGood,
     "t:2:1: the same time as the previous pose; allowed: increasing times"},
    {"TimeInNanoseconds", "1403636580838555574 0 0 0 0 0 0 1\n",
     "t:1:1: '1403636580838555574'; allowed: seconds from -9.2e9 to 9.2e9; nanoseconds are "
     "allowed in CSV files with a column 'timestamp [ns]'"},
    {"QuaternionOfZeros", "0 1 2 3 0 0 0 0\n",
     "t:1:9: a quaternion of length 0.000000; allowed: length 1 to within 0.01"},
    {"QuaternionTooLong", kGood + "1 0 0 0 0 0 0.2 1\n",
     "t:2:9: a quaternion of length 1.019804; allowed: length 1 to within 0.01"},
    {"PositionTooFar", "0 1e16 2 3 0 0 0 1\n",
     "t:1:3: a position that is not finite or too large; allowed: coordinates up to 1e15 m"},
    {"UnknownColumn", "t,x,y,z,qx,qy,qz,w\n",
     "t:1:18: the column 'w'; allowed: " + kNames + "; the first row names the columns"},
    {"CsvOfSecondsWithoutNames", "1403636580.838555574,0,0,0,1,0,0,0\n", "t:1:1: " + kNoNames},
    {"CsvOfShortTimesWithoutNames", "140363658083855,0,0,0,1,0,0,0\n", "t:1:1: " + kNoNames},
    {"CsvOfNegativeTimesWithoutNames", "-1403636580838555648,0,0,0,1,0,0,0\n",
     "t:1:1: " + kNoNames},
    {"CsvOfPositionsWithoutNames", "1403636580838555648,0,0,0\n", "t:1:1: " + kNoNames},
    {"EurocRowTooShort", "1403636580838555648,0,0,0,1,0,0,0\n1403636580838555649,0,0,0,1,0,0\n",
     "t:2:31: 7 columns; allowed: 8 in every row"},
    {"EurocTimeInSeconds", "1403636580838555648,0,0,0,1,0,0,0\n1403636581.5,0,0,0,1,0,0,0\n",
     "t:2:1: '1403636581.5' in a column of nanoseconds; allowed: whole numbers; a column of "
     "seconds is called 't'"},
    {"ColumnTwice", "t,x,y,z,qx,qy,qz,x\n", "t:1:18: the column 'x' again; allowed: " + kNames},
    {"ColumnMissing", "t,x,y,z,qx,qy,qz\n", "t:1:15: no column 'qw'; allowed: " + kNames},
    {"SecondsInNanoseconds", "timestamp,x,y,z,qx,qy,qz,qw\n1.5,0,0,0,0,0,0,1\n",
     "t:2:1: '1.5' in a column of nanoseconds; allowed: whole numbers; a column of seconds is "
     "called "
     "'t'"},
    {"NanosecondsInSeconds", "t,x,y,z,qx,qy,qz,qw\n1403636580838555574,0,0,0,0,0,0,1\n",
     "t:2:1: '1403636580838555574'; allowed: seconds from -9.2e9 to 9.2e9; nanoseconds are allowed "
     "in CSV files with a column 'timestamp [ns]'"},
    {"AnotherUnit", "t [ms],x,y,z,qx,qy,qz,qw\n",
     "t:1:1: the unit [ms] of times; allowed: [s] or [ns]"},
    {"CsvRowTooShort", "t,x,y,z,qx,qy,qz,qw\n1,2,3\n", "t:2:5: 3 columns; allowed: 8 in every row"},
    {"CsvEmptyField", "t,x,y,z,qx,qy,qz,qw\n1,,3,4,0,0,0,1\n",
     "t:2:3: ''; allowed: a finite number"},
    {"KittiWithoutTimes", "1 0 0 0 0 1 0 0 0 0 1 0\n",
     "t: a KITTI file, whose rows have no times; allowed: a rate or a file of times; give one of "
     "them"},
    {"Binary", std::string("0 0\0", 4), "t: binary data; allowed: a trajectory file"},
};

INSTANTIATE_TEST_SUITE_P(All, BadTrajectory, ::testing::ValuesIn(kBadTrajectories), bad_file_name);

TEST(TrajectoryFileErrors, MatricesThatAreNotRotationsAreRejected) {
  const TestFolder folder;
  const auto file = folder.write("k", "1 0 0 0 0 1 0 0 0 0 1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(error_of(folder, [&] { load_trajectory_file(file, {.rate_hz = 10.0}); }),
            "k:2:1: a matrix whose first three columns are not a rotation; allowed: a rotation to "
            "within 0.001");
}

TEST(TrajectoryFileErrors, ARateForAFileWithTimesIsRejected) {
  const TestFolder folder;
  const auto file = folder.write("t", kGood);
  EXPECT_EQ(error_of(folder, [&] { load_trajectory_file(file, {.rate_hz = 10.0}); }),
            "t: a file that has times of its own; allowed: a rate or times with KITTI files only; "
            "omit them");
}

TEST(TrajectoryFileErrors, MissingFilesAreReportedWithTheNearestName) {
  const TestFolder folder;
  (void)folder.write("orbit.tum", kGood);
  EXPECT_EQ(error_of(folder, [&] { load_trajectory_file(folder.path() / "orbt.tum"); }),
            "orbt.tum: no such file; did you mean 'orbit.tum'?");
  EXPECT_EQ(error_of(folder, [&] { load_trajectory_file("/dev/zero"); }),
            "/dev/zero: not a regular file; allowed: a trajectory file");
}

TEST(TrajectoryFileErrors, HugeFilesAndRowsAreRejectedImmediately) {
  const TestFolder folder;
  const auto file = folder.write("huge", kGood);
  std::filesystem::resize_file(file, (std::uintmax_t{512} << 20U) + 1);
  EXPECT_EQ(error_of(folder, [&] { load_trajectory_file(file); }),
            "huge: a file of more than 512 MiB; allowed: a trajectory file of at most 512 MiB; "
            "shorten it, or reduce the number of poses");
  std::string row;
  for (int i = 0; i < 1'000'000; ++i) row += "1 ";
  const auto wide = folder.write("wide", row);
  EXPECT_EQ(error_of(folder, [&] { load_trajectory_file(wide); }).substr(0, 23),
            "wide:1:1: 65 columns; a");
}

}  // namespace
}  // namespace glidar
