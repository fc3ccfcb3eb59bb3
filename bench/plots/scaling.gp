# Time of a frame against the number of nodes.
T = "scaling.csv"
set logscale xy
set ylabel "computing time of a 60 Hz frame, median [ms]"
set xlabel "nodes"
set arrow 1 from graph 0, first 16.67 to graph 1, first 16.67 nohead dashtype 3 lc rgb "#888888"
set label 1 "real time" at graph 0.01, first 16.67 offset 0, 0.6 tc rgb "#888888"
set format x "10^{%T}"
do for [s in "swing curtain"] {
  set output FOLDER."/scaling_".s.".png"
  M = values(T, is(1, s)." && $2==\"both\"", 3)
  N = values(T, is(1, s), 5)
  set title s.": 16 x 15 to 400 x 250 nodes, default settings"
  plot for [n=1:words(N)] for [i=words(M):1:-1] \
         rows(T, is(1, s)." && $2==\"both\" && ".is(3, word(M, i))." && ".is(5, word(N, n)), 8) using 8:9 with linespoints \
         pt mark(word(M, i), i) ps 1.3 lw width(word(M, i)) dashtype n lc rgb colour(word(M, i), i) \
         title (n == 1 || ours(word(M, i)) ? label(word(M, i)).(words(N) > 1 ? ", threads ".word(N, n) : "") : "")
}
C = values(T, "$2!=\"both\"", 2)
if (words(C) > 0) {
  set output FOLDER."/scaling_shape.png"
  set title "default method: one side of the grid growing (the other is 44 rows or 40 columns)" offset 8, 0
  D = values(T, "1", 3)
  side(c) = c eq "rows" ? 2 : 1
  plot for [s in "swing curtain"] for [c in "columns rows"] \
         rows(T, is(1, s)." && ".is(2, c)." && ".is(3, word(D, 1))." && $5==1", 8) using 8:9 with linespoints \
         pt side(c) + 5 ps 1.3 lw 2.5 dashtype side(c) \
         lc rgb (s eq "swing" ? "#1f77b4" : "#d62728") title s.": ".c." growing"
}
