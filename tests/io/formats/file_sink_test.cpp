// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/file_sink.hpp>

#include <glidar/core/error.hpp>

#include <io/cloud_fixture.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <filesystem>
#include <thread>

namespace glidar {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(FileFormats, TheLongestSuffixSelectsTheFormat) {
  EXPECT_EQ(format_for("a.png").suffix, ".png");
  EXPECT_EQ(format_for("a.depth.png").suffix, ".depth.png");
  EXPECT_EQ(format_for("a.framebuffer.png").suffix, ".framebuffer.png");
  EXPECT_EQ(format_for("out.d/scan.2.pcd").suffix, ".pcd");
  EXPECT_EQ(format_for("a.range.png").suffix, ".range.png");
  EXPECT_EQ(format_for("scan.0012.png").suffix, ".png");
  EXPECT_EQ(format_for("scan.v2.npy").suffix, ".npy");
  EXPECT_EQ(format_for("scan.dept.pcd").suffix, ".pcd");
  EXPECT_EQ(format_for("A.PCD").suffix, ".pcd");
}

TEST(FileFormats, AnUnknownSuffixIsReportedWithAllSuffixesAndTheNearest) {
  const std::string text = error_text([] { format_for("a.pdc"); });
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("no format has the suffix .pdc"), HasSubstr("did you mean .pcd?"),
            HasSubstr(".pcd .ply .npz .csv .las .bin .kitti .npy .depth.npy .range.npy "
                      ".depth.png .range.png "
                      ".framebuffer.png .png .transform .bev.png .view.png .depth.tiff .rgb.png "
                      ".normal.png .instance.png .class.png .exr")));
  EXPECT_THAT(error_text([] { format_for("cloud"); }), HasSubstr("the name has no suffix"));
  EXPECT_THAT(error_text([] { format_for("out/.pcd"); }), HasSubstr("the name has no suffix"));
}

TEST(FormatFor, RefusesUnknownKindsOfImagesInsteadOfWritingAPicture) {
  EXPECT_THAT(error_text([] { format_for("a.dept.png"); }),
              AllOf(HasSubstr("no format has the suffix .dept.png; allowed: "),
                    HasSubstr(" .range.png "), HasSubstr("did you mean .depth.png?")));
  EXPECT_THAT(error_text([] { format_for("a.label.png"); }), HasSubstr("mean .class.png?"));
  EXPECT_THAT(error_text([] { format_for("a.Rnage.npy"); }), HasSubstr("mean .range.npy?"));
  EXPECT_THAT(error_text([] { format_for("my.boulders.png"); }),
              HasSubstr("use another character than the dot"));
  EXPECT_EQ(format_for("rock.obj.png").suffix, ".png");
  EXPECT_EQ(format_for("run.v.png").suffix, ".png");
}

TEST(FileSink, RejectsInvalidPathsImmediately) {
  const testing::TestFolder folder;
  const CloudFixture made = make_fixture();
  const SidecarContext context = made.context();
  const auto make = [&](const std::filesystem::path& path) {
    return error_text([&] { make_file_sink(path, {}, context); });
  };
  EXPECT_THAT(make(folder / "none/a.pcd"), HasSubstr("there is no folder"));
  std::filesystem::create_directory(folder / "folder.pcd");
  EXPECT_THAT(make(folder / "folder.pcd"), HasSubstr("is a folder"));
  FileSinkOptions options;
  options.depth_png_units_per_m = 0.0;
  EXPECT_THROW(make_file_sink(folder / "a.depth.png", options, context), Error);
}

