# Jolt by its own build, without what a game's author watches it by.
foreach(option ENABLE_ALL_WARNINGS GENERATE_DEBUG_SYMBOLS INTERPROCEDURAL_OPTIMIZATION ENABLE_OBJECT_STREAM ENABLE_INSTALL
        PROFILER_IN_DEBUG_AND_RELEASE DEBUG_RENDERER_IN_DEBUG_AND_RELEASE JPH_USE_VK JPH_USE_CPU_COMPUTE
        FLOATING_POINT_EXCEPTIONS_ENABLED)
  set(${option} OFF CACHE BOOL "of Jolt" FORCE)
endforeach()
set(CPP_RTTI_ENABLED ON CACHE BOOL "of Jolt" FORCE)
set(CPP_EXCEPTIONS_ENABLED ON CACHE BOOL "of Jolt" FORCE)
file(STRINGS ${CURTAIN_BENCH_JOLT}/Jolt/Core/Core.h version REGEX "define JPH_VERSION_(MAJOR|MINOR|PATCH) ")
string(REGEX REPLACE "[^;]* ([0-9]+)" "\\1" version "${version}")
list(JOIN version . version)
add_subdirectory(${CURTAIN_BENCH_JOLT}/Build jolt EXCLUDE_FROM_ALL)
target_compile_options(Jolt PRIVATE ${engine_flags} -w)
target_sources(engine_contestants PRIVATE jolt.cpp)
target_include_directories(engine_contestants SYSTEM PRIVATE ${CURTAIN_BENCH_JOLT})
target_link_libraries(engine_contestants PRIVATE Jolt)
