// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::import {

/// Reads Wavefront material files (MTL) into the materials of a model:
///  - Kd: diffuse, white without it; Ka: ambient, the diffuse colour without it or if it is black;
///  - Ks and Ns: specular colour and exponent, 0..128; none with illum 0 or 1;
///  - d, Tr: opacity;
///  - map_Kd, map_Ks, map_d; norm or map_Kn: normals; bump or map_bump: heights. Of their options,
///    -s, -o, -bm and -clamp are used: u' = s u + o.
/// Everything else is named in a note.
class MtlReader {
 public:
  explicit MtlReader(SourceModel& source) : source_(source) {}

  /// `name`: of the file, for messages.
  void read(std::string_view file, const std::string& name);

  /// The index of a material of this name, as a model names it, with a comment after it; "": of
  /// faces without a material. Adds a white one, with a note, if the files have none.
  std::size_t number_of(const std::string& name);

  /// Adds the notes.
  void finish();

 private:
  struct Entry {
    std::size_t number = 0;
    bool has_ambient = false;
    bool has_diffuse = false;
    int illumination = 2;
  };

  void begin_material(std::string_view name);
  void read_statement(std::string_view keyword, std::string_view text);
  bool read_map(const std::string& keyword, std::string_view text);
  void read_colour(std::string_view text, const std::string& keyword, Eigen::Vector3f& colour,
                   bool& is_given);
  void read_number(std::string_view text, const std::string& keyword, float& number, float most);
  void note_line(const std::string& what);

  SourceModel& source_;
  std::map<std::string, Entry> entries_;
  Entry* current_ = nullptr;
  std::string file_;
  std::uint64_t line_ = 0;
  std::set<std::string> unused_;          ///< keywords and options
  std::set<std::size_t> has_normal_map_;  ///< materials
  std::string missing_;                   ///< names of materials
};

}  // namespace glidar::import
