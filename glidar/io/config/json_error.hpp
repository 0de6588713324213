// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the library. No types of nlohmann's library: with its diagnostics it has others.

#include <string>
#include <string_view>

namespace glidar {

/// An exception of nlohmann's library, by its `id` and `what()`, in plain words: where the text is
/// not valid JSON, which key is missing, or which value has another type. Quotes at most
/// kMaxExcerpt_bytes of the file.
std::string json_error_text(int id, std::string_view what);

/// Whether such an exception means text that is no JSON at all: a damaged file.
bool is_json_syntax_error(int id);

}  // namespace glidar
