# Toolchain file: Debian's cross compiler for arm64, with libraries from the folder BOLE_SYSROOT
# (see scripts/arm64-check).
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES BOLE_SYSROOT)
set(CMAKE_FIND_ROOT_PATH "${BOLE_SYSROOT}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} "${BOLE_SYSROOT}")
set(ENV{PKG_CONFIG_LIBDIR}
    "${BOLE_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${BOLE_SYSROOT}/usr/share/pkgconfig")
# What a library's headers keep for each architecture, as libjpeg's do.
set(CMAKE_CXX_FLAGS_INIT "-idirafter ${BOLE_SYSROOT}/usr/include/aarch64-linux-gnu")
set(CMAKE_EXE_LINKER_FLAGS_INIT
    "-Wl,-rpath-link,${BOLE_SYSROOT}/usr/lib/aarch64-linux-gnu:${BOLE_SYSROOT}/lib/aarch64-linux-gnu")
