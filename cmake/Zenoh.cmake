# The zenoh crate behind src/publish/zenoh_bridge, built by cargo: target zenoh_bridge.
# BOLE_ZENOH is OFF after this where cargo is missing or too old.
option(BOLE_ZENOH "Publish over Zenoh; needs cargo" ON)
set(rust_version 1.85)
set(cache_home "$ENV{XDG_CACHE_HOME}")
if(NOT cache_home)
  set(cache_home "$ENV{HOME}/.cache")
endif()
set(BOLE_CARGO_TARGET_DIR "${cache_home}/bole/cargo" CACHE PATH
    "Where cargo keeps what it builds; outlives the build folder, may be shared by several")

if(BOLE_ZENOH)
  find_program(CARGO cargo HINTS "$ENV{CARGO_HOME}/bin" "$ENV{HOME}/.cargo/bin")
  if(CARGO)
    execute_process(COMMAND "${CARGO}" --version OUTPUT_VARIABLE cargo_version)
    string(REGEX MATCH "[0-9]+\\.[0-9]+" cargo_version "${cargo_version}")
  endif()
  if(NOT CARGO OR cargo_version VERSION_LESS rust_version)
    message(WARNING "Going on without Zenoh: no cargo ${rust_version} or newer. To have it, install "
      "cargo (Debian 13), cargo-web (Debian 12) or rustup, and configure anew.")
    unset(CARGO CACHE)
    set(BOLE_ZENOH OFF)
  endif()
endif()
if(NOT BOLE_ZENOH)
  return()
endif()

set(bridge "${CMAKE_SOURCE_DIR}/src/publish/zenoh_bridge")
set(library "${CMAKE_BINARY_DIR}/libzenoh_bridge.a")
set(headers "${BOLE_CARGO_TARGET_DIR}/cxxbridge")

# Where the crates lie on this machine stays out of the library: each machine builds the same.
set(cargo_home "$ENV{CARGO_HOME}")
if(NOT cargo_home)
  set(cargo_home "$ENV{HOME}/.cargo")
endif()
set(reproducible
  --config "build.rustflags=['--remap-path-prefix=${cargo_home}=/cargo']"
  --config "env.CFLAGS='-ffile-prefix-map=${cargo_home}=/cargo'"
  --config "env.CXXFLAGS='-ffile-prefix-map=${cargo_home}=/cargo'")

file(GLOB bridge_sources CONFIGURE_DEPENDS "${bridge}/src/*.rs" "${bridge}/Cargo.*")
add_custom_command(
  OUTPUT "${library}"
  COMMAND "${CMAKE_COMMAND}" -E env "BOLE_SOURCE_DIR=${CMAKE_SOURCE_DIR}"
          "${CARGO}" build --quiet --release --locked ${reproducible}
          --manifest-path "${bridge}/Cargo.toml" --target-dir "${BOLE_CARGO_TARGET_DIR}"
  COMMAND "${CMAKE_COMMAND}" -E copy
          "${BOLE_CARGO_TARGET_DIR}/release/libzenoh_bridge.a" "${library}"
  DEPENDS ${bridge_sources} "${bridge}/build.rs"
  COMMENT "Building zenoh (minutes the first time)"
  USES_TERMINAL VERBATIM)
add_custom_target(zenoh_bridge_build DEPENDS "${library}")

find_package(Threads REQUIRED)
add_library(zenoh_bridge INTERFACE)
add_dependencies(zenoh_bridge zenoh_bridge_build)
target_include_directories(zenoh_bridge SYSTEM INTERFACE
  "${headers}" "${headers}${CMAKE_SOURCE_DIR}/src/publish")
target_link_libraries(zenoh_bridge INTERFACE "${library}" Threads::Threads ${CMAKE_DL_LIBS} m)
target_link_options(zenoh_bridge INTERFACE LINKER:--gc-sections,-z,noexecstack)
