"""scipy_peer.py LIBRARY - solve_ivp on the deformed block, for scipy.c: prints the version of
SciPy, then reads lines `method tolerance`, writes q and v at T as doubles. The right-hand side is the library's."""
import ctypes
import sys
import warnings

import numpy
import scipy
from scipy.integrate import solve_ivp

warnings.simplefilter("ignore")  # rtol 0 becomes 100 eps
library = ctypes.CDLL(sys.argv[1])
library.peer_open.restype = ctypes.c_size_t
differentiate = library.peer_differentiate
differentiate.argtypes = [ctypes.c_void_p, ctypes.c_void_p]

end = ctypes.c_double()
start = numpy.empty(library.peer_open(ctypes.byref(end)))
library.peer_start(start.ctypes.data_as(ctypes.c_void_p))


def rhs(t, y):
    dy = numpy.empty_like(y)
    differentiate(y.ctypes.data, dy.ctypes.data)
    return dy


print(scipy.__version__, flush=True)
for line in sys.stdin:
    method, tolerance = line.split()
    run = solve_ivp(rhs, (0, end.value), start, method=method, rtol=0, atol=float(tolerance))
    y = run.y[:, -1] if run.success else numpy.full_like(start, numpy.nan)
    sys.stdout.buffer.write(numpy.ascontiguousarray(y).tobytes())
    sys.stdout.buffer.flush()
