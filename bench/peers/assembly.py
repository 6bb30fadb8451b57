# SPDX-License-Identifier: MIT
"""assembly.py N: what dolfinx takes to assemble linear tetrahedra on 6 N^3 cells of the unit cube, kernels compiled with
-O3 -march=native -ffast-math, into its compressed rows. Prints the version and the least CPU seconds of several runs: Laplacian,
convection-diffusion with a linear velocity, then the relative errors of int |grad u|^2 and of int w . grad u for linear
fields. Nothing where dolfinx is not there: exit 3.
"""
import sys
import time

try:
    import dolfinx
    import numpy as np
    import ufl
    from dolfinx import fem, mesh
    from dolfinx.fem import petsc as assembly
    from mpi4py import MPI
except ImportError:
    sys.exit(3)

n = int(sys.argv[1])
domain = mesh.create_unit_cube(MPI.COMM_SELF, n, n, n, mesh.CellType.tetrahedron)
space = fem.FunctionSpace(domain, ("CG", 1))
u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
w = fem.Function(fem.VectorFunctionSpace(domain, ("CG", 1)))
w.interpolate(lambda x: np.stack([x[1] - 2 * x[2], 0.3 + x[0], x[0]]))
nu = fem.Constant(domain, 0.07)
options = {"cffi_extra_compile_args": ["-O3", "-march=native", "-ffast-math"]}
field = fem.Function(space)
field.interpolate(lambda x: 1.5 * x[0] - 0.2 * x[1] + 0.8 * x[2])


def measure(form):
    compiled = fem.form(form, jit_params=options)
    A = assembly.create_matrix(compiled)
    best = float("inf")
    for _ in range(7):
        start = time.process_time()
        A.zeroEntries()
        assembly.assemble_matrix(A, compiled)
        A.assemble()
        best = min(best, time.process_time() - start)
    return best, A


laplacian, L = measure(ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx)
convection, C = measure((nu * ufl.inner(ufl.grad(u), ufl.grad(v)) + ufl.dot(w, ufl.grad(u)) * v) * ufl.dx)
y = field.vector.duplicate()
L.mult(field.vector, y)
energy = field.vector.dot(y) / (1.5 ** 2 + 0.2 ** 2 + 0.8 ** 2) - 1
C.mult(field.vector, y)
flux = y.sum() / (1.5 * -0.5 - 0.2 * 0.8 + 0.8 * 0.5) - 1
print("dolfinx", dolfinx.__version__, laplacian, convection, abs(energy), abs(flux))
