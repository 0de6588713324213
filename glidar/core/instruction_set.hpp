// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace glidar {

/// What inner loops are compiled for: any processor, or AVX2 or AVX-512 of x86-64. Every result has
/// the same bits for all of them.
enum class InstructionSet : std::uint8_t { baseline, avx2, avx512 };

/// "baseline", "avx2" or "avx512".
const char* to_string(InstructionSet set);

/// Those that this processor can run, the fastest last.
std::vector<InstructionSet> usable_instruction_sets();

/// The usable one of that name; empty: the fastest. Throws Error if the processor cannot run it.
InstructionSet find_instruction_set(std::string_view name);

/// The fastest usable one, or that of the environment variable GLIDAR_ISA. Throws Error if the
/// processor cannot run that one.
InstructionSet select_instruction_set();

}  // namespace glidar
