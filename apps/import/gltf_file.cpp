// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf_file.hpp>

#include <cstdint>
#include <cstring>

namespace glidar::import {
namespace {

constexpr std::size_t kFileHead = 12;
constexpr std::size_t kChunkHead = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F'534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E'4942;  // "BIN"

bool is_binary(std::string_view file) {
  return file.size() >= kFileHead + kChunkHead && file.starts_with("glTF");
}

std::uint32_t number_at(std::string_view file, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, file.data() + at, sizeof value);
  return value;
}

void append(std::string& file, std::uint32_t value) {
  file.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::string_view gltf_json(std::string_view file) {
  if (!is_binary(file)) return file;
  return file.substr(kFileHead + kChunkHead, number_at(file, kFileHead));
}

std::string_view gltf_chunks_after_json(std::string_view file) {
  if (!is_binary(file)) return {};
  const std::size_t end = kFileHead + kChunkHead + number_at(file, kFileHead);
  return end < file.size() ? file.substr(end) : std::string_view{};
}

std::string_view gltf_binary_chunk(std::string_view file) {
  const std::string_view chunk = gltf_chunks_after_json(file);
  if (chunk.size() < kChunkHead || number_at(chunk, 4) != kBinaryChunk) return {};
  return chunk.substr(kChunkHead, number_at(chunk, 0));
}

std::string with_json(std::string_view file, const nlohmann::json& json) {
  std::string text = json.dump();
  if (!is_binary(file)) return text;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string_view rest = gltf_chunks_after_json(file);
  std::string whole(file.substr(0, 8));
  append(whole, static_cast<std::uint32_t>(kFileHead + kChunkHead + text.size() + rest.size()));
  append(whole, static_cast<std::uint32_t>(text.size()));
  append(whole, kJsonChunk);
  whole += text;
  whole += rest;
  return whole;
}

}  // namespace glidar::import
