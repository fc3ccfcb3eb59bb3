# Sourced by run. -O1: half the time to build of -O2 and a fifth of the time to run of -O0.
configure Debug "-O1 -g1 -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all -fno-omit-frame-pointer" \
  -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON
cmake --build "$build"
# Slow here and about accuracy, which is the same with and without a sanitizer: left to the usual build.
export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1
run_ctest "$@"
