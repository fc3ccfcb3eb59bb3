# The chain in the wind.
set output FOLDER."/wind.png"
T = "wind.csv"
M = values(T, "1", 2)
set logscale xy
set format y "10^{%T}"
set xrange [0.04:12]
set yrange [1e-8:10]
set xlabel "wind force over weight, r"
set ylabel "distance of the tip from its exact place / L"
set title "chain in the wind (Cheng 2000, Eq. 3)"
plot for [i=words(M):1:-1] rows(T, is(2, word(M, i)), 1) using 1:5 with linespoints pt mark(word(M, i), i) ps 1.3 \
       lw width(word(M, i)) lc rgb colour(word(M, i), i) title label(word(M, i))
