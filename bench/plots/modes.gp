# Frequencies of small oscillations.
set output FOLDER."/modes.png"
T = "modes.csv"
C = settings(T, "$2!=\"substeps 2\"")
set terminal pngcairo size 1200,950
set key below maxcols 2 font ",12" width 2
set logscale y
set format y "10^{%T}"
set yrange [1e-7:1]
set xrange [0.7:5.3]
set xtics 1
set xlabel "mode"
set ylabel "relative error of the frequency"
set title "small oscillations of the swing's chain"
plot for [i=words(C):1:-1] rows(T, is(1, first(word(C, i)))." && ".is(2, second(word(C, i))), 3) using 3:(abs($6)) \
       with linespoints pt mark(first(word(C, i)), i) ps 1.2 lw width(first(word(C, i))) \
       dashtype 1 + (second(word(C, i)) eq "default") lc rgb colour(first(word(C, i)), i) \
       title label(first(word(C, i))).", ".second(word(C, i))
