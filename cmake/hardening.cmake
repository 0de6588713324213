# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause

# What makes memory errors harder to exploit, in every optimised build without sanitizers.
# scripts/check_binaries.py looks for it in what was built.
option(GLIDAR_HARDENING "Harden what is built: checked copies, stack protector, read-only relocations" ON)

include(CheckCXXCompilerFlag)
include(CheckPIESupported)

# glidar_harden(TARGET SCOPE): adds the options to a target, for itself (PRIVATE) or its users (INTERFACE).
function(glidar_harden target scope)
  if(NOT GLIDAR_HARDENING OR CMAKE_BUILD_TYPE STREQUAL "Debug")
    return()
  endif()
  # -U: some compilers define another level by default
  set(options -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3)
  foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection=full)
    string(MAKE_C_IDENTIFIER "GLIDAR_KNOWS${flag}" known)
    check_cxx_compiler_flag(${flag} ${known})
    if(${known})
      list(APPEND options ${flag})
    endif()
  endforeach()
  target_compile_options(${target} ${scope} ${options})
  target_link_options(${target} ${scope} -Wl,-z,relro,-z,now,-z,noexecstack)
endfunction()

if(GLIDAR_HARDENING)
  check_pie_supported(LANGUAGES CXX)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
