# The torture suite, test/stress: its short form is a test (label stress), the long one an option of the program. And the soak.
file(GLOB stress_sources CONFIGURE_DEPENDS test/stress/*.cpp)
list(FILTER stress_sources EXCLUDE REGEX "/soak\\.cpp$")
add_executable(curtain_stress ${stress_sources})
add_executable(curtain_soak test/stress/soak.cpp)
foreach(program curtain_stress curtain_soak)
  target_include_directories(${program} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/test ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(${program} PRIVATE curtain_engine curtain_warnings)
endforeach()
# The default, and the two that do not share its steps; the others differ little, or keep nothing.
foreach(method auto leapfrog4 implicit)
  add_test(NAME stress_${method} COMMAND curtain_stress --method ${method})
  set_tests_properties(stress_${method} PROPERTIES LABELS stress)
endforeach()
