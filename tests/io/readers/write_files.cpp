// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// Writes the fixture's cloud in every format into the folder given, for readers_test.py.
#include <glidar/io/formats/cloud_layout.hpp>

#include <io/cloud_fixture.hpp>

#include <cstdio>
#include <exception>

namespace glidar {
namespace {

/// The layouts, and the columns they are made of, in every format that takes columns.
void write_layouts(CloudFixture made, const std::filesystem::path& folder) {
  fixture::add_scan_columns(made.cloud);
  std::vector<std::string> layouts = {""};
  for (const PointFieldLayout& layout : cloud_layouts()) layouts.push_back(layout.name);
  for (const std::string& layout : layouts) {
    const auto write = [&](const char* name, const FileSinkOptions& with) {
      FileSinkOptions options = with;
      options.layout = layout;
      write_cloud(made, folder / ((layout.empty() ? "scan" : layout) + name), options);
    };
    for (const char* name : {".pcd", ".ply", ".npz", ".csv"}) write(name, {});
    write("_ascii.pcd", {.pcd = PcdEncoding::ascii});
    write("_compressed.pcd", {.pcd = PcdEncoding::binary_compressed});
    write("_ascii.ply", {.ply_ascii = true});
    write("_dense.pcd", {.drop_invalid = true});
    write("_dense.npz", {.drop_invalid = true});
  }
}

void write_all(const CloudFixture& made, const std::filesystem::path& folder) {
  FileSinkOptions ascii;
  ascii.pcd = PcdEncoding::ascii;
  ascii.ply_ascii = true;
  FileSinkOptions compressed;
  compressed.pcd = PcdEncoding::binary_compressed;
  CloudFixture full = made;
  fixture::add_image_columns(full.cloud);
  for (const FileFormat& format : file_formats()) {
    if (!format.missing.empty()) continue;  // an optional library is not installed
    FileSinkOptions options;
    if (format.suffix == ".range.png") options.depth_png_units_per_m = 1.0;  // up to 60 km
    write_cloud(format.takes_more ? made : full, folder / ("a" + format.suffix), options);
  }
  write_layouts(made, folder);
  write_cloud(made, folder / "ascii.pcd", ascii);
  write_cloud(made, folder / "ascii.ply", ascii);
  write_cloud(made, folder / "compressed.pcd", compressed);
  for (FileSinkOptions options : {FileSinkOptions{}, ascii, compressed}) {
    options.drop_invalid = true;
    const std::string name = "dense" + std::to_string(static_cast<int>(options.pcd));
    for (const char* suffix : {".pcd", ".ply", ".npz", ".csv"})
      write_cloud(made, folder / (name + suffix), options);
  }
}

}  // namespace
}  // namespace glidar

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: glidar_io_files FOLDER\n", stderr);
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    for (const char* sub : {"small", "large", "one", "none"})
      std::filesystem::create_directories(folder / sub);
    glidar::write_all(glidar::make_fixture(), folder / "small");
    glidar::write_all(glidar::make_fixture(300, 200), folder / "large");
    glidar::write_all(glidar::make_fixture(1, 1), folder / "one");
    auto none = glidar::make_fixture(2, 2);
    for (glidar::Column& column : none.cloud.columns) {
      if (auto* values = std::get_if<std::vector<double>>(&column.values))
        std::fill(values->begin(), values->end(), std::nan(""));
    }
    glidar::write_all(none, folder / "none");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