TEST(FileSink, RefusesNamesOfColumnsThatHeadersAndArchivesCannotHave) {
  const testing::TestFolder folder;
  for (const char* suffix : {".npz", ".ply", ".pcd", ".csv", ".las"}) {
    for (const char* name : {"../evil", "a\nelement face 9", "=cmd|x,\"", "a b", "\u00E9", ""}) {
      CloudFixture made = make_fixture();
      made.cloud.columns.push_back({name, {"a"}, std::vector<float>(made.cloud.size())});
      const std::string path = (folder / ("a" + std::string(suffix))).string();
      EXPECT_THAT(error_text([&] { write_cloud(made, path); }), HasSubstr("letters, digits and _"));
      std::swap(made.cloud.columns.back().name, made.cloud.columns.back().components[0]);
      EXPECT_THAT(error_text([&] { write_cloud(made, path); }), HasSubstr("letters, digits and _"));
    }
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(FileSink, RefusesTwoFieldsOfOneName) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  made.cloud.columns.push_back({"a", {"x"}, std::vector<float>(made.cloud.size())});
  EXPECT_THAT(error_text([&] { write_cloud(made, folder / "a.ply"); }),
              HasSubstr("two fields 'x'"));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(FileSink, TrailingSeparatorsOfAFolderAreIgnored) {
  const testing::TestFolder folder;
  EXPECT_EQ(format_for("out.kitti/").suffix, ".kitti");
  EXPECT_EQ(output_path("x/out.kitti//"), "x/out.kitti");
  EXPECT_EQ(output_path("x/out.kitti"), "x/out.kitti");
  const CloudFixture made = make_fixture();
  for (int time = 0; time < 2; ++time) {
    write_cloud(made, (folder / "out.kitti").string() + "/");
    EXPECT_THAT(folder.names(), ElementsAre("out.kitti"));
    EXPECT_TRUE(std::filesystem::exists(folder / "out.kitti/velodyne/000000.bin"));
  }
}

TEST(FileSink, ATrailingSeparatorOfAFileIsAnError) {
  const testing::TestFolder folder;
  const CloudFixture made = make_fixture();
  EXPECT_THAT(
      error_text([&] { write_cloud(made, (folder / "a.pcd").string() + "/"); }),
      AllOf(HasSubstr("a.pcd/: is the name of a folder"), HasSubstr("remove the trailing")));
  EXPECT_THAT(error_text([] { format_for("/"); }), HasSubstr("the name has no suffix"));
}

/// Runs as an ordinary user, whom permissions stop; true where that is possible.
template <class Work>
bool as_ordinary_user(const Work& work) {
  constexpr uid_t kNobody = 65534;
  const bool is_root = ::geteuid() == 0;
  if (is_root && ::seteuid(kNobody) != 0) return false;
  work();
  return !is_root || ::seteuid(0) == 0;
}

TEST(FileSink, AFolderNeedsItsOwnWritePermissionOnly) {
  namespace fs = std::filesystem;
  const testing::TestFolder folder;
  const CloudFixture made = make_fixture();
  const SidecarContext context = made.context();
  fs::create_directories(folder / "in/x.kitti");
  constexpr auto kReadable = fs::perms{0555};
  fs::permissions(folder.path(), fs::perms::all);
  fs::permissions(folder / "in/x.kitti", fs::perms::all);
  fs::permissions(folder / "in", kReadable);
  std::string refused_parent;
  std::string refused_folder;
  const bool done = as_ordinary_user([&] {
    EXPECT_EQ(error_text([&] { write_cloud(made, folder / "in/x.kitti"); }), "no error");
    refused_parent = error_text([&] { make_file_sink(folder / "in/new.kitti", {}, context); });
  });
  fs::permissions(folder / "in", fs::perms::all);
  fs::permissions(folder / "in/x.kitti", kReadable);
  as_ordinary_user([&] {
    refused_folder = error_text([&] { make_file_sink(folder / "in/x.kitti", {}, context); });
  });
  fs::permissions(folder / "in/x.kitti", fs::perms::all);
  if (!done) GTEST_SKIP() << "cannot become an ordinary user; run it without a user namespace";
  EXPECT_THAT(refused_parent, HasSubstr("cannot be written to"));
  EXPECT_THAT(refused_folder, HasSubstr("x.kitti cannot be written to"));
}

/// The fixture with classes; ids of instances are in the cloud already.
CloudFixture with_classes() {
  CloudFixture made = make_fixture();
  made.scene.class_names.emplace_back("rock");
  made.scene.instances[0].class_id = 1;
  fixture::add_image_columns(made.cloud);
  return made;
}

TEST(FileSink, LabelsOfAnEarlierCloudAreRemoved) {
  const testing::TestFolder folder;
  CloudFixture labelled = with_classes();
  write_cloud(labelled, folder / "a.bin", {.sidecar = false});
  EXPECT_THAT(folder.names(), ElementsAre("a.bin", "a.label"));
  const CloudFixture plain = make_fixture();
  const SidecarContext context = plain.context();
  make_file_sink(folder / "a.bin", {.sidecar = false}, context)->stage(plain.cloud, plain.frame);
  EXPECT_THAT(folder.names(), ElementsAre("a.bin", "a.label")) << "not before commit()";
  write_cloud(plain, folder / "a.bin", {.sidecar = false});
  EXPECT_THAT(folder.names(), ElementsAre("a.bin"));
  std::filesystem::create_directory(folder / "a.label");
  write_cloud(plain, folder / "a.bin", {.sidecar = false});
  EXPECT_THAT(folder.names(), ElementsAre("a.bin", "a.label")) << "a folder is none of ours";

  write_cloud(labelled, folder / "a.kitti");
  labelled.frame.number = 1;
  write_cloud(labelled, folder / "a.kitti");
  write_cloud(plain, folder / "a.kitti");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.kitti/labels/000000.label"));
  EXPECT_TRUE(std::filesystem::exists(folder / "a.kitti/labels/000001.label"));
}

TEST(FileSink, WritesCloudAndSidecarAndNothingElse) {
  const testing::TestFolder folder;
  write_cloud(make_fixture(), folder / "a.pcd");
  EXPECT_THAT(folder.names(), ElementsAre("a.glidar.json", "a.pcd"));
}

TEST(FileSink, PreviewsAndPosesHaveNoSidecar) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  fixture::add_image_columns(made.cloud);
  for (const char* name : {"a.png", "a.framebuffer.png", "a.transform", "a.bev.png", "a.view.png"})
    write_cloud(made, folder / name);
  EXPECT_EQ(folder.names().size(), 5U);
}

TEST(FileSink, SidecarsOfImagesDescribeThePixels) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  made.sensor.optics = Pinhole{
      {.width = 5, .height = 4, .fx = 10.0, .fy = 11.0, .cx = 2.5, .cy = 2.0, .pixel_centre = 0.5},
      RadialTangential{.k1 = 0.25, .p1 = 0.5, .k3 = 0.125}};
  fixture::add_image_columns(made.cloud);
  for (const char* name : {"a.npy", "a.depth.png", "a.depth.tiff", "a.rgb.png", "a.normal.png",
                           "a.instance.png", "a.class.png", "a.exr"}) {
    if (!format_for(name).missing.empty()) continue;
    write_cloud(made, folder / name, {.depth_png_units_per_m = 2000.0});
    const auto reported = nlohmann::json::parse(file_bytes(folder / "a.glidar.json"));
    EXPECT_EQ(reported.at("files").at(0).at("file"), name);
    EXPECT_FALSE(reported.at("files").at(0).at("image").at("pixels").get<std::string>().empty())
        << name;
    const auto& info = reported.at("sensor").at("camera_info");
    EXPECT_EQ(info.at("k"), nlohmann::json::parse("[10.0,0.0,2.0, 0.0,11.0,1.5, 0.0,0.0,1.0]"));
    EXPECT_EQ(info.at("d"), nlohmann::json::parse("[0.25,0.0,0.5,0.0,0.125]"));
    EXPECT_EQ(info.at("distortion_model"), "plumb_bob");
  }
  const auto all = nlohmann::json::parse(file_bytes(folder / "a.glidar.json"));
  EXPECT_GE(all.at("files").size(), 7U);  // of the same frame
  for (const auto& file : all.at("files")) {
    if (file.at("file") == "a.depth.png") {
      EXPECT_EQ(file.at("image").at("units_per_m"), 2000.0);
    }
  }
}

