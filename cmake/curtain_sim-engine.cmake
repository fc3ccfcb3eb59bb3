# find_package(curtain_sim): the target curtain_sim::engine. Without catkin this is the whole config file, with catkin
# the end of the one that it writes.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
find_dependency(yaml-cpp)
find_dependency(assimp)
find_dependency(tinyxml2)
find_dependency(TBB)
find_dependency(ZLIB)
if(NOT TARGET curtain_sim::engine)  # it is there where one workspace builds both packages
  include("${curtain_sim_DIR}/curtain_sim-targets.cmake")
endif()
list(APPEND curtain_sim_LIBRARIES curtain_sim::engine)
