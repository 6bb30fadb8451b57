# SPDX-License-Identifier: MIT
"""hyperelastic.py N: what dolfinx takes to assemble residual and tangent of compressible neo-Hooke on N^3 hexahedra of the
unit cube, 2x2x2 points, kernels compiled with -O3 -march=native -ffast-math, into its compressed rows. Prints the
version, the least CPU seconds of several runs, u . f and u . K u for the displacement of bench/support/kernel_time.hpp.
Nothing where dolfinx is not there: exit 3.
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
domain = mesh.create_unit_cube(MPI.COMM_SELF, n, n, n, mesh.CellType.hexahedron)
space = fem.VectorFunctionSpace(domain, ("CG", 1))
u, v, du = fem.Function(space), ufl.TestFunction(space), ufl.TrialFunction(space)
u.interpolate(lambda x: np.stack([0.1 * x[0] * x[1] + 0.05 * x[2], 0.08 * x[1] * x[2], -0.06 * x[0] * x[2]]))
mu, lam = fem.Constant(domain, 80e3), fem.Constant(domain, 120e3)
F = ufl.Identity(3) + ufl.grad(u)
ln_J = ufl.ln(ufl.det(F))
energy = mu / 2 * (ufl.inner(F, F) - 3) - mu * ln_J + lam / 2 * ln_J ** 2
dx = ufl.dx(metadata={"quadrature_degree": 3})
options = {"cffi_extra_compile_args": ["-O3", "-march=native", "-ffast-math"]}
residual = ufl.derivative(energy * dx, u, v)
forces = fem.form(residual, jit_params=options)
tangent = fem.form(ufl.derivative(residual, u, du), jit_params=options)
K, f = assembly.create_matrix(tangent), assembly.create_vector(forces)
best = float("inf")
for _ in range(3):
    start = time.process_time()
    K.zeroEntries()
    assembly.assemble_matrix(K, tangent)
    K.assemble()
    with f.localForm() as local:
        local.set(0)
    assembly.assemble_vector(f, forces)
    best = min(best, time.process_time() - start)
Ku = f.duplicate()
K.mult(u.vector, Ku)
print("dolfinx", dolfinx.__version__, best, repr(u.vector.dot(f)), repr(u.vector.dot(Ku)))
