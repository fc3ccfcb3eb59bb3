# Order of our methods.
set output FOLDER."/slopes.png"
T = "slopes.csv"
M = values(T, "1", 1)
set logscale xy
set format y "10^{%T}"
set xtics (1, 2, 4, 8, 16, 32, 64, 128)
set xrange [0.9:150]
set xlabel "substeps a frame"
set ylabel "RMS position error after 1 s [m]"
set title "swing: the error of our methods against the step"
set yrange [1e-8:10]
plot for [i=words(M):1:-1] rows(T, is(1, word(M, i)), 2) using 2:3 with linespoints pt mark(word(M, i), i) ps 1.2 \
       lw width(word(M, i)) lc rgb colour(word(M, i), i) title label(word(M, i)), \
     [1:128] 0.1 / x dashtype 2 lc rgb "#999999" title "order 1", [1:128] 3e-3 / x**2 dashtype 3 lc rgb "#999999" title "order 2"
