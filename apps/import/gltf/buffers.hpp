// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/gltf/document.hpp>

#include <glidar/io/files/input_file.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace glidar::import::gltf {

/// Bytes of a file beside the model, which last as long as the model is read. Throws Refusal.
using OpenFile = std::function<std::string_view(const std::string& uri)>;

struct View {
  std::string_view bytes;
  std::size_t stride = 0;  ///< bytes from element to element; 0: packed
};

/// The buffers of a document: its own chunk, data URIs, files; decompressed views.
class Buffers {
 public:
  /// Document and budget must outlive it.
  Buffers(const Document& document, OpenFile open, InputBudget& budget)
      : document_(document), open_(std::move(open)), budget_(budget) {}

  /// The buffer view that `index` names. The bytes last as long as this object.
  View view(const Value& index);

  /// Counts what is made of the document, before memory is used for it: a small document can name
  /// the same bytes very often. Throws Refusal with the path of what is too much for its size.
  void take(Budget what, std::uint64_t amount, const std::string& path);

 private:
  std::string_view file_content(const std::string& uri);
  std::string_view whole(const Value& index);
  std::string_view data_of(const Value& buffer, std::size_t number);
  std::string_view part(const Value& index, const Value& object);

  const Document& document_;
  OpenFile open_;
  InputBudget& budget_;
  std::set<std::string> opened_;  ///< URIs of files
  std::map<std::size_t, std::string> from_uris_;
  std::map<std::string, std::string> decompressed_;  ///< of the view with this path
};

}  // namespace glidar::import::gltf
