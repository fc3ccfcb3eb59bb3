# Libraries found by their header and their file: the CMake packages of these are missing on some systems and name folders that do
# not exist on others. Makes the target curtain_sim::NAME, or says in curtain_sim_missing what can't be found.
#   curtain_sim_find(NAME header file "Debian's package")
function(curtain_sim_find name header file package)
  if(TARGET curtain_sim::${name})
    return()
  endif()
  find_path(CURTAIN_${name}_HEADERS ${header} PATH_SUFFIXES ${ARGN})
  find_library(CURTAIN_${name}_LIBRARY ${file})
  mark_as_advanced(CURTAIN_${name}_HEADERS CURTAIN_${name}_LIBRARY)
  if(NOT CURTAIN_${name}_HEADERS OR NOT CURTAIN_${name}_LIBRARY)
    set(curtain_sim_missing ${curtain_sim_missing} "${name} (Debian: ${package})" PARENT_SCOPE)
    return()
  endif()
  add_library(curtain_sim::${name} INTERFACE IMPORTED)
  set_target_properties(curtain_sim::${name} PROPERTIES INTERFACE_LINK_LIBRARIES ${CURTAIN_${name}_LIBRARY})
  # Not where compilers look anyhow: in front of their own headers, C++'s would not find C's.
  if(NOT CURTAIN_${name}_HEADERS IN_LIST CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES)
    set_target_properties(curtain_sim::${name} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${CURTAIN_${name}_HEADERS})
  endif()
endfunction()

# What the engine is linked with.
macro(curtain_sim_find_libraries)
  set(curtain_sim_missing)
  curtain_sim_find(assimp assimp/scene.h assimp libassimp-dev)
  curtain_sim_find(tbb tbb/task_arena.h tbb libtbb-dev)
  curtain_sim_find(tinyxml2 tinyxml2.h tinyxml2 libtinyxml2-dev)
endmacro()