TEST(FileSink, AnInstanceIdThatDoesNotFitIsAnErrorWithARemedy) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  for (const std::uint32_t id : {0U, 65536U}) {
    for (Column& column : made.cloud.columns) {
      if (column.name == "instance") std::get<std::vector<std::uint32_t>>(column.values)[0] = id;
    }
    EXPECT_THAT(error_text([&] { write_cloud(made, folder / "a.instance.png"); }),
                AllOf(HasSubstr("allowed: ids from 1 to 65535"), HasSubstr("set 'id'")));
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(FileSink, StagedFilesAppearOnlyOnCommit) {
  const testing::TestFolder folder;
  const CloudFixture made = make_fixture();
  const SidecarContext context = made.context();
  {
    const auto sink = make_file_sink(folder / "a.kitti", {}, context);
    sink->stage(made.cloud, made.frame);
    EXPECT_TRUE(std::filesystem::is_directory(folder / "a.kitti/calib"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.kitti/calib/000000.txt"));
  }
  EXPECT_THAT(folder.names(), IsEmpty());
  const auto sink = make_file_sink(folder / "a.pcd", {}, context);
  sink->stage(made.cloud, made.frame);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.pcd"));
  sink->commit();  // without a sidecar, which the caller stages for all files of the frame
  EXPECT_THAT(folder.names(), ElementsAre("a.pcd"));
}

TEST(FileSink, TheSidecarCanBeOmitted) {
  const testing::TestFolder folder;
  FileSinkOptions options;
  options.sidecar = false;
  write_cloud(make_fixture(), folder / "a.ply", options);
  EXPECT_THAT(folder.names(), ElementsAre("a.ply"));
}

TEST(FileSink, AMissingColumnIsAnErrorThatLeavesNoFile) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  drop_column(made.cloud, "intensity");
  const std::string text = error_text([&] { write_cloud(made, folder / "a.bin"); });
  EXPECT_THAT(text, AllOf(HasSubstr("a.bin: the cloud has no column intensity"),
                          HasSubstr("allowed: .bin needs xyz intensity"),
                          HasSubstr("it has: xyz depth normal")));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(FileSink, AColumnOfWrongSizeOrTypeIsAnError) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  made.cloud.columns[0].values = std::vector<double>(59, 0.0);
  EXPECT_THAT(error_text([&] { write_cloud(made, folder / "a.pcd"); }),
              HasSubstr("column xyz has 59 numbers; allowed: 60"));
  made.cloud.columns[0].values = std::vector<float>(60, 0.0F);
  EXPECT_THAT(error_text([&] { write_cloud(made, folder / "a.pcd"); }),
              HasSubstr("column xyz has another type; allowed: three doubles per point"));
}

TEST(FileSink, AnErrorLeavesTheOldFilesUnchanged) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  write_cloud(made, folder / "a.pcd");
  const std::string cloud = file_bytes(folder / "a.pcd");
  const std::string sidecar = file_bytes(folder / "a.glidar.json");
  std::filesystem::remove(folder / "a.glidar.json");
  std::filesystem::create_directory(folder / "a.glidar.json");
  made.cloud.frame_id = "another";
  EXPECT_THROW(write_cloud(made, folder / "a.pcd"), Error);
  EXPECT_EQ(file_bytes(folder / "a.pcd"), cloud);
  EXPECT_THAT(folder.names(), ElementsAre("a.glidar.json", "a.pcd"));
}

TEST(FileSink, TheSameCloudGivesTheSameBytesInEveryFormat) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture(60, 70);
  CloudFixture other = make_fixture(31, 17);
  FileSinkOptions options;
  options.pcd = PcdEncoding::binary_compressed;
  options.depth_png_units_per_m = 10.0;  // the fixture has ranges of kilometres
  fixture::add_image_columns(made.cloud);
  fixture::add_image_columns(other.cloud);
  for (const FileFormat& format : file_formats()) {
    if (format.is_folder) continue;  // of several files
    write_cloud(made, folder / ("a" + format.suffix), options);
    write_cloud(other, folder / ("between" + format.suffix), options);
    write_cloud(made, folder / ("b" + format.suffix), options);
    EXPECT_EQ(file_bytes(folder / ("a" + format.suffix)),
              file_bytes(folder / ("b" + format.suffix)))
        << format.suffix;
  }
}

