# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause

# Lets `pip install .` compile only the bindings where the library of the same sources is installed. The version does not
# say that, because it changes only with releases.

# glidar_fingerprint(RESULT ROOT): a hash of the sources of all that is installed.
function(glidar_fingerprint result root)
  set(files ${root}/CMakeLists.txt)
  foreach(folder apps cmake glidar materials models sensors)
    file(GLOB_RECURSE below ${root}/${folder}/*)
    list(APPEND files ${below})
  endforeach()
  list(FILTER files EXCLUDE REGEX "/__pycache__/|~$|\\.(orig|rej|swp)$")
  set(text)
  foreach(file IN LISTS files)
    file(SHA256 ${file} hash)
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${root})
    string(APPEND text "${hash} ${file}\n")
  endforeach()
  string(SHA256 hash "${text}")
  set(${result} ${hash} PARENT_SCOPE)
endfunction()

# glidar_write_same_sources(FILE ROOT): the package file that glidar_find_same_sources() looks for.
function(glidar_write_same_sources file root)
  glidar_fingerprint(hash ${root})
  file(WRITE ${file} "if(NOT GLIDAR_FINGERPRINT STREQUAL ${hash})\n  set(glidar_FOUND OFF)\n  return()\nendif()\n"
                     "include(\${CMAKE_CURRENT_LIST_DIR}/glidarConfig.cmake)\n")
endfunction()

# Finds an installed glidar that was built from these sources, as a static library.
macro(glidar_find_same_sources)
  glidar_fingerprint(GLIDAR_FINGERPRINT ${PROJECT_SOURCE_DIR})
  find_package(glidar QUIET CONFIGS glidarSameSources.cmake)
endmacro()
