// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar {

/// Properties of a noise step that do not follow from its functions. A step that has any of them
/// declares `static constexpr StepTraits kTraits`.
struct StepTraits {
  bool reads_depth = false;
  bool reads_incidence = false;
  bool adds_returns = false;
  /// Its prepare() stores random numbers alone, so no columns of the frame are loaded for it.
  bool prepares_without_columns = false;
};

}  // namespace glidar