/// What is reported when a cloud whose first coordinate and depth are these is written.
std::string warnings_of(const char* name, double x_m, double depth_m) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  std::get<std::vector<double>>(made.cloud.columns[0].values)[0] = x_m;
  std::get<std::vector<double>>(made.cloud.columns[2].values)[0] = depth_m;
  std::string reported;
  const Report report{[&reported](Severity severity, std::string_view text) {
                        EXPECT_EQ(severity, Severity::warning);
                        reported += text;
                      },
                      {}};
  const SidecarContext context = made.context();
  make_file_sink(folder / name, {}, context, report)->write(made.cloud, made.frame);
  return reported;
}

TEST(FileSink, PointsMovedByRoundingAreReportedWithDistanceAndRemedy) {
  // Floats near 10 km are 0.977 mm apart.
  EXPECT_THAT(warnings_of("a.bin", 10000.0004, 1.0),
              AllOf(HasSubstr("a.bin: rounding to float32 moves its points by up to 0.0004 m"),
                    HasSubstr("write .npz, .csv or .ply")));
  EXPECT_THAT(warnings_of("a.npy", 1.0, 10000.0004), HasSubstr("its depth by up to 0.0004 m"));
}

TEST(FileSink, RoundingBelowATenthOfAMillimetreCausesNoWarning) {
  for (const char* name : {"a.bin", "a.npy", "a.pcd"}) {
    EXPECT_EQ(warnings_of(name, 2000.0001, 2000.0001), "") << name;
    EXPECT_EQ(warnings_of(name, 4096.0, 4096.0), "") << name;
    EXPECT_EQ(warnings_of(name, 3000.00005, 3000.00005), "") << name;
  }
  for (const char* name : {"a.ply", "a.npz", "a.csv"})
    EXPECT_EQ(warnings_of(name, 10000.0004, 10000.0004), "") << name;
}

