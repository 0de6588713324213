// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <utility>
#include <vector>

namespace glidar {
namespace {

std::string sentence(const ErrorParts& parts) {
  std::string text = parts.where.empty() ? parts.found : parts.where + ": " + parts.found;
  if (!parts.allowed.empty()) text += "; allowed: " + parts.allowed;
  if (!parts.remedy.empty()) text += "; " + parts.remedy;
  return text;
}

/// Levenshtein distance with two rows.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> previous(b.size() + 1);
  std::vector<std::size_t> current(b.size() + 1);
  std::iota(previous.begin(), previous.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    current[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = previous[j] + (a[i] == b[j] ? 0U : 1U);
      current[j + 1] = std::min({substituted, previous[j + 1] + 1, current[j] + 1});
    }
    std::swap(previous, current);
  }
  return previous[b.size()];
}

}  // namespace

Error::Error(ErrorParts parts) : std::runtime_error(sentence(parts)), parts_(std::move(parts)) {}

std::string number_text(double value) {
  std::array<char, 32> text{};  // the longest double takes 24
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

void require_number(bool holds, const char* where, double found, const char* allowed) {
  if (!holds) {
    throw Error({.where = where, .found = number_text(found), .allowed = allowed, .remedy = ""});
  }
}

std::string nearest_word(std::string_view word, std::span<const std::string> candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace glidar
