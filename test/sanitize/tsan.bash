# Sourced by run. The solver's threads first: whatever is in the engine is built with ThreadSanitizer, oneTBB is not, see tsan.supp.
flags="-O1 -g1 -fsanitize=thread -fno-omit-frame-pointer"
export TSAN_OPTIONS="suppressions=$here/tsan.supp:halt_on_error=0:exitcode=66:second_deadlock_stack=1"
if [ "${1:-}" = node ]; then
  # The node, with catkin: the demo's scene with everything it is told and asked for, then an end as the user makes it.
  source "$root/scripts/setup.bash"
  curtain_build=$build/node
  curtain_configure_and_build -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS="$flags" -DCATKIN_ENABLE_TESTING=OFF ${CURTAIN_CMAKE:-}
  curtain_enter
  export ROS_HOME=$curtain_build/ros_home
  "$here/tsan_node" "$curtain_build"
  exit
fi
configure Debug "$flags" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON
cmake --build "$build" --target test_simulator
cd "$build"
status=0
"$build/test_simulator" --gtest_filter='Threads*:*Thread*' || status=$?
[ $status -eq 0 ] && echo "1 passed, 0 failed" || echo "0 passed, 1 failed"
exit $status
