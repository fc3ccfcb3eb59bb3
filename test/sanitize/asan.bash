# Sourced by run. Also with floating-point traps: the build is a Debug one. -O1: a fifth of the time to run of -O0, and hardly more
# to build. The engine is watched and not its tests, which take as long to build.
configure Debug "-O1 -g1" -DCURTAIN_SANITIZE=address,undefined,float-cast-overflow -DCURTAIN_PRECOMPILED=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON
# Not the torture suite nor the properties: minutes of stepping that the made-up scenes of test/fuzz do in seconds.
cmake --build "$build" --target curtain_batch test_scene test_cloth test_forces test_solver test_contact test_simulator test_batch test_fuzz
export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS=suppressions=$here/lsan.supp
# Suites that take seconds without a sanitizer and a minute with it; what they run is also in the made-up scenes of test/fuzz.
export GTEST_FILTER=${GTEST_FILTER:--SelfContact.*:Shots/Impact.*:FineSurface.*:Rest.*:GustNoise.*:CcdDegenerate.*}
run_ctest -R "^test_(scene|cloth|forces|solver|contact|simulator|batch|fuzz)$" "$@"