TEST(FileSink, ConcurrentSinksOfOnePathLeaveACompleteFile) {
  const testing::TestFolder folder;
  const CloudFixture small = make_fixture(2, 2);
  const CloudFixture large = make_fixture(200, 200);
  const auto write_often = [&](const CloudFixture& made) {
    for (int i = 0; i < 20; ++i) write_cloud(made, folder / "a.bin");
  };
  std::thread other(write_often, small);
  write_often(large);
  other.join();
  const std::size_t size = file_bytes(folder / "a.bin").size();
  EXPECT_TRUE(size == 3 * 16 || size == std::size_t{200 * 200 - 200 * 200 / 3} * 16) << size;
  EXPECT_THAT(folder.names(), ElementsAre("a.bin", "a.glidar.json"));
}

TEST(FileSink, PathsMayContainSpacesAndAnyCharacters) {
  const testing::TestFolder folder;
  const std::string name = "größe mit leer — 点群 'q\".pcd";
  write_cloud(make_fixture(), folder / name);
  EXPECT_FALSE(file_bytes(folder / name).empty());
  const auto reported = nlohmann::json::parse(file_bytes(sidecar_path(folder / name)));
  EXPECT_EQ(reported.at("files").at(0).at("file"), name);
}

TEST(FileSink, ABareFileNameIsWrittenToTheCurrentFolder) {
  const testing::TestFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  write_cloud(make_fixture(), "a.csv");
  std::filesystem::current_path(before);
  EXPECT_THAT(folder.names(), ElementsAre("a.csv", "a.glidar.json"));
}

