// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/own_readers.hpp>

#include <import/text_cursor.hpp>

#include <glidar/core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace glidar::import {
namespace {

constexpr const char* kRepair = "repair the file, or export the model again";
constexpr std::size_t kSniffed = std::size_t{1} << 12U;

bool is_ply(std::string_view head) {
  return head.starts_with("ply") && head.find_first_of("\r\n") == 3;
}

/// Recognises files of other names by their first statement.
Reader reader_of_content(std::string_view head) {
  std::string storage;
  head = utf8_text(head, storage);
  if (is_ply(head)) return read_ply;
  TextCursor text(head, false, true);
  if (!text.find_word()) return nullptr;
  const std::string first = lower_case(text.word());
  if (first == "off" || first == "coff" || first == "noff" || first == "stoff") return read_off;
  if (first == "solid") return read_stl;
  if (first == "mtllib" || (first == "v" && number_in(text.word()))) return read_obj;
  return nullptr;
}

}  // namespace

std::string_view ReaderInput::bytes() const {
  return content().whole();
}

TextCursor ReaderInput::text(std::string& storage, bool continues) const {
  constexpr std::size_t kMarked = 4;  // bytes of a byte order mark and a character
  const std::string_view head = content().head(kMarked);
  const std::string_view text = utf8_text(head, storage);
  if (!storage.empty()) return {utf8_text(bytes(), storage), continues, true};
  return {content(), head.size() - text.size(), continues, true};
}

std::shared_ptr<FileContent> ReaderInput::companion(const std::string& name) const {
  std::string forward = name;
  std::replace(forward.begin(), forward.end(), '\\', '/');
  Access access = Access::absent;
  std::vector<std::string> names = {name, forward, forward.substr(forward.rfind('/') + 1)};
  for (const std::string& tried : names) {
    if (tried.empty()) continue;
    const ConfinedFile file = confine(tried, folder);
    if (file.access != Access::granted) {
      add_once(log.absent, (folder.folder / tried).string());
      if (access == Access::absent) access = file.access;
      continue;
    }
    auto content = files.content(file.path.string());
    if (content == nullptr) {
      add_once(log.notes, fmt::format("'{}' cannot be opened", shown(name)));
    } else if (access == Access::outside) {
      add_once(log.notes, fmt::format("'{}' is outside the model's folder: '{}' is read instead",
                                      shown(name), shown(tried)));
    }
    return content;
  }
  add_once(log.notes, fmt::format("'{}' is not read: {}", shown(name), reason(access)));
  return nullptr;
}

Reader own_reader(const ReaderInput& input) {
  static const std::array<std::pair<const char*, Reader>, 4> kReaders = {
      {{".obj", read_obj}, {".ply", read_ply}, {".stl", read_stl}, {".off", read_off}}};
  const std::string_view head = input.files.content(input.model.string())->head(kSniffed);
  if (is_ply(head)) return read_ply;
  const std::string extension = lower_case(input.model.extension().string());
  for (const auto& [name, reader] : kReaders) {
    if (extension == name) return reader;
  }
  return reader_of_content(head);
}

void refuse_line(std::uint64_t line, const std::string& found) {
  throw Refusal{fmt::format("line {}: {}", line, found), kRepair};
}

void refuse_byte(std::size_t byte, const std::string& found) {
  throw Refusal{fmt::format("byte {}: {}", byte, found), kRepair};
}

}  // namespace glidar::import
