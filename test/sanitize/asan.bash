# Sourced by run. Also with floating-point traps: the build is a Debug one. -O1: a fifth of the time to run of -O0, hardly more to
# build. The engine is watched and not its tests, which take as long to build.
# Not the torture suite nor the properties: minutes of stepping that the made-up scenes of test/fuzz do in seconds.
tests=(batch fuzz)
if [ "${1:-}" = quick ]; then
  shift
  not=null,alignment,pointer-overflow,object-size  # half of the time to build; where such pointers lead AddressSanitizer sees
else
  not=
  tests+=(scene cloth step contact parts simulator budget)
fi
configure Debug "-O1 -fno-omit-frame-pointer" -DCMAKE_CXX_FLAGS_DEBUG=-g1 -DCURTAIN_SANITIZE=address,undefined,float-cast-overflow \
  -DCURTAIN_SANITIZE_NOT="$not" -DCURTAIN_UNITY=ON -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON
cmake --build "$build" --target curtain_batch curtain_fit "${tests[@]/#/test_}"
export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS=suppressions=$here/lsan.supp
# Suites that take seconds without a sanitizer and minutes with it; what they run is also in the made-up scenes of test/fuzz.
left_out=SelfContact.*:Shots/Impact.*:FineSurface.*:Rest.*:GustNoise.*:CcdDegenerate.*
left_out=$left_out:Piercings.AgreeWithSamplesOfTheCloth:BudgetedSimulator.NoMethodTakesWhatItHasNotSolved
left_out=$left_out:Mesh.AnswersForTwoHundredThousandTriangles:Checkpoints.*
export GTEST_FILTER=${GTEST_FILTER:--$left_out}
# packaging_engine: this is the only build without catkin in CI.
run_ctest -R "^(test_($(IFS="|"; echo "${tests[*]}"))_.|packaging_engine)$" "$@"
