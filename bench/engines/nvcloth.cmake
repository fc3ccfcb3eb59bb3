# NvCloth for the processor alone, without its profiler and asserts.
set(nvcloth ${CURTAIN_BENCH_NVCLOTH}/NvCloth)
file(GLOB nvcloth_sources ${nvcloth}/src/*.cpp ${nvcloth}/src/ps/unix/PsUnixAtomic.cpp ${nvcloth}/extensions/src/*.cpp)
if(NOT nvcloth_sources)
  message(FATAL_ERROR "no sources of NvCloth in ${CURTAIN_BENCH_NVCLOTH}")
endif()
file(STRINGS ${nvcloth}/ReleaseNotes.txt version REGEX "^[0-9]+[.][0-9.]+$" LIMIT_COUNT 1)
add_library(nvcloth STATIC ${nvcloth_sources})
target_include_directories(nvcloth SYSTEM PUBLIC ${nvcloth}/include ${nvcloth}/extensions/include
  ${CURTAIN_BENCH_NVCLOTH}/PxShared/include)
target_include_directories(nvcloth SYSTEM PRIVATE ${nvcloth}/src)
target_compile_definitions(nvcloth PUBLIC NV_CLOTH_IMPORT= NDEBUG
  PRIVATE NV_CLOTH_ENABLE_CUDA=0 NV_CLOTH_ENABLE_DX11=0 PX_PHYSX_CORE_EXPORTS)
# It writes vectors as numbers: without that flag g++ drops such writes, and with them collisions with spheres.
target_compile_options(nvcloth PRIVATE ${engine_flags} -fno-strict-aliasing -w)
target_sources(engine_contestants PRIVATE nvcloth.cpp)
target_link_libraries(engine_contestants PRIVATE nvcloth)
