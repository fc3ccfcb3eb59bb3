# Sourced by run. The threads of the solver; `tsan node`: the node, where catkin is there, told and asked everything that its own
# tests tell and ask it. Libraries are as Debian builds them, without ThreadSanitizer: see tsan.supp.
flags="-O1 -g1 -fsanitize=thread -fno-omit-frame-pointer"
export TSAN_OPTIONS="suppressions=$here/tsan.supp log_path=$build/race second_deadlock_stack=1"
rm -f "$build"/race.*
status=0
if [ "${1:-}" = node ]; then
  source "$root/scripts/setup.bash"
  curtain_build=$build/node
  CXXFLAGS=$flags curtain_configure -DCMAKE_BUILD_TYPE=Debug -DCATKIN_ENABLE_TESTING=ON ${CURTAIN_CMAKE:-}
  cmake --build "$curtain_build"
  curtain_enter
  export ROS_HOME=$curtain_build/ros_home
  for name in interface obstacles handles rest sensors; do
    # Their waits are for a node that is ten times as fast: what they find is not asked here, only what the sanitizer does.
    rostest "$root/test/ros/$name.test" || echo "$name: the test itself is too slow or fails"
  done
else
  configure Debug "$flags" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON
  cmake --build "$build" --target test_simulator
  TSAN_OPTIONS="$TSAN_OPTIONS exitcode=0" "$build/test_simulator" --gtest_filter='Scenes/ThreadCount.*' || status=1
fi
if ls "$build"/race.* >/dev/null 2>&1; then
  cat "$build"/race.*
  status=1
fi
echo "$((1 - status)) passed, $status failed"
exit $status
