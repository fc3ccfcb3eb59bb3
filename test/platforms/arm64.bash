# Sourced by run: the engine for arm64, cross-compiled, and run by qemu. Sets the columns of the row.
inside "dpkg --add-architecture arm64; apt-get update -qq
  apt-get install -y -qq --no-install-recommends g++-aarch64-linux-gnu cmake ninja-build make qemu-user python3 libeigen3-dev nlohmann-json3-dev \
    libyaml-cpp-dev:arm64 libassimp-dev:arm64 libtbb-dev:arm64 zlib1g-dev:arm64 libtinyxml2-dev:arm64 libgtest-dev:arm64 libgmock-dev:arm64" >>"$root.log" 2>&1
compiler=(aarch64-linux-gnu-g++ aarch64-linux-gnu-gcc)
system="Debian $(cat "$root/etc/debian_version") for arm64, $(inside "${compiler[0]} -dumpfullversion" | sed 's/^/g++ /')"
quick=(scene cloth step parts)  # contact's take an hour in emulation; the golden states have contact of each kind
begin=$(date +%s)
failed=0
inside "cmake -S curtain_sim -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
    -DCMAKE_CROSSCOMPILING_EMULATOR=/usr/bin/qemu-aarch64 -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON -DCURTAIN_PYTHON=OFF -DCURTAIN_UNITY=ON
  cmake --build build --target curtain_batch ${quick[*]/#/test_}" >"$root.build.log" 2>&1 || { tail -30 "$root.build.log" >&2; exit 1; }
built="$(minutes $(($(date +%s) - begin))), engine alone"
begin=$(date +%s)
inside "ctest --test-dir build -j2 --output-on-failure -R '^test_($(IFS='|'; echo "${quick[*]}"))_'" >"$root.test.log" 2>&1 || failed=1
tests="$(awk '/tests failed out of/ {print $9 - $4 " passed, " $4 " failed"}' "$root.test.log"), the engine's quick ones; $(minutes $(($(date +%s) - begin)))"
states=$(inside "curtain_sim/test/golden/check -- qemu-aarch64 build/curtain_batch" | tail -n 1 | sed 's/ states are the golden ones//') || failed=1
