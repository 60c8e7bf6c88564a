# figure.gp - a work-precision diagram for the report, from a CSV that `msr accuracy` wrote:
#     gnuplot -c figure.gp free.csv free.pdf
# Both axes logarithmic, a line per method; lower and further left is better.
csv = ARG1
set terminal pdfcairo size 16.3cm, 9cm enhanced font 'DejaVu Sans,8' fontscale 0.7
set output ARG2
set datafile separator ','

methods = system("awk -F, '!/^#|^method,/ { if ($1 != last) print last = $1 }' ".csv)
own = real(system("sed -n 's/^# reference error .*: //p' ".csv))
right = real(system("awk -F, '!/^#|^method,/ && $4 == 1 && $9 > most { most = $9 } END { print most + 0 }' ".csv))

# A method looks the same in every figure. Splittings and compositions are drawn through, Runge-Kutta
# and Adams dashed, implicit methods dotted.
through = 'symplectic-euler verlet pefrl srkn4 srkn6 kahan-li-6 kahan-li-8 '
dashed = 'euler rk4 rkf45 rkck rk8pd msadams '
dotted = 'backward-euler implicit-midpoint sdirk2 energy-momentum '
known = through.dashed.dotted
place(m) = sum [i = 1 : words(known)] (word(known, i) eq m ? i : 0)
dashes(m) = strstrt(' '.dashed, ' '.m.' ') ? 2 : strstrt(' '.dotted, ' '.m.' ') ? 3 : 1
array colour[9] = [0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00, 0x56b4e9, 0x000000, 0xb8a800, 0x8c510a]
array form[7] = [7, 5, 9, 11, 13, 6, 4]
tint(m) = colour[(place(m) + 8) % 9 + 1]
mark(m) = form[(place(m) + 6) % 7 + 1]

set logscale xy
set format '10^{%L}'
set tics nomirror
set grid linecolor '#dddddd' linetype 1 linewidth 0.5
set key outside right center vertical Left reverse noenhanced samplen 2.5 spacing 1.1
set xlabel 'largest error of a position [px]'
set ylabel 'time [ms]'
set autoscale yfix
set offsets 0, 0, graph 0.06, graph 0.06
set xrange [own / 4 : right * 6]
set arrow from own, graph 0 to own, graph 1 nohead dashtype 2 linecolor '#606060'
set label "the reference's own error" at own, graph 0.98 right rotate by 90 offset -0.9, 0 \
  textcolor '#606060' font ',7'

shown(m, error) = strcol(1) eq m && column(4) == 1 ? error : NaN
front = "< awk -F, '!/^#|^method,/ && $13 == 1 { print $9 \",\" 1e3 * $7 }' ".csv." | sort -g"
# At the right edge, at the time that its next stable run foretells.
unstable = "< awk -F, 'BEGIN { print \"-,NaN\" } !/^#|^method,/ " \
  ."{ if ($4 == 0) { m = $1; s = $2 } else if ($1 == m) { print m \",\" 1e3 * $7 * s / $2; m = \"\" } }' ".csv
explosions = int(system("awk -F, '!/^#|^method,/ && $4 == 0 { n++ } END { print n + 0 }' ".csv))
plot front using 1:2 with lines linewidth 8 linecolor '#d0d0d0' title 'Pareto front', \
  for [i = 1 : words(methods)] csv using (shown(word(methods, i), $9)):(1e3 * $7) \
    with linespoints linewidth 1.3 pointsize 0.6 linecolor rgb tint(word(methods, i)) \
    pointtype mark(word(methods, i)) dashtype dashes(word(methods, i)) title word(methods, i), \
  unstable using (right * 3):2:(tint(strcol(1))) with points pointtype 2 pointsize 0.7 \
    linecolor rgb variable notitle, \
  NaN with points pointtype 2 pointsize 0.7 linecolor '#000000' title explosions ? 'unstable' : ''
