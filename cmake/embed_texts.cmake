# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause

# glidar_embed_texts(OUTPUT_VARIABLE HEADER FUNCTION files...): writes a source file that defines
# FUNCTION (declared in HEADER), which gives the text of each file by its name, and puts its path
# into the variable. So the program needs no such files to run.
function(glidar_embed_texts output header function)
  set(entries)
  foreach(file IN LISTS ARGN)
    cmake_path(GET file FILENAME name)
    file(READ ${file} text)
    string(APPEND entries "    {\"${name}\", R\"embedded(${text})embedded\"},\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  endforeach()
  string(REPLACE "::" "_" stem ${function})
  set(path ${CMAKE_CURRENT_BINARY_DIR}/${stem}.cpp)
  file(CONFIGURE OUTPUT ${path} @ONLY CONTENT [[
#include <@header@>

#include <map>
#include <string_view>

std::string_view @function@(std::string_view file) {
  static const std::map<std::string_view, std::string_view> texts = {
@entries@  };
  return texts.at(file);
}
]])
  set(${output} ${path} PARENT_SCOPE)
endfunction()

# glidar_embed_bytes(OUTPUT_VARIABLE HEADER FUNCTION FILE): the same for the bytes of one file.
function(glidar_embed_bytes output header function file)
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes ${bytes})
  string(REGEX REPLACE "(................................................................................)"
                       "\\1\n" bytes ${bytes})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  string(REPLACE "::" "_" stem ${function})
  set(path ${CMAKE_CURRENT_BINARY_DIR}/${stem}.cpp)
  file(CONFIGURE OUTPUT ${path} @ONLY CONTENT [[
#include <@header@>

std::span<const unsigned char> @function@() {
  static constexpr unsigned char kBytes[] = {
@bytes@};
  return kBytes;
}
]])
  set(${output} ${path} PARENT_SCOPE)
endfunction()
