# What of Bullet a soft body needs, in its default precision: single.
set(bullet ${CURTAIN_BENCH_BULLET}/src)
file(GLOB_RECURSE bullet_sources ${bullet}/BulletSoftBody/*.cpp)
if(NOT bullet_sources)
  message(FATAL_ERROR "no sources of Bullet in ${CURTAIN_BENCH_BULLET}")
endif()
file(STRINGS ${CURTAIN_BENCH_BULLET}/VERSION version)
add_library(bullet_soft STATIC ${bullet}/btLinearMathAll.cpp ${bullet}/btBulletCollisionAll.cpp ${bullet}/btBulletDynamicsAll.cpp
  ${bullet_sources})
target_include_directories(bullet_soft SYSTEM PUBLIC ${bullet})
target_compile_options(bullet_soft PRIVATE ${engine_flags} -w)
target_sources(engine_contestants PRIVATE bullet_world.cpp)
target_link_libraries(engine_contestants PRIVATE bullet_soft)
