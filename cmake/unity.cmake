# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause

# Unity builds as CMAKE_UNITY_BUILD makes them, but with paths relative to the project, so that a compiler cache
# serves every clone and every build folder.

# glidar_compile_together(TARGET GROUP...): compiles the sources of each group, separated by commas, as one. Sources with
# options or definitions of their own stay apart.
function(glidar_compile_together target)
  get_target_property(folder ${target} BINARY_DIR)
  set(number 0)
  foreach(group IN LISTS ARGN)
    string(REPLACE "," ";" members "${group}")
    set(includes)
    set(together)
    foreach(source IN LISTS members)
      set(own)
      foreach(property COMPILE_OPTIONS COMPILE_DEFINITIONS SKIP_UNITY_BUILD_INCLUSION)
        get_source_file_property(value ${source} TARGET_DIRECTORY ${target} ${property})
        if(value)
          list(APPEND own ${value})
        endif()
      endforeach()
      if(NOT own)
        cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE path)
        string(APPEND includes "#include \"${path}\"\n")
        list(APPEND together ${source})
      endif()
    endforeach()
    if(together)  # also one alone, which another target of the folder may compile with others
      file(CONFIGURE OUTPUT ${folder}/unity/${target}_${number}.cpp CONTENT "${includes}" @ONLY)
      set_source_files_properties(${together} TARGET_DIRECTORY ${target} PROPERTIES HEADER_FILE_ONLY ON)
      target_sources(${target} PRIVATE ${folder}/unity/${target}_${number}.cpp)
    endif()
    math(EXPR number "${number} + 1")
  endforeach()
endfunction()

# glidar_unity_build(SIZE FOLDER...): up to SIZE neighbouring sources of every target of these folders as one.
function(glidar_unity_build size)
  foreach(folder IN LISTS ARGN)
    get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target IN LISTS targets)
      get_target_property(sources ${target} SOURCES)
      list(FILTER sources INCLUDE REGEX "^${PROJECT_SOURCE_DIR}/.*\\.cpp$")
      set(groups)
      while(sources)
        list(SUBLIST sources 0 ${size} group)
        list(REMOVE_ITEM sources ${group})
        string(REPLACE ";" "," group "${group}")
        list(APPEND groups "${group}")
      endwhile()
      glidar_compile_together(${target} ${groups})
    endforeach()
  endforeach()
endfunction()

# glidar_group_sources(SIZE TARGET...): up to SIZE sources of each target as one: those that do not define the same names.
function(glidar_group_sources size)
  find_program(PYTHON3_PROGRAM python3 REQUIRED)
  foreach(target IN LISTS ARGN)
    get_target_property(folder ${target} SOURCE_DIR)
    get_target_property(sources ${target} SOURCES)
    list(TRANSFORM sources PREPEND ${folder}/ REGEX "^[^/]")
    list(FILTER sources INCLUDE REGEX "^${PROJECT_SOURCE_DIR}/.*\\.cpp$")
    execute_process(COMMAND ${PYTHON3_PROGRAM} -B ${PROJECT_SOURCE_DIR}/scripts/source_groups.py ${size} ${sources}
                    OUTPUT_VARIABLE groups OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX REPLACE ";" "," groups "${groups}")
    string(REPLACE "\n" ";" groups "${groups}")
    glidar_compile_together(${target} ${groups})
    # a source that newly defines a name of its neighbour needs another group
    set_property(DIRECTORY ${folder} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${sources})
  endforeach()
endfunction()
