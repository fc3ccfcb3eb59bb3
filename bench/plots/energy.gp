# Energy over time.
set output FOLDER."/energy.png"
T = "energy.csv"
C = settings(T, "1")
set terminal pngcairo size 1200,950
set key below maxcols 2 font ",12" width 2
set logscale y
set format y "10^{%T}"
set yrange [1e-8:1000]
set xlabel "time [s]"
set ylabel "|E(t) - E(0)| / (E(0) - E(rest))"
set title "energy of the undamped swing"
set key font ",12"
plot for [i=words(C):1:-1] rows(T, is(1, first(word(C, i)))." && ".is(2, second(word(C, i))), 3) using 3:(abs($4)) \
       with lines lw width(first(word(C, i))) dashtype i % 2 + 1 lc rgb colour(first(word(C, i)), i) \
       title label(first(word(C, i))).", ".second(word(C, i))
