# find_package(curtain_sim): the target curtain_sim::engine. Without catkin this is the whole config file, with catkin
# the end of the one that it writes.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
find_dependency(yaml-cpp)
find_dependency(ZLIB)
find_dependency(Threads)
include("${curtain_sim_DIR}/curtain_sim-libraries.cmake")
curtain_sim_find_libraries()
if(curtain_sim_missing)
  set(curtain_sim_FOUND FALSE)
  set(curtain_sim_NOT_FOUND_MESSAGE "curtain_sim needs ${curtain_sim_missing}")
  return()
endif()
if(NOT TARGET curtain_sim::engine)  # it is there where one workspace builds both packages
  include("${curtain_sim_DIR}/curtain_sim-targets.cmake")
endif()
list(APPEND curtain_sim_LIBRARIES curtain_sim::engine)
