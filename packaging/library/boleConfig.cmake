# find_package(bole): bole::warp un-warps frames, bole::detect finds trees in what comes of it.
include(CMakeFindDependencyMacro)
find_dependency(hwy)
find_dependency(JPEG)
find_dependency(PNG)
find_dependency(ZLIB)
find_dependency(tomlplusplus)
find_dependency(yaml-cpp)
include("${CMAKE_CURRENT_LIST_DIR}/boleTargets.cmake")
