"""numba_peer.py DIRECTORY - mass-spring steps by Numba, as one would write them in Python. Pictures
are arrays without indices: each thread steps a band of rows in place, each spring once, into
buffers of a row; where pixels are missing, springs have a stiffness each, which may be 0. Meshes
gather over the springs of each mass. Lines on stdin ask for one thing at a time; each is answered
by a line "= NUMBER"."""
import os
import sys
import time

os.environ["NUMBA_CACHE_DIR"] = sys.argv[1]
print("pid", os.getpid(), flush=True)

import numba
import numpy as np

FAST = dict(error_model="numpy", fastmath=True, cache=True)
WIDE = dict(FAST, parallel=True)


@numba.njit(**FAST)
def pull(xa, ya, xb, yb, k, fx, fy):
    for i in range(len(fx)):
        dx = xb[i] - xa[i]
        dy = yb[i] - ya[i]
        f = k - k / np.sqrt(dx * dx + dy * dy)
        fx[i] = f * dx
        fy[i] = f * dy


@numba.njit(**FAST)
def pull_each(xa, ya, xb, yb, k, fx, fy):
    for i in range(len(fx)):
        dx = xb[i] - xa[i]
        dy = yb[i] - ya[i]
        f = k[i] - k[i] / np.sqrt(dx * dx + dy * dy)
        fx[i] = f * dx
        fy[i] = f * dy


@numba.njit(**FAST)
def move(x, u, left, right, above, below, h):
    for i in range(len(x)):
        u[i] += (right[i] - left[i]) + (below[i] - above[i])
        x[i] += h * u[i]


# `edge` holds the springs between bands, computed before anything moves.
@numba.njit(**WIDE)
def block(x, y, u, v, k, cut, row, down, edge, steps, h):
    bands = len(cut) - 1
    for _ in range(steps):
        for b in numba.prange(1, bands):
            at = cut[b]
            pull(x[at - 1], y[at - 1], x[at], y[at], k, edge[b, 0], edge[b, 1])
        for b in numba.prange(bands):
            down[b, 0] = edge[b]
            for r in range(cut[b], cut[b + 1]):
                old = (r - cut[b]) % 2
                new = 1 - old
                pull(x[r, :-1], y[r, :-1], x[r, 1:], y[r, 1:], k, row[b, 0, 1:-1], row[b, 1, 1:-1])
                if r + 1 < cut[b + 1]:
                    pull(x[r], y[r], x[r + 1], y[r + 1], k, down[b, new, 0], down[b, new, 1])
                else:
                    down[b, new] = edge[b + 1]
                move(x[r], u[r], row[b, 0, :-1], row[b, 0, 1:], down[b, old, 0], down[b, new, 0], h)
                move(y[r], v[r], row[b, 1, :-1], row[b, 1, 1:], down[b, old, 1], down[b, new, 1], h)


@numba.njit(**WIDE)
def picture(x, y, u, v, kr, kd, cut, row, down, edge, steps, h):
    bands = len(cut) - 1
    for _ in range(steps):
        for b in numba.prange(1, bands):
            at = cut[b] - 1
            pull_each(x[at], y[at], x[at + 1], y[at + 1], kd[at], edge[b, 0], edge[b, 1])
        for b in numba.prange(bands):
            down[b, 0] = edge[b]
            for r in range(cut[b], cut[b + 1]):
                old = (r - cut[b]) % 2
                new = 1 - old
                pull_each(x[r, :-1], y[r, :-1], x[r, 1:], y[r, 1:], kr[r],
                          row[b, 0, 1:-1], row[b, 1, 1:-1])
                if r + 1 < cut[b + 1]:
                    pull_each(x[r], y[r], x[r + 1], y[r + 1], kd[r],
                              down[b, new, 0], down[b, new, 1])
                else:
                    down[b, new] = edge[b + 1]
                move(x[r], u[r], row[b, 0, :-1], row[b, 0, 1:], down[b, old, 0], down[b, new, 0], h)
                move(y[r], v[r], row[b, 1, :-1], row[b, 1, 1:], down[b, old, 1], down[b, new, 1], h)


