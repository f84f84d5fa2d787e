# Compile options of the project's own code, and the functions that make its targets.

# -Wno-restrict: a false positive of g++ 12 in std::string (GCC bug 105651).
# Numbers must not depend on the machine's instruction set: no contraction to FMA, SSE2 arithmetic as x86-64 has it.
add_library(constrictor_options INTERFACE)
target_compile_options(constrictor_options INTERFACE
  $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wpedantic;-Wconversion;-Wshadow;-Wold-style-cast;-Wno-restrict>>
  $<BUILD_INTERFACE:$<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:${CONSTRICTOR_WERROR}>>:-Werror>>
  -ffp-contract=off)
target_compile_features(constrictor_options INTERFACE cxx_std_20)
target_include_directories(constrictor_options INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/components> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
  $<INSTALL_INTERFACE:include/constrictor>)
if(CONSTRICTOR_SANITIZE)
  add_compile_options(-fsanitize=${CONSTRICTOR_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${CONSTRICTOR_SANITIZE})
endif()

# constrictor_library(NAME SOURCES ... LINK ...): a static library of the project.
function(constrictor_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC constrictor_options ${ARG_LINK})
endfunction()

# constrictor_component(NAME SOURCES ... LINK ...): the pure class as library constrictor_NAME, and, from main.cpp, the
# executable NAME.
function(constrictor_component name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  constrictor_library(constrictor_${name} SOURCES ${ARG_SOURCES} LINK constrictor_component_api ${ARG_LINK})
  add_executable(${name} main.cpp)
  target_link_libraries(${name} PRIVATE constrictor_${name} constrictor_runtime)
endfunction()

# What `ctest -L unit` runs, without the programs: for builds under the sanitizers.
add_custom_target(unit_tests)

# constrictor_test(NAME [SERIAL] [WHOLE] SOURCES ... LINK ... LABELS label [TIMEOUT s] [FIXTURE f]): a GoogleTest program, its cases discovered by
# ctest. One label: gtest_discover_tests takes no list. FIXTURE: what must have been set up. SERIAL: nothing else runs beside it (tests of
# several processes, whose bounds are in wall time). WHOLE: one ctest of all cases, which share what is dear to make.
# Names of `long` cases begin with `Long.`: of a quick and a long test of one name ctest would give each the labels of both.
function(constrictor_test name)
  cmake_parse_arguments(ARG "SERIAL;WHOLE" "TIMEOUT;FIXTURE" "SOURCES;LINK;LABELS" ${ARGN})
  list(LENGTH ARG_LABELS labels)
  if(labels GREATER 1)
    message(FATAL_ERROR "${name}: one label, not '${ARG_LABELS}'")
  endif()
  set(prefix "")
  if(ARG_LABELS STREQUAL long)
    set(prefix "Long.")
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(CONSTRICTOR_SANITIZE)
    math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")  # what they slow down
  endif()
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE constrictor_options ${ARG_LINK} GTest::gtest GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  if(ARG_LABELS STREQUAL unit)
    add_dependencies(unit_tests ${name})
  endif()
  if(ARG_WHOLE)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} RUN_SERIAL ${ARG_SERIAL})
    return()
  endif()
  include(GoogleTest)
  gtest_discover_tests(${name} TEST_PREFIX "${prefix}" DISCOVERY_TIMEOUT 60 PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT}
                         RUN_SERIAL ${ARG_SERIAL} FIXTURES_REQUIRED "${ARG_FIXTURE}")
endfunction()
