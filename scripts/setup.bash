# Shared by the two commands; source it. Installs what is missing, builds, and enters the built environment.
# The root of the package; works from a plain clone and from a catkin workspace's src alike.
curtain_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
curtain_build=${CURTAIN_BUILD:-$curtain_root/build}
export PATH=/usr/bin:$PATH  # a python3 from elsewhere in front breaks catkin, roslaunch and rospy

curtain_packages_build=(
  g++ make cmake ninja-build catkin ros-message-generation libroscpp-dev libroslib-dev libtf2-ros-dev libeigen3-dev
  libyaml-cpp-dev libassimp-dev libtbb-dev nlohmann-json3-dev zlib1g-dev libtinyxml2-dev libnodelet-dev libnodeletlib-dev
  libinteractive-markers-dev libdiagnostic-updater-dev libvisualization-msgs-dev ros-std-msgs ros-geometry-msgs
  libactionlib-dev ros-actionlib-msgs libsensor-msgs-dev libembree-dev libstd-srvs-dev libros-rosgraph-msgs-dev
  libdynamic-reconfigure-config-init-mutex-dev python3-dynamic-reconfigure liburdf-dev pybind11-dev python3-dev python3-numpy
  libtinygltf-dev librosbag-storage-dev)
curtain_packages_run=(python3-roslaunch libnodeletlib-tools tf2-tools rosbash python3-rospy python3-tf2-ros
  python3-visualization-msgs python3-rostopic python3-rosnode python3-actionlib-msgs python3-std-srvs python3-actionlib
  python3-sensor-msgs ros-robot-state-publisher python3-rosbag python3-paramiko parallel python3-yaml)
curtain_packages_view=(rviz librviz-dev)
curtain_packages_test=(libfcl-dev librostest-dev python3-rostest libgtest-dev libgmock-dev xvfb xdotool imagemagick libgl1-mesa-dri
  valgrind qemu-user catkin-lint clang-format-14 doxygen patch python3-diagnostic-msgs python3-rosmaster liburdfdom-tools
  libstd-srvs-dev python3-std-srvs libdepth-image-proc0d libpcl-ros-filters0d libimage-transport-dev mypy openssh-server
  openssh-client python3-matplotlib python3-h5py rsync)

# Installs the packages among its arguments that are missing.
curtain_install() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "installing: ${missing[*]}"
  local as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update -qq
  DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# Configures; arguments go to cmake.
curtain_configure() {
  mkdir -p "$curtain_build/devel/lib/python3/dist-packages"  # else the environment is cached without the messages
  touch "$curtain_build/CATKIN_IGNORE"
  cmake -S "$curtain_root" -B "$curtain_build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DPython3_EXECUTABLE=/usr/bin/python3 "$@" >"$curtain_build/configure.log" 2>&1 ||
    { cat "$curtain_build/configure.log"; return 1; }
}

# The same, and builds.
curtain_configure_and_build() {
  curtain_configure "$@"
  cmake --build "$curtain_build"
}

# Makes roslaunch, rosrun and the messages of this build known.
curtain_enter() {
  source "$curtain_build/devel/setup.bash"
  getent hosts "$(hostname)" >/dev/null 2>&1 || export ROS_HOSTNAME=localhost
  export ROSCONSOLE_STDOUT_LINE_BUFFERED=1
}
