# One gtest binary a floor, from test/<floor>/*_test.cpp; properties: of whole scenes, see test/properties/seeds.h. Truth figures live in test/truth, see its README.
find_package(GTest REQUIRED)
include(cmake/drawn.cmake)

function(curtain_add_tests floor)
  file(GLOB sources CONFIGURE_DEPENDS test/${floor}/*_test.cpp)
  if(NOT sources)
    return()
  endif()
  set(target test_${floor})
  if(catkin_FOUND)
    catkin_add_gtest(${target} ${sources})
    target_link_libraries(${target} GTest::gtest_main)
  else()
    add_executable(${target} ${sources})
    target_link_libraries(${target} GTest::gtest_main)
    foreach(shard RANGE 1)  # Google Test's; the longest binary takes both cores
      add_test(NAME ${target}_${shard} COMMAND ${target})
      set_tests_properties(${target}_${shard} PROPERTIES ENVIRONMENT "GTEST_TOTAL_SHARDS=2;GTEST_SHARD_INDEX=${shard}")
    endforeach()
  endif()
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src ${CMAKE_CURRENT_SOURCE_DIR}/test)
  target_compile_definitions(${target} PRIVATE
    CURTAIN_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}" CURTAIN_BATCH="$<TARGET_FILE:curtain_batch>")
  target_link_libraries(${target} curtain_engine curtain_warnings ${ARGN})
  curtain_compile_quickly(${target})
endfunction()

add_compile_definitions($<$<CONFIG:Debug>:CURTAIN_FLOAT_TRAPS>)  # test/float_traps.h

foreach(floor scene cloth step contact parts budget properties batch)
  curtain_add_tests(${floor})
endforeach()
foreach(floor simulator fuzz)
  curtain_add_tests(${floor} curtain_drawn)
endforeach()
curtain_add_tests(fit curtain_fabric)

# Against another library's answers.
find_package(fcl QUIET)
if(fcl_FOUND)
  curtain_add_tests(oracle fcl)
endif()

if(catkin_FOUND)
  include(cmake/ros_tests.cmake)
endif()
if(TARGET curtain_export)
  include(cmake/export_tests.cmake)
endif()

# These run the program itself and read what it writes; the structure tests read the checkout.
foreach(target test_batch test_fuzz)
  if(TARGET ${target})
    add_dependencies(${target} curtain_batch)
    target_link_libraries(${target} nlohmann_json::nlohmann_json)
  endif()
endforeach()
if(TARGET test_fit)
  add_dependencies(test_fit curtain_fit)
  target_link_libraries(test_fit nlohmann_json::nlohmann_json)
  target_compile_definitions(test_fit PRIVATE CURTAIN_FIT="$<TARGET_FILE:curtain_fit>")
endif()
if(TARGET test_fuzz)
  target_sources(test_fuzz PRIVATE test/fuzz/scene_yaml.cpp test/fuzz/mesh.cpp test/fuzz/step.cpp test/fuzz/snapshot.cpp
    test/fuzz/breakages.cpp)
endif()
if(TARGET test_properties)
  target_sources(test_properties PRIVATE test/properties/random_scenes.cpp test/properties/similarity.cpp
    test/properties/growth.cpp test/properties/motion.cpp)
endif()
curtain_add_tests(structure)

# The book: its links and commands, what it leaves out, what its examples come to, and the reference of the public headers.
if(NOT Python3_Interpreter_FOUND)
  message(FATAL_ERROR "curtain_sim: the tests need Python 3")
endif()
add_test(NAME docs_check COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/structure/docs_check.py)
add_test(NAME packages_check COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/structure/packages_check.py)
set(CURTAIN_EIGEN33 ${EIGEN3_INCLUDE_DIR} CACHE PATH "Folder of an Eigen 3.3, to try the sources with")
add_test(NAME portable_check COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/structure/portable_check.py
  ${CMAKE_CXX_COMPILER} ${CURTAIN_EIGEN33})
add_test(NAME parts_check COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/structure/parts_check.py
  ${CMAKE_CURRENT_BINARY_DIR}/without_parts -G ${CMAKE_GENERATOR} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -DPython3_EXECUTABLE=${Python3_EXECUTABLE})
add_test(NAME demos_check COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/structure/demos_check.py $<TARGET_FILE:curtain_batch>)
add_test(NAME robot_check COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/structure/robot_check.py)
add_test(NAME worked_examples COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/structure/worked_examples.py
  ${CMAKE_CURRENT_BINARY_DIR}/worked_examples $<TARGET_FILE:curtain_batch> -G ${CMAKE_GENERATOR} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER})
set_tests_properties(worked_examples PROPERTIES COST 200)  # the longest but one
find_program(DOXYGEN doxygen)
if(DOXYGEN)
  add_test(NAME doxygen COMMAND sh -c "(cat docs/Doxyfile; echo OUTPUT_DIRECTORY=${CMAKE_CURRENT_BINARY_DIR}/doxygen) | ${DOXYGEN} -"
    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
endif()

# Figures that pages quote from tests are those of this run's reports.
if(catkin_FOUND)
  add_test(NAME figures_check COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/record_figures.py --check
    ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME})
  set(reporting simulator fit ros)
  list(TRANSFORM reporting PREPEND _ctest_${PROJECT_NAME}_gtest_test_)
  set_tests_properties(figures_check PROPERTIES DEPENDS "${reporting}")
endif()

# The Python module, its types, example and page.
execute_process(COMMAND ${Python3_EXECUTABLE} -c "import numpy" RESULT_VARIABLE without_numpy ERROR_QUIET)
if(TARGET curtain_python AND without_numpy EQUAL 0)
  add_test(NAME python COMMAND ${Python3_EXECUTABLE} -B -m unittest discover -s test/python -p *_test.py
    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
  set_tests_properties(python PROPERTIES ENVIRONMENT "PYTHONPATH=${curtain_python_built};CURTAIN_BATCH=$<TARGET_FILE:curtain_batch>")
else()
  message(STATUS "curtain_sim: no Python module or no NumPy (Debian: python3-numpy), its tests are left out")
endif()
if(without_numpy EQUAL 0)
  add_test(NAME robot_scene COMMAND ${Python3_EXECUTABLE} -B -m unittest discover -s test/robot -p *_test.py
    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
  set_tests_properties(robot_scene PROPERTIES ENVIRONMENT "CURTAIN_BATCH=$<TARGET_FILE:curtain_batch>")
endif()
add_test(NAME sweep COMMAND ${Python3_EXECUTABLE} -B -m unittest discover -s test/sweep -p *_test.py
  WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
set_tests_properties(sweep PROPERTIES ENVIRONMENT "CURTAIN_BATCH=$<TARGET_FILE:curtain_batch>")

# By the formatter's major version that Debian 12 has: others break other lines.
find_program(CLANG_FORMAT NAMES clang-format-14)
if(CLANG_FORMAT)
  add_test(NAME format COMMAND sh -c "find include src test bench docs -name '*.cpp' -o -name '*.h' | xargs ${CLANG_FORMAT} --dry-run -Werror"
    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
endif()

# Instructions of optimised code, without a sanitizer's.
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  include(cmake/cost.cmake)
  curtain_add_tests(cost curtain_weigh)
endif()
# The bits of motion: for both numbers of threads, and on a processor without AVX. That one is emulated, which is slow: only with contact.
set(golden ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/golden/check)
foreach(threads 1 2)
  add_test(NAME golden_${threads} COMMAND ${golden} --threads ${threads} $<TARGET_FILE:curtain_batch>)
endforeach()
find_program(QEMU qemu-x86_64)
if(QEMU AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  add_test(NAME golden_sse2 COMMAND ${golden} --only auto_shapes --only auto_mesh_self -- ${QEMU} -cpu Nehalem $<TARGET_FILE:curtain_batch>)
endif()
include(cmake/stress.cmake)
include(cmake/judge.cmake)
if(catkin_FOUND)  # with the other tests, not with the node
  set_target_properties(curtain_stress curtain_soak curtain_judge PROPERTIES EXCLUDE_FROM_ALL ON)
  add_dependencies(tests curtain_stress curtain_soak curtain_judge)
endif()
include(cmake/packaging_tests.cmake)

# What scripts/test --fast builds and runs.
if(NOT catkin_FOUND)
  set(fast scene cloth step contact parts budget batch fit structure)
  list(TRANSFORM fast PREPEND test_)
  add_custom_target(fast_tests DEPENDS curtain_batch curtain_fit ${fast})
  set(second_shards ${fast})
  list(TRANSFORM fast APPEND _0)
  list(TRANSFORM second_shards APPEND _1)
  list(APPEND fast ${second_shards})
  if(TEST python)
    add_dependencies(fast_tests curtain_python)
    list(APPEND fast python)
  endif()
  set_tests_properties(${fast} golden_1 golden_2 docs_check demos_check packages_check portable_check PROPERTIES LABELS fast)
  if(CLANG_FORMAT)
    set_tests_properties(format PROPERTIES LABELS fast)
  endif()
endif()

# A test of the node waits for much of its time: it takes half a core. Others compute. The longest begins first, or it would be waited for alone.
if(catkin_FOUND)
  get_property(computing DIRECTORY PROPERTY TESTS)
  list(FILTER computing EXCLUDE REGEX "_rostest_")
  set_tests_properties(${computing} PROPERTIES PROCESSORS 2)
  set_tests_properties(_ctest_${PROJECT_NAME}_gtest_test_simulator PROPERTIES COST 300)
endif()