TEST(FileSink, FramesWithoutHitsGiveValidDenseFiles) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture(2, 2);
  for (double& value : std::get<std::vector<double>>(made.cloud.columns[0].values))
    value = std::nan("");
  FileSinkOptions options;
  options.drop_invalid = true;
  write_cloud(made, folder / "a.pcd", options);
  EXPECT_THAT(file_bytes(folder / "a.pcd"),
              AllOf(HasSubstr("WIDTH 0\nHEIGHT 1\n"), HasSubstr("POINTS 0\nDATA binary\n")));
  write_cloud(made, folder / "a.ply", options);
  EXPECT_THAT(file_bytes(folder / "a.ply"), HasSubstr("element vertex 0\n"));
  write_cloud(made, folder / "a.bin", options);
  EXPECT_EQ(file_bytes(folder / "a.bin"), "");
}

TEST(FileSink, AsksForRangesOfACameraThatLooksBack) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  made.sensor.optics = Pinhole{};
  made.beams.directions = {-made.beams.boresight};
  drop_column(made.cloud, "range");
  write_cloud(made, folder.path() / "a.exr");
  made.frame.range_m.clear();
  EXPECT_THAT(error_text([&] { write_cloud(made, folder.path() / "b.exr"); }),
              AllOf(HasSubstr("no column range"), HasSubstr("request range too")));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "b.exr"));
}

/// A cloud with firing times, as files of all frames have.
CloudFixture make_run_fixture() {
  CloudFixture made = make_fixture();
  fixture::add_column<std::int64_t>(made.cloud, "stamp", {"stamp"}, [](std::size_t i, std::size_t) {
    return static_cast<std::int64_t>(i);
  });
  return made;
}

TEST(RunFile, OfLasTakesLaterFramesThatAreMuchLargerThanTheFirst) {
  const testing::TestFolder folder;
  CloudFixture made = make_run_fixture();
  const SidecarContext context = made.context();
  RunFile file(folder.path() / "a.las", {}, context);
  EXPECT_GT(file.append(made.cloud, made.frame, made.beams), 0U);  // points within 3 m
  for (double& x_m : std::get<std::vector<double>>(made.cloud.columns[0].values)) x_m += 2e5;
  EXPECT_GT(file.append(made.cloud, made.frame, made.beams), 0U);
  for (double& x_m : std::get<std::vector<double>>(made.cloud.columns[0].values)) x_m += 2e5;
  EXPECT_THAT(error_text([&] { file.append(made.cloud, made.frame, made.beams); }),
              HasSubstr("allowed: 214748.3647 m in each direction"));
}

TEST(RunFile, HasNoPoseIfItsAxesMove) {
  const testing::TestFolder folder;
  CloudFixture made = make_run_fixture();
  const SidecarContext context = made.context();
  const auto pose_after = [&](double step_m) {
    RunFile file(folder.path() / "a.csv", {}, context);
    (void)file.append(made.cloud, made.frame, made.beams);
    made.cloud.world_from_cloud.translation().x() += step_m;
    (void)file.append(made.cloud, made.frame, made.beams);
    return nlohmann::json::parse(file.finish().json)["world_from_cloud"];
  };
  EXPECT_EQ(pose_after(0.0)["position_m"], nlohmann::json({0.0, 0.0, -1.0}));
  EXPECT_TRUE(pose_after(1.0).is_null());
}

}  // namespace
}  // namespace glidar
