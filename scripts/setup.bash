# Shared by the two commands; source it. Installs what is missing, builds, and enters the built environment.
# The root of the package; works from a plain clone and from a catkin workspace's src alike.
curtain_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
curtain_build=${CURTAIN_BUILD:-$curtain_root/build}
# The system that packages are known for, or nothing.
curtain_system=$(
  source /etc/os-release 2>/dev/null || true
  case "$ID $VERSION_ID" in
    ('debian 11' | 'debian 12' | 'debian 13') echo "$VERSION_ID" ;;
    ('ubuntu 20.04') [ ! -f /opt/ros/noetic/setup.bash ] || echo noetic ;;
  esac
)
# A python3 from elsewhere in front breaks catkin, roslaunch and rospy.
if [ -n "$curtain_system" ]; then export PATH=/usr/bin:$PATH; fi
if [ "$curtain_system" = noetic ]; then source /opt/ros/noetic/setup.bash; fi

# Names this system's packages of the groups among its arguments: build, run, view, test (scripts/packages.txt).
curtain_packages() {
  awk -F '|' -v groups=" $* " -v release="$curtain_system" '
    !/^#/ && index(groups, " " substr($1, 1, index($1, " "))) {
      count = split(release == "noetic" ? $4 : $3, names, " ")
      for (i = 1; i <= count; ++i) {
        split(names[i], name, "@")
        if (name[1] != "-" && (name[2] == "" || name[2] == release) && !named[name[1]]++) print name[1]
      }
    }' "$curtain_root/scripts/packages.txt"
}

# Names the packages among its arguments that are not installed.
curtain_missing() {
  local package
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || echo "$package"
  done
}

# Names what a build needs and this machine does not have, where packages are not known.
curtain_lacks() {
  local command header
  for command in g++ cmake ninja python3 rospack roslaunch; do
    command -v "$command" >/dev/null || echo "$command"
  done
  for header in eigen3/Eigen/Core yaml-cpp/yaml.h assimp/scene.h tbb/task_arena.h tinyxml2.h nlohmann/json.hpp zlib.h; do
    echo "#include <$header>" | CPATH=${CPATH:-}:${CONDA_PREFIX:-}/include g++ -E -x c++ - >/dev/null 2>&1 || echo "$header"
  done
  awk -F ' *[|] *' '($1 == "build" || $1 == "run") && $4 ~ /^ros-/ {print $2}' "$curtain_root/scripts/packages.txt" | sort -u |
    while read -r package; do rospack find "$package" >/dev/null 2>&1 || echo "$package"; done
}

# Installs what is missing of the groups among its arguments, and of packages behind --.
curtain_install() {
  local groups=()
  while [ $# -gt 0 ] && [ "$1" != -- ]; do groups+=("$1"); shift; done
  shift $(($# > 0))
  if [ -z "$curtain_system" ]; then
    local lacks
    lacks=$(curtain_lacks | tr '\n' ' ')
    [ -n "$lacks" ] || return 0
    cat >&2 <<TEXT
This system's packages are not known here: they are on Debian 11, 12 and 13, and on Ubuntu 20.04 with ROS Noetic in /opt/ros/noetic.
Missing: $lacks
Once these are installed, this command goes on. Or, in a catkin workspace with this package in its src:
  rosdep install --from-paths src --ignore-src && catkin_make
TEXT
    return 1
  fi
  local missing
  mapfile -t missing < <(curtain_missing $(curtain_packages "${groups[@]}") "$@")
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
    -DPython3_EXECUTABLE="$(command -v python3)" "$@" >"$curtain_build/configure.log" 2>&1 ||
    { cat "$curtain_build/configure.log"; return 1; }
  sed -n 's/^-- curtain_sim: \(.*: no: .*\)/not built: \1/p' "$curtain_build/configure.log"
}

# Makes roslaunch, rosrun and the messages of this build known.
curtain_enter() {
  source "$curtain_build/devel/setup.bash"
  getent hosts "$(hostname)" >/dev/null 2>&1 || export ROS_HOSTNAME=localhost
  export ROSCONSOLE_STDOUT_LINE_BUFFERED=1
}
