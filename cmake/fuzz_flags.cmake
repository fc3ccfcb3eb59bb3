# What libFuzzer needs to see where an input leads, and what stops it where that is wrong: memory, undefined behaviour, and
# numbers that do not fit the integer that they are made into.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "CURTAIN_FUZZ needs clang (libFuzzer is a part of it): -DCMAKE_CXX_COMPILER=clang++")
endif()
add_compile_options(-fsanitize=fuzzer-no-link,address,undefined,float-cast-overflow -fno-sanitize-recover=all
  -fno-omit-frame-pointer -gline-tables-only)
add_link_options(-fsanitize=address,undefined,float-cast-overflow)
