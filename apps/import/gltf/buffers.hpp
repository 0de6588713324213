// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/gltf/document.hpp>

#include <cstddef>
#include <functional>
#include <map>
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
  /// The document must outlive it.
  Buffers(const Document& document, OpenFile open) : document_(document), open_(std::move(open)) {}

  /// The buffer view that `index` names. The bytes last as long as this object.
  View view(const Value& index);

 private:
  std::string_view whole(const Value& index);
  std::string_view data_of(const Value& buffer, std::size_t number);
  std::string_view part(const Value& index, const Value& object);

  const Document& document_;
  OpenFile open_;
  std::map<std::size_t, std::string> from_uris_;
  std::map<std::string, std::string> decompressed_;  ///< of the view with this path
};

}  // namespace glidar::import::gltf