@numba.njit(**WIDE)
def mesh(x, y, u, v, first, other, k, steps, h):
    n = len(x)
    for _ in range(steps):
        for i in numba.prange(n):
            fx = 0.0
            fy = 0.0
            for s in range(first[i], first[i + 1]):
                dx = x[other[s]] - x[i]
                dy = y[other[s]] - y[i]
                f = k - k / np.sqrt(dx * dx + dy * dy)
                fx += f * dx
                fy += f * dy
            u[i] += fx
            v[i] += fy
        for i in numba.prange(n):
            x[i] += h * u[i]
            y[i] += h * v[i]


class Drawn:
    """A picture; what isn't there stays at its place."""

    def __init__(self, f, full, width, height, n, springs, threads, h, k):
        there = np.fromfile(f, bool, width * height).reshape(height, width)
        rows, columns = np.mgrid[0:height, 0:width]
        start = (columns + 0.5, height - rows - 0.5, np.zeros(there.shape), np.zeros(there.shape))
        for a in start:
            a[there] = np.fromfile(f, float, n)
        kr = k * (there[:, :-1] & there[:, 1:])
        kd = k * (there[:-1] & there[1:])
        cut = np.linspace(0, height, threads + 1).astype(np.int64)
        buffers = (np.zeros((threads, 2, width + 1)), np.zeros((threads, 2, 2, width)),
                   np.zeros((threads + 1, 2, width)))
        self.kernel = block if full else picture
        self.arguments = (*start, k, cut, *buffers) if full else (*start, kr, kd, cut, *buffers)
        self.there = there if not full else None
        self.h = h
        self.threads = threads

    def run(self, steps):
        numba.set_num_threads(self.threads)
        self.kernel(*self.arguments, steps, self.h)

    def positions(self):
        x, y = self.arguments[:2]
        return (x, y) if self.there is None else (x[self.there], y[self.there])


class Mesh:
    def __init__(self, f, full, width, height, n, springs, threads, h, k):
        i = np.fromfile(f, np.uint32, springs)
        j = np.fromfile(f, np.uint32, springs)
        here = np.concatenate((i, j))
        order = np.argsort(here, kind="stable")
        other = np.concatenate((j, i))[order].astype(np.int32)
        first = np.concatenate(([0], np.cumsum(np.bincount(here, minlength=n)))).astype(np.int32)
        start = [np.fromfile(f, float, n) for _ in range(4)]
        self.arguments = (*start, first, other, k)
        self.h = h
        self.threads = threads

    def run(self, steps):
        numba.set_num_threads(self.threads)
        mesh(*self.arguments, steps, self.h)

    def positions(self):
        return self.arguments[:2]


def open_work(n, path, kind, width, height, springs, threads, h, k):
    with open(path, "rb") as f:
        make = Drawn if int(kind) else Mesh
        return make(f, kind == "2", int(width), int(height), n, int(springs), int(threads),
                    float(h), float(k))


def bytes_of(arguments):
    return sum(a.nbytes for a in arguments if isinstance(a, np.ndarray))


def main():
    works = {}
    for line in sys.stdin:
        words = line.split()
        if not words:
            print(f"Numba {numba.__version__}", flush=True)
            continue
        question, number, count = words[0], int(words[1]), int(words[2])
        answer = 0
        if question == "open":
            works[number] = open_work(count, *words[3:])
            works[number].run(0)
            answer = bytes_of(works[number].arguments)
        elif question == "run":
            begin = time.perf_counter()
            works[number].run(count)
            answer = time.perf_counter() - begin
        elif question == "read":
            with open(words[3], "wb") as f:
                for a in works[number].positions():
                    a.tofile(f)
        else:
            del works[number]
        print("=", answer, flush=True)


main()
