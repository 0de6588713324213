// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/instruction_set.hpp>

#include <glidar/core/error.hpp>

#include <cstdlib>
#include <string>

namespace glidar {

const char* to_string(InstructionSet set) {
  if (set == InstructionSet::avx512) return "avx512";
  return set == InstructionSet::avx2 ? "avx2" : "baseline";
}

std::vector<InstructionSet> usable_instruction_sets() {
  std::vector<InstructionSet> usable = {InstructionSet::baseline};
#ifdef __x86_64__
  const bool has_avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
                        __builtin_cpu_supports("bmi") != 0 && __builtin_cpu_supports("bmi2") != 0;
  if (has_avx2) usable.push_back(InstructionSet::avx2);
  const bool has_avx512 =
      __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
      __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512bw") != 0;
  if (has_avx2 && has_avx512) usable.push_back(InstructionSet::avx512);
#endif
  return usable;
}

InstructionSet find_instruction_set(std::string_view name) {
  const std::vector<InstructionSet> usable = usable_instruction_sets();
  if (name.empty()) return usable.back();
  std::string names;
  for (const InstructionSet set : usable) {
    if (name == to_string(set)) return set;
    names += (names.empty() ? "" : ", ") + std::string(to_string(set));
  }
  throw Error({"environment variable GLIDAR_ISA",
               "this processor has no kernel '" + std::string(name) + "'", names,
               "unset the variable; results do not depend on it"});
}

InstructionSet select_instruction_set() {
  const char* name = std::getenv("GLIDAR_ISA");
  return find_instruction_set(name == nullptr ? "" : name);
}

}  // namespace glidar
