# What a camera or a lidar sees: src/sensing, with Embree as the caster of rays (Debian: libembree-dev). For the node; the engine
# does without.
find_package(embree 3 REQUIRED)
file(GLOB CURTAIN_SENSING_SOURCES CONFIGURE_DEPENDS src/sensing/*.cpp)
add_library(curtain_sensing STATIC ${CURTAIN_SENSING_SOURCES})
target_include_directories(curtain_sensing PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/src)
target_link_libraries(curtain_sensing PUBLIC curtain_engine PRIVATE embree TBB::tbb curtain_warnings)
