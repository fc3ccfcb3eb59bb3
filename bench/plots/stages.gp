# Time by stage.
T = "stages.csv"
set output FOLDER."/stages.png"
S = values(T, "1", 1)
G = values(T, "1", 2)
set style data histograms
set style histogram rowstacked
set style fill solid 0.9 border -1
set boxwidth 0.7
set yrange [0:1]
set ylabel "share of the computing time"
set xlabel ""
set title "time by stage, default method"
set key invert
plot for [k=1:words(G)] rows(T, is(2, word(G, k)), 9)  using 4:xtic(1) title word(G, k)
