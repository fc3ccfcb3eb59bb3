# The checks of test/fuzz as libFuzzer targets, and the dictionary for scenes, from the key table. test/fuzz/run runs them.
include(cmake/drawn.cmake)
function(curtain_add_fuzzer name check)
  add_executable(fuzz_${name} test/fuzz/fuzzer.cpp test/fuzz/${name}.cpp)
  target_include_directories(fuzz_${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src ${CMAKE_CURRENT_SOURCE_DIR}/test)
  target_compile_definitions(fuzz_${name} PRIVATE CURTAIN_FUZZ_CHECK=${check} CURTAIN_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
  target_link_libraries(fuzz_${name} PRIVATE curtain_drawn curtain_warnings -fsanitize=fuzzer)
endfunction()

curtain_add_fuzzer(scene_yaml checkSceneText)
curtain_add_fuzzer(mesh checkMesh)
curtain_add_fuzzer(step checkStep)
curtain_add_fuzzer(snapshot checkSnapshot)

add_executable(fuzz_dictionary test/fuzz/dictionary.cpp)
target_include_directories(fuzz_dictionary PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
target_link_libraries(fuzz_dictionary PRIVATE curtain_engine curtain_warnings)
add_custom_command(OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/scene_yaml.dict
  COMMAND fuzz_dictionary > ${CMAKE_CURRENT_BINARY_DIR}/scene_yaml.dict DEPENDS fuzz_dictionary)
add_custom_target(fuzz_dictionaries ALL DEPENDS ${CMAKE_CURRENT_BINARY_DIR}/scene_yaml.dict)
