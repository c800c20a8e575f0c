# How every part of Striae is declared, so that warnings, include paths and test discovery are the same everywhere.

add_library(striae_options INTERFACE)
target_compile_options(striae_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor)
# Partly initialised aggregates are how options are given; -Wrestrict of g++ 12 is wrong about std::string (GCC PR 105651).
target_compile_options(striae_options INTERFACE -Wno-missing-field-initializers $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(STRIAE_WARNINGS_AS_ERRORS)
  target_compile_options(striae_options INTERFACE -Werror)
endif()

# striae_library(<name> HEADERS <public headers> SOURCES <sources> [PUBLIC <libraries>] [PRIVATE <libraries>])
# A module: static library striae_<name>; includes are written from the project's root ("core/result.h").
# Third-party libraries go to PRIVATE: none of their types may stand in a public header.
function(striae_library name)
  cmake_parse_arguments(ARG "" "" "HEADERS;SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(striae_${name} STATIC ${ARG_SOURCES})
  target_sources(striae_${name} PUBLIC FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${ARG_HEADERS})
  target_include_directories(striae_${name} PUBLIC "${PROJECT_SOURCE_DIR}")
  target_link_libraries(striae_${name} PUBLIC ${ARG_PUBLIC} PRIVATE striae_options ${ARG_PRIVATE})
endfunction()

# striae_heavy_sources(<files>): compiled one at a time (CGAL, PCL).
function(striae_heavy_library name)
  set_property(TARGET striae_${name} PROPERTY JOB_POOL_COMPILE heavy)
endfunction()

# striae_test(<name> SOURCES <files> LIBS <libraries>)
# One GoogleTest program <name>_tests, its cases known to ctest as <name>.<Suite>.<Case> with the label <name>.
# Suites whose name ends in "Long" get the label `long` instead and run only with script/test --all.
function(striae_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name}_tests ${ARG_SOURCES})
  target_link_libraries(${name}_tests PRIVATE striae_options striae_test_support ${ARG_LIBS})
  target_compile_definitions(${name}_tests PRIVATE
    STRIAE_SOURCE_DIR="${PROJECT_SOURCE_DIR}" STRIAE_TEST_DATA="${STRIAE_TEST_DATA}" STRIAE_BINARY_DIR="${CMAKE_BINARY_DIR}")
  # A list of labels would be taken apart into further properties: one label each.
  gtest_discover_tests(${name}_tests TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST TEST_FILTER "-*Long.*"
    PROPERTIES TIMEOUT 900 LABELS ${name})
  gtest_discover_tests(${name}_tests TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST TEST_FILTER "*Long.*" TEST_LIST ${name}_long
    PROPERTIES TIMEOUT 3600 LABELS long)
endfunction()
