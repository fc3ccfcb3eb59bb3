# Error against computing time: the front of each method as a line, what it was chosen from as dots.
T = "work_precision.csv"
set logscale xy
set format y "10^{%T}"
set xlabel "computing time for one simulated second, one core [ms]"
set ylabel "RMS position error after 1 s [m]"
set arrow 1 from 1000, graph 0 to 1000, graph 1 nohead dashtype 3 lc rgb "#888888"
set label 1 "real time" at 1000, graph 0.02 rotate by 90 offset -0.7, 0 tc rgb "#888888"
set xrange [0.5:3000]
set yrange [1e-7:10]
title_of(s) = s eq "swing" ? "swing: 44 x 40 nodes, released straight at 45°" : \
  s eq "drop" ? "drop: 11 x 40 nodes, released straight at 90°" : s
do for [s in "swing drop"] {
  set output FOLDER."/work_precision_".s.".png"
  set title title_of(s)
  M = values(T, is(1, s), 2)
  plot for [i=1:words(M)] rows(T, is(1, s)." && ".is(2, word(M, i)), 6) using 6:4 with points pt 7 ps 0.35 \
         lc rgb colour(word(M, i), i) notitle, \
       for [i=words(M):1:-1] rows(T, is(1, s)." && $9==1 && ".is(2, word(M, i)), 6) using 6:4 with linespoints \
         pt mark(word(M, i), i) ps 1.1 lw width(word(M, i)) lc rgb colour(word(M, i), i) title label(word(M, i))
}
set output FOLDER."/work_precision_chains.png"
set terminal pngcairo size 1500,950 font "DejaVu Sans,13" background rgb "white"
unset arrow 1
unset label 1
unset title
set key off
set xlabel "ms for one second"
set ylabel "RMS error [m]" offset 1.5, 0
set xrange [0.02:3000]
set xtics 100
set format x "10^{%T}"
set yrange [1e-9:10]
set ytics 100
S = values(T, "$1 ~ /^chain_/", 1)." swing"
M = values(T, "1", 2)
panel(s) = s eq "swing" ? "43 rods (swing)" : substr(s, 7, strlen(s))." rods"
set multiplot layout 2, (words(S) + 2) / 2
do for [s in S] {
  set title panel(s)
  plot for [i=words(M):1:-1] rows(T, is(1, s)." && $9==1 && ".is(2, word(M, i)), 6) using 6:4 with linespoints \
         pt mark(word(M, i), i) ps 0.9 lw width(word(M, i)) lc rgb colour(word(M, i), i) title label(word(M, i))
}
unset title; unset border; unset tics; unset xlabel; unset ylabel; unset grid; unset logscale
set key inside center center
set xrange [0:1]; set yrange [0:1]
plot for [i=1:words(M)] NaN with linespoints pt mark(word(M, i), i) lw width(word(M, i)) lc rgb colour(word(M, i), i) \
     title label(word(M, i))
unset multiplot
