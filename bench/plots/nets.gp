# Nets at rest.
set output FOLDER."/nets.png"
T = "nets.csv"
M = values(T, "$4!=\"paper\"", 4)
set logscale y
set format y "10^{%T}"
set xrange [0.45:1.02]
set yrange [1e-10:1e-1]
set xlabel "span D (of the width)"
set ylabel "|E - E_{least}| / |E_{least}|"
set title "nets at rest: potential energy against the least there is" offset 10, 0
plot for [i=words(M):1:-1] rows(T, is(4, word(M, i)), 3) using 3:(abs($8)) with points pt mark(word(M, i), i) ps 1.3 \
       lw 1.5 lc rgb colour(word(M, i), i) title label(word(M, i))
