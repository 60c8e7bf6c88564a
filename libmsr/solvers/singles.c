/* singles.c - factors and their use pair by pair, as factor.c and substitute.c tell: each mass
 * waits for the one before, so what it needs of others is summed first, the nearest one last. */
#include "solvers/singles.h"

static inline const double *lower_of(const msri_stiffness *a, size_t pair, double l[4]) {
  for (size_t e = 0; e < 4; e++) l[e] = (double)a->lower[4 * pair + e];
  return l;
}

/* L of a pair, and what elimination leaves to its second mass. */
static void eliminate(const msri_stiffness *a, size_t p, double dxx, double dxy, double dyy) {
  const size_t i = a->graph->strip[p].first, j = a->graph->strip[p].second;
  const double xx = a->tie.xx[p], xy = a->tie.xy[p], yy = a->tie.yy[p];
  const double ixx = a->pivot.xx[i], ixy = a->pivot.xy[i], iyy = a->pivot.yy[i];
  const double lxx = xx * ixx + xy * ixy, lxy = xx * ixy + xy * iyy;
  const double lyx = xy * ixx + yy * ixy, lyy = xy * ixy + yy * iyy;
  const double rxx = dxx - xx, rxy = dxy - xy, ryy = dyy - yy;
  float *l = a->lower + 4 * p;
  l[0] = (float)lxx, l[1] = (float)lxy, l[2] = (float)lyx, l[3] = (float)lyy;
  a->pivot.xx[j] += lxx * rxx + lxy * rxy;
  a->pivot.xy[j] += (lxx * rxy + lxy * ryy + lyx * rxx + lyy * rxy) / 2;
  a->pivot.yy[j] += lyx * rxy + lyy * ryy;
}

void msri_singles_factorise(msri_stiffness *a) {
  const msri_graph *g = a->graph;
  for (size_t i = 0, p = 0, end; i < g->n; i++, p = end) {
    double xx = a->pivot.xx[i], xy = a->pivot.xy[i], yy = a->pivot.yy[i];
    for (end = p; end < g->pairs && g->strip[end].first == i; end++)
      xx += a->tie.xx[end], xy += a->tie.xy[end], yy += a->tie.yy[end];
    if (a->held) msri_stiffness_weigh_down(a, i, &xx, &yy);
    const double scale = 1 / (xx * yy - xy * xy);
    a->pivot.xx[i] = yy * scale;
    a->pivot.xy[i] = -xy * scale;
    a->pivot.yy[i] = xx * scale;
    for (size_t s = p; s < end; s++) eliminate(a, s, xx, xy, yy);
  }
}

void msri_singles_forward(const msri_stiffness *a, size_t from, size_t to, double *z) {
  const msri_graph *g = a->graph;
  const size_t end = to > 0 ? g->block[to - 1].pair : 0;
  double *zx = z, *zy = z + g->n, memory[4];
  for (size_t p = from > 0 ? g->block[from - 1].pair : 0; p < end; p++) {
    const size_t i = g->strip[p].first, j = g->strip[p].second;
    const double *l = lower_of(a, p, memory), x = zx[i], y = zy[i];
    zx[j] += l[0] * x + l[1] * y;
    zy[j] += l[2] * x + l[3] * y;
  }
}

/* z of mass i, whose pairs end there, and its share of r D^-1 r; returns where they begin. */
static inline size_t substitute(const msri_stiffness *a, size_t i, size_t end, double *z,
                                double *rz) {
  const msri_graph *g = a->graph;
  const double *zx = z, *zy = z + g->n, rx = zx[i], ry = zy[i];
  double x = a->pivot.xx[i] * rx + a->pivot.xy[i] * ry, memory[4];
  double y = a->pivot.xy[i] * rx + a->pivot.yy[i] * ry;
  *rz += rx * x + ry * y;
  size_t p = end;
  for (; p > 0 && g->strip[p - 1].first == i; p--) {
    const size_t j = g->strip[p - 1].second;
    const double *l = lower_of(a, p - 1, memory);
    x += l[0] * zx[j] + l[2] * zy[j];
    y += l[1] * zx[j] + l[3] * zy[j];
  }
  z[i] = x;
  z[g->n + i] = y;
  if (a->held) msri_stiffness_loosen(a, i, i + 1, z);
  return p;
}

/* y = A z of mass i, but for what comes before, by its pairs p .. end - 1; returns its z y. */
static inline double pull(const msri_stiffness *a, size_t i, size_t p, size_t end, const double *z,
                          double *y) {
  const size_t n = a->graph->n;
  const double m = a->m[i * a->m_stride], zx = z[i], zy = z[n + i];
  double sx = m * zx, sy = m * zy, sum = zx * sx + zy * sy;
  for (; p < end; p++) {
    const size_t j = a->graph->strip[p].second;
    const double dx = zx - z[j], dy = zy - z[n + j];
    const double fx = a->tie.xx[p] * dx + a->tie.xy[p] * dy;
    const double fy = a->tie.xy[p] * dx + a->tie.yy[p] * dy;
    sx += fx;
    sy += fy;
    sum += dx * fx + dy * fy;
    y[j] -= fx;
    y[n + j] -= fy;
  }
  y[i] = sx;
  y[n + i] = sy;
  return sum;
}

msri_sums msri_singles_backward(const msri_stiffness *a, double *z, double *y) {
  msri_sums sums = {{{0}}, {{0}}};
  size_t end = a->graph->pairs;
  for (size_t i = a->graph->n; i-- > 0;) {
    const size_t lane = i % MSRI_LANES, p = substitute(a, i, end, z, &sums.rz.sum[lane]);
    sums.zy.sum[lane] += pull(a, i, p, end, z, y);
    end = p;
  }
  return sums;
}
