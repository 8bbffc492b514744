# What every target of ours is compiled with: warnings are errors, ccache where it is there,
# sanitizers where asked for. Link against bole_options to get it.
find_program(CCACHE ccache)
if(CCACHE)
  # Paths count relative to the source tree, so that one clone's objects serve the next clone.
  set(launcher "${CMAKE_COMMAND}" -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 "${CCACHE}")
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
endif()

add_library(bole_options INTERFACE)
target_compile_options(bole_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Werror)
target_include_directories(bole_options INTERFACE "${CMAKE_SOURCE_DIR}/src")
if(BOLE_SANITIZE)
  # GCC 12 mistrusts std::regex and std::string once the sanitizers' checks stand in them.
  target_compile_options(bole_options INTERFACE
    -fsanitize=${BOLE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    -Wno-maybe-uninitialized -Wno-restrict)
  target_link_options(bole_options INTERFACE -fsanitize=${BOLE_SANITIZE})
endif()

# bole_library(name sources...): a static library of ours.
function(bole_library name)
  add_library(${name} STATIC ${ARGN})
  target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:bole_options>)
  target_include_directories(${name} PUBLIC
    "$<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src>"
    "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/bole>")
endfunction()

# bole_core_library(name sources...): the same, for what finds trees: without fused multiply-adds of
# the compiler's own, which round differently, so that all processors find the same.
function(bole_core_library name)
  bole_library(${name} ${ARGN})
  target_compile_options(${name} PRIVATE -ffp-contract=off)
endfunction()
