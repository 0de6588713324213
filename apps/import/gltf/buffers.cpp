// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf/buffers.hpp>

#include <import/gltf/data_uri.hpp>
#include <import/gltf/meshopt.hpp>

#include <fmt/format.h>

#include <utility>

namespace glidar::import::gltf {

void Buffers::take(Budget what, std::uint64_t amount, const std::string& path) {
  if (budget_.try_take(what, amount)) return;
  refuse(path, budget_.excess(what), "the file is damaged or malicious");
}

std::string_view Buffers::file_content(const std::string& uri) {
  const std::string_view content = open_(uri);
  if (opened_.insert(uri).second) budget_.add_input(content.size());
  return content;
}

std::string_view Buffers::data_of(const Value& buffer, std::size_t number) {
  const Value uri = buffer["uri"];
  if (!uri) {
    if (number == 0 && document_.has_chunk) return document_.chunk;
    buffer.refuse("it has no data: neither a URI nor a binary chunk");
  }
  const std::string text = uri.text();
  if (!is_data_uri(text)) return file_content(text);
  const auto [known, is_new] = from_uris_.try_emplace(number);
  if (is_new) {
    auto content = data_uri_content(text);
    if (!content) uri.refuse("the data URI is malformed");
    known->second = std::move(*content);
  }
  return known->second;
}

/// The bytes of the buffer that `index` names.
std::string_view Buffers::whole(const Value& index) {
  const Value buffer = document_.target("buffers", index);
  const Value length = buffer.required("byteLength");
  const std::string_view data = data_of(buffer, index.count());
  if (length.count() > data.size()) {
    length.refuse(fmt::format("{} bytes, its data has {}: cut off", length.count(), data.size()));
  }
  return data.substr(0, length.count());
}

/// The part of a buffer that an object states by buffer, byteOffset and byteLength.
std::string_view Buffers::part(const Value& index, const Value& object) {
  const std::string_view buffer = whole(index);
  const std::size_t offset = object["byteOffset"].count_or(0);
  const std::size_t length = object.required("byteLength").count();
  if (offset > buffer.size() || length > buffer.size() - offset) {
    object.refuse(
        fmt::format("bytes {} to {} of a buffer of {}", offset, offset + length, buffer.size()));
  }
  return buffer.substr(offset, length);
}

View Buffers::view(const Value& index) {
  const Value view = document_.target("bufferViews", index);
  const std::size_t stride = view["byteStride"].count_or(0);
  if (view["byteStride"] && stride == 0) view["byteStride"].refuse("0 bytes");
  const Value extension = view.extension(kMeshoptExtension);
  if (!extension) return {part(view.required("buffer"), view), stride};
  const auto [known, is_new] = decompressed_.try_emplace(view.path());
  if (is_new) {
    const std::string_view compressed = part(extension.required("buffer"), extension);
    const MeshoptLayout layout = meshopt_layout(extension, compressed.size());
    take(Budget::held_bytes, layout.count * layout.stride, extension.path());
    known->second = decode_meshopt(extension, layout, compressed);
    const Value length = view.required("byteLength");
    if (length.count() != known->second.size()) {
      length.refuse(fmt::format("{} bytes, its compressed data has {}", length.count(),
                                known->second.size()));
    }
  }
  return {known->second, stride};
}

}  // namespace glidar::import::gltf
