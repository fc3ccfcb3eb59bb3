# Headers that most files include, read once a target instead of once a file: less than half of the time of a build. Every file
# names what it uses all the same: -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON shows what is forgotten.
set(curtain_common_headers <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <optional> <string> <utility>
  <vector> <Eigen/Core> <Eigen/Geometry>)
target_precompile_headers(curtain_engine PRIVATE ${curtain_common_headers})
if(CURTAIN_UNITY)
  set_target_properties(curtain_engine PROPERTIES UNITY_BUILD ON)
endif()
if(TARGET curtain_ros)
  target_precompile_headers(curtain_ros PRIVATE ${curtain_common_headers} <ros/node_handle.h> <ros/console.h>)
endif()
if(TARGET curtain_sensing)
  target_precompile_headers(curtain_sensing PRIVATE ${curtain_common_headers})
endif()
if(TARGET curtain_python)
  target_precompile_headers(curtain_python PRIVATE ${curtain_common_headers} <pybind11/numpy.h> <pybind11/stl.h>)
endif()

# One for all tests, in the order they are made; their code is compiled once and run once.
function(curtain_compile_quickly target)
  target_compile_options(${target} PRIVATE -O1)
  if(TARGET test_scene AND NOT target STREQUAL "test_scene")
    target_precompile_headers(${target} REUSE_FROM test_scene)
  else()
    target_precompile_headers(${target} PRIVATE ${curtain_common_headers} <fstream> <set> <sstream> <gtest/gtest.h>
      ${CMAKE_CURRENT_SOURCE_DIR}/include/curtain_sim/scene_yaml.h ${CMAKE_CURRENT_SOURCE_DIR}/include/curtain_sim/simulator.h)
  endif()
endfunction()
