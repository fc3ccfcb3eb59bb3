# The gathered curtain: distance from the finest run against time.
T = "gusts.csv"
set logscale xy
set yrange [1e-6:10]
set format y "10^{%T}"
set ylabel "RMS distance from the finest run after 1 s [m]"
set xlabel "computing time a frame, median [ms]"
W = "gusts_motion.csv"
do for [s in "gusts steady"] {
  set output FOLDER."/".(s eq "gusts" ? "gusts" : "gusts_steady").".png"
  M = values(T, is(1, s), 2)
  set title "gathered curtain in a ".(s eq "gusts" ? "gusting" : "steady")." fan, 44 x 40: our methods against the finest run"
  joined(m) = sprintf("< awk -F, -v OFS=, 'NR==FNR {if ($4==1) e[$1,$2,$3]=$5; next} $1==\"%s\" && $2==\"%s\" {print $4, e[$1,$2,$3]}' '%s/%s' '%s/%s' | sort -t, -k1,1g", s, m, FOLDER, W, FOLDER, T)
  plot for [i=words(M):1:-1] joined(word(M, i)) using 1:2 with linespoints pt mark(word(M, i), i) ps 1.3 \
         lw width(word(M, i)) lc rgb colour(word(M, i), i) title label(word(M, i))
}
