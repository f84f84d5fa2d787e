# Compile options of the project's own code, and the functions that make its targets.

# -Wno-restrict: g++ 12 gives this warning for correct uses of std::string (GCC bug 105651).
# -ffp-contract=off: results must not depend on the machine's instruction set, therefore no contraction to FMA.
# CONSTRICTOR_FALSE_ALARMS: g++ 12 gives these warnings for correct uses of std::string at -O3 (GCC bug
# 105329); they would hide the true ones.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  set(CONSTRICTOR_FALSE_ALARMS -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
endif()
add_library(constrictor_options INTERFACE)
target_compile_options(constrictor_options INTERFACE
  $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wpedantic;-Wconversion;-Wshadow>>
  $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast;-Wno-restrict>>
  $<BUILD_INTERFACE:$<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:${CONSTRICTOR_WERROR}>>:-Werror>>
  $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:${CONSTRICTOR_FALSE_ALARMS}>>
  -ffp-contract=off)
target_compile_features(constrictor_options INTERFACE cxx_std_20)
target_link_libraries(constrictor_options INTERFACE fmt::fmt)
target_include_directories(constrictor_options INTERFACE $<INSTALL_INTERFACE:include/constrictor>)
if(CONSTRICTOR_SANITIZE)
  add_compile_options(-fsanitize=${CONSTRICTOR_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${CONSTRICTOR_SANITIZE})
endif()

# The headers that nearly every file includes, compiled once and used by every target: this halves the time of a build.
# Files still include what they use: a build with CONSTRICTOR_PCH=OFF (preset tidy) shows missing includes.
set(CONSTRICTOR_COMMON_HEADERS
  <algorithm> <array> <chrono> <cmath> <cstdint> <cstdio> <filesystem> <functional> <map> <memory> <optional> <set>
  <stdexcept> <string> <string_view> <utility> <vector> <fmt/format.h>)
add_library(constrictor_precompiled OBJECT ${CMAKE_CURRENT_LIST_DIR}/precompiled.cpp)
target_link_libraries(constrictor_precompiled PRIVATE constrictor_options)
target_precompile_headers(constrictor_precompiled PRIVATE ${CONSTRICTOR_COMMON_HEADERS})
# The same for libraries of position-independent code, because g++ refuses headers that were compiled otherwise.
add_library(constrictor_precompiled_pic OBJECT ${CMAKE_CURRENT_LIST_DIR}/precompiled.cpp)
set_target_properties(constrictor_precompiled_pic PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_link_libraries(constrictor_precompiled_pic PRIVATE constrictor_options)
target_precompile_headers(constrictor_precompiled_pic PRIVATE ${CONSTRICTOR_COMMON_HEADERS})
function(constrictor_precompile)
  if(NOT CONSTRICTOR_PCH)
    return()
  endif()
  foreach(target ${ARGN})
    get_target_property(pic ${target} POSITION_INDEPENDENT_CODE)
    if(pic)
      target_precompile_headers(${target} REUSE_FROM constrictor_precompiled_pic)
    else()
      target_precompile_headers(${target} REUSE_FROM constrictor_precompiled)
    endif()
  endforeach()
endfunction()

# constrictor_position_independent(TARGET): the static library can be a part of a shared one, as the Python module
# needs. The option makes the code as fast as without, because no function of it is replaced at run time.
function(constrictor_position_independent target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${target} PRIVATE -fno-semantic-interposition)
  endif()
endfunction()

# constrictor_compile_together(TARGET): up to 16 files of the target are compiled as one, because most of the time goes
# into the headers that all of them include, and into the functions of these headers. Names in the anonymous namespaces
# of such a target must differ.
function(constrictor_compile_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${CONSTRICTOR_UNITY} UNITY_BUILD_BATCH_SIZE 16)
endfunction()

# constrictor_compile_quickly(TARGET...): for programs that wait for people or messages, and for tests. CLI11, JSON and
# GoogleTest compile a third faster at this level, which a user notices at the first build; the speed of these programs
# does not change noticeably.
function(constrictor_compile_quickly)
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
    constrictor_compile_together(${target})
  endforeach()
endfunction()

# constrictor_include_root(RESULT): an include directory that holds the current folder and nothing else. A folder's
# headers are named `robot/...`, `navigation/...` or `sim/world/...`, without `components/`, `lib/` and `tools/`.
# A target that does not link a library therefore cannot include its headers.
function(constrictor_include_root result)
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  string(REGEX REPLACE "^components/((lib|tools)/)?" "" prefix ${folder})
  string(REPLACE "/" "." root ${folder})
  set(root ${PROJECT_BINARY_DIR}/include/${root})
  get_filename_component(parent ${root}/${prefix} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${root}/${prefix} SYMBOLIC)
  set(${result} ${root} PARENT_SCOPE)
endfunction()

# constrictor_git_revision(PROGRAM): the program contains kGitRevision and kGitDate, see runtime/git_revision.hpp.
# Only for programs of a run and of people, because they are linked again after each commit.
set(CONSTRICTOR_GIT_REVISION ${PROJECT_BINARY_DIR}/generated/git_revision.cpp)
add_custom_target(constrictor_git_revision
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DFILE=${CONSTRICTOR_GIT_REVISION}
          -P ${PROJECT_SOURCE_DIR}/scripts/cmake/git_revision.cmake
  BYPRODUCTS ${CONSTRICTOR_GIT_REVISION} COMMENT "")
function(constrictor_git_revision program)
  target_sources(${program} PRIVATE ${CONSTRICTOR_GIT_REVISION})
  # By itself, because it changes with each commit and the other files of the program do not.
  set_source_files_properties(${CONSTRICTOR_GIT_REVISION} PROPERTIES GENERATED ON SKIP_PRECOMPILE_HEADERS ON
                                                                     SKIP_UNITY_BUILD_INCLUSION ON)
  add_dependencies(${program} constrictor_git_revision)
endfunction()

# constrictor_library(NAME [PIC] SOURCES ... LINK ...): a static library of the project, with its folder as its include
# root. PIC: see constrictor_position_independent().
function(constrictor_library name)
  cmake_parse_arguments(ARG "PIC" "" "SOURCES;LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  if(ARG_PIC)
    constrictor_position_independent(${name})
  endif()
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  set_target_properties(${name} PROPERTIES CONSTRICTOR_FOLDER ${folder})
  target_link_libraries(${name} PUBLIC constrictor_options ${ARG_LINK})
  constrictor_include_root(root)
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${root}>)
  constrictor_precompile(${name})
  constrictor_compile_together(${name})
endfunction()

# constrictor_module(NAME SOURCES ... LINK ...): the module NAME.so beside the programs, which load it when they need it
# (configuration/lazy_module.hpp). Its target is NAME_module.
function(constrictor_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(${name}_module MODULE ${ARG_SOURCES})
  set_target_properties(${name}_module PROPERTIES
    PREFIX "" OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
  constrictor_position_independent(${name}_module)
  target_link_libraries(${name}_module PRIVATE ${ARG_LINK})
endfunction()

# constrictor_component(NAME SOURCES ... LINK ...): the library constrictor_NAME with the component's class, and the
# program NAME, made from main.cpp. The header NAME.hpp declares make_NAME_factory(), so that `constrictor_host` can
# make the component, too.
function(constrictor_component name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  constrictor_library(constrictor_${name} SOURCES ${ARG_SOURCES} LINK constrictor_component ${ARG_LINK})
  add_executable(${name} main.cpp)
  target_link_libraries(${name} PRIVATE constrictor_${name} constrictor_runtime)
  constrictor_git_revision(${name})
  constrictor_precompile(${name})
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  string(REGEX REPLACE "^components/" "" folder ${folder})
  set_property(GLOBAL APPEND PROPERTY CONSTRICTOR_COMPONENTS "${name}=${folder}/${name}.hpp")
endfunction()

# The target unit_tests builds what `ctest -L unit` runs, without the programs: for builds with sanitizers.
add_custom_target(unit_tests)

# The target generated_code makes all headers that an analysis of the sources needs.
add_custom_target(generated_code)

if(CONSTRICTOR_TESTS)
  add_library(constrictor_test_precompiled OBJECT ${CMAKE_CURRENT_LIST_DIR}/precompiled.cpp)
  target_link_libraries(constrictor_test_precompiled PRIVATE constrictor_options GTest::gtest)
  target_precompile_headers(constrictor_test_precompiled PRIVATE ${CONSTRICTOR_COMMON_HEADERS} <gtest/gtest.h>)
  constrictor_compile_quickly(constrictor_test_precompiled)
endif()

# constrictor_test(NAME [SERIAL] [WHOLE] SOURCES ... LINK ... [LABELS label] [TIMEOUT s] [FIXTURE f]): a GoogleTest
# program; ctest runs each of its cases as a test.
#   SERIAL    no other test runs at the same time; for tests of several processes whose bounds are in wall time
#   WHOLE     ctest runs the program once, as one test; for cases that share an expensive preparation
#   LABELS    one of unit (the default), integration, long; gtest_discover_tests accepts one label only
#   TIMEOUT   [s] default 120
#   FIXTURE   ctest's fixture that must be set up before
# The names of cases with the label `long` get the prefix `Long.`, because ctest merges the labels of two tests that
# have the same name.
function(constrictor_test name)
  cmake_parse_arguments(ARG "SERIAL;WHOLE" "TIMEOUT;FIXTURE" "SOURCES;LINK;LABELS" ${ARGN})
  list(LENGTH ARG_LABELS labels)
  if(labels GREATER 1)
    message(FATAL_ERROR "${name}: exactly one label is accepted, found '${ARG_LABELS}'")
  endif()
  set(prefix "")
  if(ARG_LABELS STREQUAL long)
    set(prefix "Long.")
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(CONSTRICTOR_SANITIZE)
    math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")  # sanitizers slow the tests down
  endif()
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE constrictor_options ${ARG_LINK} constrictor_project_paths
                        GTest::gtest GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  constrictor_compile_quickly(${name})
  set_target_properties(${name} PROPERTIES UNITY_BUILD_BATCH_SIZE 8)  # a changed test should be built soon
  if(CONSTRICTOR_PCH)
    target_precompile_headers(${name} REUSE_FROM constrictor_test_precompiled)
  endif()
  if(ARG_LABELS STREQUAL unit)
    add_dependencies(unit_tests ${name})
  endif()
  if(ARG_WHOLE)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} RUN_SERIAL ${ARG_SERIAL})
    return()
  endif()
  include(GoogleTest)
  # Without NO_PRETTY_VALUES, the bytes of a parameter that cannot be printed would become part of a name, and the
  # names would change with each build.
  gtest_discover_tests(${name} TEST_PREFIX "${prefix}" DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES
    PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} RUN_SERIAL ${ARG_SERIAL}
               FIXTURES_REQUIRED "${ARG_FIXTURE}")
endfunction()
