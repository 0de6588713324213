// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>

#include <glidar/core/text.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace glidar {
namespace {

/// The parts hold names and words of files.
ErrorParts printable(const ErrorParts& parts) {
  return {.where = printable_line(parts.where),
          .found = printable_line(parts.found),
          .allowed = printable_line(parts.allowed),
          .remedy = printable_line(parts.remedy)};
}

std::string sentence(const ErrorParts& parts) {
  std::string text = parts.where.empty() ? parts.found : parts.where + ": " + parts.found;
  if (!parts.allowed.empty()) text += "; allowed: " + parts.allowed;
  if (!parts.remedy.empty()) text += "; " + parts.remedy;
  return text;
}

/// Optimal string alignment distance: insertions, deletions, substitutions and transpositions of
/// neighbours (Damerau 1964), with three rows.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_previous(b.size() + 1);
  std::vector<std::size_t> previous(b.size() + 1);
  std::vector<std::size_t> current(b.size() + 1);
  std::iota(previous.begin(), previous.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    current[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = previous[j] + (a[i] == b[j] ? 0U : 1U);
      current[j + 1] = std::min({substituted, previous[j + 1] + 1, current[j] + 1});
      const bool exchanged = i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j];
      if (exchanged) current[j + 1] = std::min(current[j + 1], before_previous[j - 1] + 1);
    }
    std::swap(before_previous, previous);
    std::swap(previous, current);
  }
  return previous[b.size()];
}

/// True when one is the other with more words ("range", "range_m"), or when the candidate begins
/// with the word and the word has at least kPrefix letters: shorter prefixes match too much.
bool is_extension(std::string_view word, std::string_view candidate) {
  constexpr std::size_t kPrefix = 3;
  const bool is_longer = candidate.size() > word.size();
  const std::string_view shorter = is_longer ? word : candidate;
  const std::string_view longer = is_longer ? candidate : word;
  if (shorter.empty() || !longer.starts_with(shorter) || longer.size() == shorter.size())
    return false;
  return longer[shorter.size()] == '_' || (is_longer && shorter.size() >= kPrefix);
}

/// True when the word is one of the candidate's words ("deg" of "fov_deg").
bool is_word_of(std::string_view word, std::string_view candidate) {
  constexpr std::size_t kWord = 3;
  return word.size() >= kWord && candidate.ends_with(word) && candidate.size() > word.size() &&
         candidate[candidate.size() - word.size() - 1] == '_';
}

/// The dissimilarity of two words: 2 per edit, 3 where one begins or ends with the other; empty if
/// they are not similar.
std::optional<std::size_t> dissimilarity(std::string_view word, std::string_view candidate) {
  constexpr std::size_t kExtension = 3;
  // One edit of one letter, or two of three, give an unrelated word. So do two edits of up to five
  // letters if they change the first.
  const std::size_t few = word.size() <= 1 ? 0 : 1;
  const std::size_t max = word.size() <= 3 ? few : std::max<std::size_t>(2, word.size() / 3);
  const std::size_t distance = edit_distance(word, candidate);
  const bool is_short = word.size() <= 5 && distance > 1;
  const bool is_near = distance <= max && !(is_short && !candidate.starts_with(word.front()));
  if (is_near && distance <= 1) return 2 * distance;
  if (is_extension(word, candidate) || is_word_of(word, candidate)) return kExtension;
  return is_near ? std::optional(2 * distance) : std::nullopt;
}

struct Synonym {
  std::string_view word;
  std::string_view term;
};

/// Words of other programs for GLIDAR's terms. Of several terms, the first that is a candidate.
constexpr std::array kSynonyms = {Synonym{"color", "colour"},
                                  Synonym{"colors", "colours"},
                                  Synonym{"center", "centre"},
                                  Synonym{"gray", "grey"},
                                  Synonym{"label", "class"},
                                  Synonym{"labels", "class"},
                                  Synonym{"category", "class"},
                                  Synonym{"semantic", "class"},
                                  Synonym{"color", "diffuse"},
                                  Synonym{"reflectance", "diffuse"},
                                  Synonym{"albedo", "diffuse"},
                                  Synonym{"color", "materials"},
                                  Synonym{"colour", "materials"},
                                  Synonym{"texture", "materials"},
                                  Synonym{"reflectance", "materials"},
                                  Synonym{"file", "model"},
                                  Synonym{"filename", "model"},
                                  Synonym{"mesh", "model"},
                                  Synonym{"path", "model"},
                                  Synonym{"uri", "model"},
                                  Synonym{"objects", "models"},
                                  Synonym{"instances", "models"},
                                  Synonym{"meshes", "models"},
                                  Synonym{"rpy", "euler_deg"},
                                  Synonym{"quaternion", "orientation"},
                                  Synonym{"quat", "orientation"},
                                  Synonym{"translation", "position"},
                                  Synonym{"location", "position"},
                                  Synonym{"xyz", "position"},
                                  Synonym{"position", "pose"},
                                  Synonym{"orientation", "pose"},
                                  Synonym{"rotation", "pose"},
                                  Synonym{"translation", "pose"},
                                  Synonym{"location", "pose"},
                                  Synonym{"xyz", "pose"},
                                  Synonym{"rpy", "pose"},
                                  Synonym{"pose", "sensor-pose"},
                                  Synonym{"frames", "duration"},
                                  Synonym{"fps", "rate"},
                                  Synonym{"fps", "rate_hz"},
                                  Synonym{"frequency", "rate_hz"},
                                  Synonym{"version", "--version"}};

/// The text with the term instead of the word, which has no letters beside it; empty: it does
/// not have the word.
std::string with_term(std::string_view text, const Synonym& synonym) {
  const std::size_t at = text.find(synonym.word);
  if (at == std::string_view::npos) return "";
  const std::size_t end = at + synonym.word.size();
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  if (at > 0 && is_letter(text[at - 1])) return "";
  if (end < text.size() && is_letter(text[end])) return "";
  return std::string(text.substr(0, at)).append(synonym.term).append(text.substr(end));
}

/// The candidate that other programs call by the word; empty: none.
std::string synonym_of(std::string_view word, std::span<const std::string> candidates) {
  for (const Synonym& synonym : kSynonyms) {
    const std::string term = with_term(word, synonym);
    if (!term.empty() && std::find(candidates.begin(), candidates.end(), term) != candidates.end())
      return term;
  }
  return "";
}

}  // namespace

Error::Error(const ErrorParts& parts)
    : std::runtime_error(sentence(printable(parts))), parts_(printable(parts)) {}

std::string number_text(double value) {
  std::array<char, 32> text{};  // the longest double has 24 characters
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

void require_number(bool holds, const char* where, double found, const char* allowed) {
  if (!holds) {
    throw Error({.where = where, .found = number_text(found), .allowed = allowed});
  }
}

std::string closest_match(std::string_view word, std::span<const std::string> candidates) {
  constexpr std::size_t kMaxWord_bytes = 100;  // the time is the product of both lengths
  if (word.size() > kMaxWord_bytes) return "";
  const std::string wanted = lower_case(word);
  std::string best = synonym_of(wanted, candidates);
  if (!best.empty()) return best;
  std::size_t min = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : candidates) {
    if (wanted.empty()) break;
    const std::optional<std::size_t> difference = dissimilarity(wanted, lower_case(candidate));
    if (!difference || *difference >= min) continue;
    min = *difference;
    best = candidate;
  }
  return best;
}

}  // namespace glidar
