# Memory of its own of the daemon in a soak over its hours, as SVG: awk -v speed= -f plot_memory.awk kills.txt memory.txt
function x(second) { return left + width * second / last }
function y(mb) { return top + height * (1 - mb / ceiling) }
FILENAME ~ /kills/ { killed[++kills] = $1; next }
{ second[++n] = $1; mb[n] = $2 / 1024; life[n] = $3; if (mb[n] > most) most = mb[n]; last = $1 }
END {
  left = 60; top = 40; width = 800; height = 260
  step = most > 80 ? 20 : most > 40 ? 10 : 5
  ceiling = step * (int(most / step) + 1)
  hours = last * speed / 3600
  print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 900 360\" font-family=\"sans-serif\" font-size=\"13\">"
  print "<rect width=\"900\" height=\"360\" fill=\"#fff\"/>"
  print "<text x=\"60\" y=\"22\" font-size=\"15\">Memory of imunoised; dashed: killed and started again</text>"
  for (v = 0; v <= ceiling; v += step) {
    printf "<line x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>", left, left + width, y(v), y(v)
    printf "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%d MB</text>\n", left - 6, y(v) + 4, v
  }
  every = hours > 12 ? 4 : hours > 3 ? 1 : 0.25
  for (h = 0; h <= hours + 1e-9; h += every)
    printf "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%g h</text>\n", x(h * 3600 / speed), top + height + 20, h
  printf "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">time of the accelerated device</text>\n", left + width / 2, top + height + 40
  for (k = 1; k <= kills; ++k)
    printf "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#b33\" stroke-dasharray=\"4 3\"/>\n", x(killed[k]), x(killed[k]), top, top + height
  for (i = 1; i <= n; ++i) {
    if (life[i] != life[i - 1]) printf "%s<polyline fill=\"none\" stroke=\"#246\" stroke-width=\"1.5\" points=\"", (i > 1 ? "\"/>\n" : "")
    printf "%.1f,%.1f ", x(second[i]), y(mb[i])
  }
  print "\"/>\n</svg>"
}
