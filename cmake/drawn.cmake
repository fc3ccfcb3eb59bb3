# Random scenes and trials, test/drawn, for whoever judges them.
include_guard()
file(GLOB drawn_sources CONFIGURE_DEPENDS test/drawn/*.cpp)
add_library(curtain_drawn STATIC EXCLUDE_FROM_ALL ${drawn_sources})
target_include_directories(curtain_drawn PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/test ${CMAKE_CURRENT_SOURCE_DIR}/src)
target_compile_definitions(curtain_drawn PRIVATE CURTAIN_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
target_link_libraries(curtain_drawn PUBLIC curtain_engine PRIVATE curtain_warnings)
curtain_unite(curtain_drawn)
