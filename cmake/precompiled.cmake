# Headers that most files include, read once a target instead of once a file. Only as an option, and for the engine only with
# sanitizers and for the pages' examples: a file that forgets an include of these compiles here, and must not in the build that
# everybody has. There the engine's files are also compiled several at once: less than half of the time.
set(curtain_common_headers <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <optional> <string> <utility>
  <vector> <Eigen/Core> <Eigen/Geometry>)
get_directory_property(curtain_targets BUILDSYSTEM_TARGETS)
foreach(target IN LISTS curtain_targets)
  get_target_property(type ${target} TYPE)
  if(target STREQUAL "curtain_engine" AND CURTAIN_PRECOMPILED STREQUAL "all")
    target_precompile_headers(${target} PRIVATE ${curtain_common_headers})
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON)
  elseif(target MATCHES "^test_" AND type STREQUAL "EXECUTABLE")
    target_precompile_headers(${target} PRIVATE ${curtain_common_headers} <gtest/gtest.h>)
    if(NOT target STREQUAL "test_cost")  # it counts instructions
      target_compile_options(${target} PRIVATE -O1)  # they are compiled once and run once: a third less to compile
    endif()
  endif()
endforeach()
