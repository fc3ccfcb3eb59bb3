# Random scenes as the judge, test/judge.
file(GLOB judge_sources CONFIGURE_DEPENDS test/judge/*.cpp)
add_executable(curtain_judge ${judge_sources})
target_include_directories(curtain_judge PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/test ${CMAKE_CURRENT_SOURCE_DIR}/src)
target_link_libraries(curtain_judge PRIVATE curtain_engine curtain_warnings)
