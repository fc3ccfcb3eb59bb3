# What features cost: curtain_cost runs a scene under callgrind, curtain_weigh runs that. For the benchmark and a test.
add_library(curtain_features STATIC bench/cost/features.cpp)
target_include_directories(curtain_features PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_definitions(curtain_features PRIVATE CURTAIN_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
target_link_libraries(curtain_features PUBLIC curtain_engine PRIVATE curtain_warnings)

add_executable(curtain_cost bench/cost/main.cpp)
target_link_libraries(curtain_cost PRIVATE curtain_features curtain_warnings)

add_library(curtain_weigh STATIC bench/cost/weigh.cpp)
target_compile_definitions(curtain_weigh PRIVATE CURTAIN_COST="$<TARGET_FILE:curtain_cost>")
target_link_libraries(curtain_weigh PUBLIC curtain_features PRIVATE curtain_warnings)
add_dependencies(curtain_weigh curtain_cost)
