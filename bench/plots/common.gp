# Shared by all pictures. Given on gnuplot's command line: FOLDER, which holds the tables and gets the pictures, and OURS,
# the names of our methods.
set datafile separator comma
set datafile missing "nan"
set terminal pngcairo size 1200,800 font "DejaVu Sans,15" background rgb "white"
set grid xtics ytics lt 1 lw 1 lc rgb "#dddddd"
set key outside right top spacing 1.25 samplen 2.5
set border 3
set tics nomirror
# Rows of a table that meet a condition in awk's words, in the order of a column.
rows(table, condition, column) = \
  sprintf("< awk -F, 'NR>1 && (%s)' '%s/%s' | sort -t, -k%d,%dg", condition, FOLDER, table, column, column)
# The values of a column, each once and in quotes, for words() and word(); only rows that meet a condition.
values(table, condition, column) = system(sprintf( \
  "awk -F, 'NR>1 && (%s) && !seen[$%d]++ {printf \"\\\"%%s\\\" \", $%d}' '%s/%s'", condition, column, column, FOLDER, table))
is(column, value) = sprintf("$%d==\"%s\"", column, value)
# A method looks the same in every picture; one that is not listed gets a colour by its place.
colour(m, i) = m eq "auto" ? "#d62728" : m eq "leapfrog" ? "#ff7f0e" : m eq "implicit" ? "#e377c2" : \
  m eq "paper" ? "#8c564b" : m eq "symplectic Euler" ? "#2ca02c" : m eq "Runge-Kutta 4" ? "#bcbd22" : \
  m eq "Baraff-Witkin" ? "#9467bd" : m eq "PBD" ? "#17becf" : m eq "XPBD" ? "#1f77b4" : \
  m eq "btSoftBody" ? "#555555" : word("#000000 #006400 #8b0000 #00008b", i % 4 + 1)
mark(m, i) = m eq "auto" ? 7 : m eq "leapfrog" ? 6 : m eq "implicit" ? 5 : m eq "paper" ? 2 : \
  m eq "symplectic Euler" ? 9 : m eq "Runge-Kutta 4" ? 8 : m eq "Baraff-Witkin" ? 13 : m eq "PBD" ? 4 : \
  m eq "XPBD" ? 11 : m eq "btSoftBody" ? 12 : 14 + i % 2
ours(m) = strstrt(" ".OURS." ", " ".m." ") > 0
label(m) = ours(m) ? "ours: ".m : m
width(m) = ours(m) ? 3 : 1.8
# Methods with their settings, the first two columns of a table, as "method, setting"; only rows that meet a condition.
settings(table, condition) = system(sprintf( \
  "awk -F, 'NR>1 && (%s) {c = $1 \", \" $2; if (!seen[c]++) printf \"\\\"%%s\\\" \", c}' '%s/%s'", condition, FOLDER, table))
first(c) = c[1:strstrt(c, ", ") - 1]
second(c) = c[strstrt(c, ", ") + 2:strlen(c)]
