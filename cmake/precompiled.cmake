# Headers that most files include, read once a target instead of once a file: less than half of the time of a build. Every file
# names what it uses all the same: -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON shows what is forgotten.
set(curtain_common_headers <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <optional> <string> <utility>
  <vector> <Eigen/Core> <Eigen/Geometry>)
target_precompile_headers(curtain_engine PRIVATE ${curtain_common_headers})
function(curtain_unite target)
  if(CURTAIN_UNITY AND TARGET ${target})
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
  endif()
endfunction()
foreach(target engine batch fabric animation ros sensing surface rviz)
  curtain_unite(curtain_${target})
endforeach()
if(TARGET curtain_ros)
  target_precompile_headers(curtain_ros PRIVATE ${curtain_common_headers} <ros/node_handle.h> <ros/console.h>)
endif()
if(TARGET curtain_sensing)
  target_precompile_headers(curtain_sensing PRIVATE ${curtain_common_headers})
endif()
if(TARGET curtain_python)
  target_precompile_headers(curtain_python PRIVATE ${curtain_common_headers} <pybind11/numpy.h>)
  set_target_properties(curtain_python PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 4)  # pybind11's templates
endif()

# One for all tests, whose code is compiled once and run once.
function(curtain_compile_quickly target)
  if(NOT TARGET curtain_test_headers)
    file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp CONTENT "")
    add_executable(curtain_test_headers EXCLUDE_FROM_ALL ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp)
    target_compile_options(curtain_test_headers PRIVATE -O1)
    target_link_libraries(curtain_test_headers PRIVATE curtain_engine GTest::gtest_main)
    target_precompile_headers(curtain_test_headers PRIVATE ${curtain_common_headers} <fstream> <set> <sstream> <gtest/gtest.h>
      <curtain_sim/scene_yaml.h> <curtain_sim/simulator.h>)
  endif()
  target_compile_options(${target} PRIVATE -O1)
  target_precompile_headers(${target} REUSE_FROM curtain_test_headers)
  curtain_unite(${target})
endfunction()
