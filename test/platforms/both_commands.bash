# Sourced by run: what a newcomer types, in front of a display of its own. Sets the columns of the row.
inside "apt-get install -y -qq --no-install-recommends xvfb xdotool imagemagick ${compiler[*]}" >>"$root.log" 2>&1
system="$(. "$root/etc/os-release"; echo "$NAME" | cut -d ' ' -f 1) $(cat "$root/etc/debian_version"), $(inside "${compiler[0]} -dumpfullversion" | sed 's/^/g++ /')"

display=:$((90 + $(printf %s "$name" | cksum | cut -c 1-3) % 1000))  # systems may be tried side by side
inside "Xvfb $display -screen 0 1280x900x24 -nolisten tcp" >/dev/null 2>&1 &
begin=$(date +%s)
inside "curtain_sim/scripts/demo" >"$root.demo.log" 2>&1 &
demo=$!
installed=$begin shown=
until [ -n "$shown" ] || ! kill -0 $demo 2>/dev/null; do
  sleep 1
  if [ "$installed" = "$begin" ] && [ -e "$root/root/curtain_sim/build/CMakeCache.txt" ]; then installed=$(date +%s); fi
  if inside "xdotool search --onlyvisible --name 'RViz$'" >/dev/null 2>&1; then shown=$(date +%s); fi
done
sleep 10
inside "import -window root demo.png" || true
mv "$root/root/demo.png" "$root.demo.png" || true
interrupt_inside bin/roslaunch
wait $demo || true
interrupt_inside "Xvfb $display"
if [ -z "$shown" ]; then
  tail -30 "$root.demo.log" >&2
  built="no window"
elif [ -n "$again" ]; then
  built="shown, not timed"
else
  built="$(minutes $((installed - begin))) + $(minutes $((shown - installed)))"
fi

display=
begin=$(date +%s)
failed=0
inside "curtain_sim/scripts/test" >"$root.test.log" 2>&1 || failed=1
counts=$(tail -n 1 "$root.test.log")
skipped=$(grep -c 'Not Run\|Skipped' "$root/root/curtain_sim/build/ctest.log" || true)
tests="$counts, $skipped skipped; $([ -n "$again" ] && echo "not timed" || minutes $(($(date +%s) - begin)))"
states=$(inside "curtain_sim/test/golden/check curtain_sim/build/*/lib/curtain_sim/curtain_batch" | tail -n 1 | sed 's/ states are the golden ones//') || failed=1
[ -n "$shown" ] || failed=1
