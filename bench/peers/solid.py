# SPDX-License-Identifier: MIT
"""solid.py CASE METHOD N: a solid of finite strain solved with dolfinx, for the curves of the scene `solids`.

CASE:   tube     the quarter of a slice of the thick tube of law (17) at the pressure of the inner stretch 1.10,
                 N cells through the wall, incompressible
        cook     Cook's membrane 1 mm thick, N x N x 1 cells, clamped at its left face, 1 N on its right one, its large
                 faces free; mu/2 (I1 - 3) + kappa/4 (J^2 - 1 - 2 ln J), mu 422.5 kPa, nu 0.3
        cook-i   the same in plane strain, quasi-incompressible: mu/2 (I1 - 3) + lambda/2 (J - 1)^2, mu 80.194 N/mm2,
                 lambda 400889.8 N/mm2, load 100 N/mm
METHOD: q1 q2 p1 p2 (displacements alone), q2q1 p2p1 (Taylor-Hood: displacements and pressures)
Prints: unknowns, measured value (tube: inner stretch; cook: rise of the upper right corner [mm]), CPU seconds of all
Newton steps (mesh, spaces, matrix and compiled forms made before), peak memory [MB], load steps, version. The cells of
the tube are bent as their displacements are: of degree 2 for q2 and p2.
The linear systems are solved by MUMPS. Nothing where dolfinx is not there: exit 3.
"""
import resource
import sys
import time

try:
    import basix
    import dolfinx
    import numpy as np
    import ufl
    from dolfinx import fem, mesh
    from dolfinx.fem import petsc as assembly
    from mpi4py import MPI
    from petsc4py import PETSc
except ImportError:
    sys.exit(3)


# Corners of a cell of a grid by offsets, first x: those of a hexahedron, and of its six tetrahedra about a diagonal.
HEXAHEDRON = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1), (1, 1, 1)]
TETRAHEDRA = [(0, 1, 3, 7), (0, 5, 1, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 4, 5, 7), (0, 6, 4, 7)]


def slab(cells, kind, degree, thickness, place):
    """The unit square, `thickness` high, as Lagrange cells of that degree with all their nodes moved by place(X)."""
    count = degree * np.array(cells) + 1
    grid = np.stack(np.meshgrid(*[np.arange(n) for n in count], indexing="ij"), axis=-1).reshape(-1, 3)
    X = grid / (count - 1.0) * [1, 1, thickness]
    kind = "hexahedron" if kind == "q" else "tetrahedron"
    element = basix.create_element(basix.ElementFamily.P, basix.cell.string_to_type(kind), degree,
                                   basix.LagrangeVariant.equispaced)
    corners = [range(8)] if kind == "hexahedron" else TETRAHEDRA
    offsets = []  # of the nodes of each cell of a box, in the order of the element
    for part in corners:
        a = np.array([HEXAHEDRON[k] for k in part])
        first = a[0]
        axes = a[[1, 2, 4]] - first if kind == "hexahedron" else a[1:] - first
        offsets.append(np.rint(degree * (first + element.points @ axes)).astype(int))
    boxes = degree * np.stack(np.meshgrid(*[np.arange(n) for n in cells], indexing="ij"), axis=-1).reshape(-1, 3)
    at = boxes[:, None, None, :] + np.array(offsets)[None]
    nodes = (at[..., 0] * count[1] + at[..., 1]) * count[2] + at[..., 2]
    shape = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell(kind, geometric_dimension=3), degree))
    return mesh.create_mesh(MPI.COMM_SELF, nodes.reshape(-1, nodes.shape[-1]), place(X), shape)


def solve(domain, method, energy, pressure_energy, fixed, load, steps):
    """Newton over load steps, halved when one fails: (u, dofs, seconds, load steps). load(u, v, t): virtual work."""
    degree = int(method[1])
    vector = ufl.VectorElement("CG", domain.ufl_cell(), degree)
    mixed = len(method) == 4
    space = fem.FunctionSpace(domain, ufl.MixedElement(vector, ufl.FiniteElement("CG", domain.ufl_cell(), 1))
                              if mixed else vector)
    w, test = fem.Function(space), ufl.TestFunction(space)
    u, p = ufl.split(w) if mixed else (w, None)
    v = ufl.split(test)[0] if mixed else test
    t = fem.Constant(domain, PETSc.ScalarType(0))
    dx = ufl.dx(metadata={"quadrature_degree": 2 * degree + (1 if degree > 1 else 0)})
    F = ufl.Identity(3) + ufl.grad(u)
    potential = (energy(F) + (pressure_energy(F, p) if mixed else 0)) * dx
    residual = ufl.derivative(potential, w, test) - load(u, v, F, t)
    options = {"cffi_extra_compile_args": ["-O3", "-march=native"]}
    forms = [fem.form(form, jit_params=options)
             for form in (residual, ufl.derivative(residual, w, ufl.TrialFunction(space)))]
    conditions = []
    for component, where in fixed:
        sub = space.sub(0).sub(component) if mixed else space.sub(component)
        facets = mesh.locate_entities_boundary(domain, 2, where)
        dofs = fem.locate_dofs_topological(sub, 2, facets)
        conditions.append(fem.dirichletbc(PETSc.ScalarType(0), dofs, sub))
    solver = PETSc.KSP().create(MPI.COMM_SELF)
    solver.setType("preonly")
    solver.getPC().setType("lu")
    solver.getPC().setFactorSolverType("mumps")
    A, b = assembly.create_matrix(forms[1]), assembly.create_vector(forms[0])
    dw = b.duplicate()

    def newton():
        first = None
        for _ in range(25):
            with b.localForm() as local:
                local.set(0)
            assembly.assemble_vector(b, forms[0])
            assembly.apply_lifting(b, [forms[1]], [conditions], [w.vector], scale=-1.0)
            fem.set_bc(b.array_w, conditions, w.x.array, -1.0)
            size = b.norm()
            first = first or size
            if not np.isfinite(size):
                return False
            if size < 1e-9 * first or size < 1e-13:
                return True
            A.zeroEntries()
            assembly.assemble_matrix(A, forms[1], conditions)
            A.assemble()
            solver.setOperators(A)
            solver.solve(b, dw)
            w.x.array[:] -= dw.array
        return False

    start, done, step, count = time.process_time(), 0.0, 1.0 / steps, 0
    while done < 1:
        before = w.x.array.copy()
        t.value = min(1.0, done + step)
        if newton():
            done, count = t.value, count + 1
        else:
            w.x.array[:] = before
            step /= 2
            if step < 1e-4:
                sys.exit("no equilibrium")
    seconds = time.process_time() - start
    shown = w.sub(0).collapse() if mixed else w
    return shown, space.dofmap.index_map.size_global * space.dofmap.index_map_bs, seconds, count


def isochoric(F):
    J = ufl.det(F)
    return J ** (-2.0 / 3) * ufl.inner(F, F) - 3


def tube(method, n):
    a, b, c10, c20, stretch = 5.0, 6.5, 0.174, 1.880, 1.10  # [mm, MPa]

    def place(X):
        r, angle = a + (b - a) * X[:, 0], 0.5 * np.pi * X[:, 1]
        return np.stack([r * np.cos(angle), r * np.sin(angle), X[:, 2]], axis=1)

    domain = slab([n, 4 * n, 1], method[0], int(method[1]), 1.0, place)
    outer = np.sqrt(stretch ** 2 * a * a + b * b - a * a) / b

    def primitive(l):
        s = l * l
        return 2 * c10 * (np.log(l) - 0.5 / s) + 4 * c20 * (0.5 * s - np.log(l) + 0.5 / s - 0.25 / s ** 2)

    pressure = primitive(stretch) - primitive(outer)
    kappa = 2e6 * c10
    inner = mesh.locate_entities_boundary(domain, 2, lambda x: np.hypot(x[0], x[1]) < a + 0.02 * (b - a) / n)
    tags = mesh.meshtags(domain, 2, np.sort(inner), np.ones(len(inner), np.int32))
    ds = ufl.ds(domain=domain, subdomain_data=tags)
    N = ufl.FacetNormal(domain)
    u, dofs, seconds, count = solve(
        domain, method, lambda F: c10 * isochoric(F) + c20 * isochoric(F) ** 2,
        lambda F, p: p * (ufl.det(F) - 1) - p * p / (2 * kappa),
        [(0, lambda x: np.abs(x[0]) < 1e-9), (1, lambda x: np.abs(x[1]) < 1e-9),
         (2, lambda x: np.abs(x[2]) < 1e-9), (2, lambda x: np.abs(x[2] - 1) < 1e-9)],
        lambda u, v, F, t: -t * pressure * ufl.dot(ufl.cofac(F) * N, v) * ds(1), 1)
    nodes = fem.locate_dofs_topological(u.function_space, 2, inner)
    x = u.function_space.tabulate_dof_coordinates()[nodes] + u.x.array.reshape(-1, 3)[nodes]
    X = u.function_space.tabulate_dof_coordinates()[nodes]
    return dofs, np.mean(np.hypot(x[:, 0], x[:, 1]) / np.hypot(X[:, 0], X[:, 1])), seconds, count


def cook(method, n, incompressible):
    mu, lam, load, thickness = (80.194, 400889.8, 100.0, 1.0) if incompressible else (
        422.5, 2 * 422.5 * 0.3 / 0.4, 1000.0, 1.0)  # [mN, mm, kPa]

    def place(X):
        x, bottom, height = 48 * X[:, 0], 44 * X[:, 0], 44 - 28 * X[:, 0]
        return np.stack([x, bottom + height * X[:, 1], X[:, 2]], axis=1)

    domain = slab([n, n, 1], method[0], 1, thickness, place)
    right = mesh.locate_entities_boundary(domain, 2, lambda x: np.abs(x[0] - 48) < 1e-6)
    tags = mesh.meshtags(domain, 2, np.sort(right), np.ones(len(right), np.int32))
    ds = ufl.ds(domain=domain, subdomain_data=tags)

    def energy(F):
        J = ufl.det(F)
        if incompressible and len(method) == 4:
            return 0.5 * mu * isochoric(F)
        if incompressible:
            return 0.5 * mu * isochoric(F) + 0.5 * lam * (J - 1) ** 2
        return 0.5 * mu * isochoric(F) + 0.25 * (lam + 2 * mu / 3) * (J * J - 1 - 2 * ufl.ln(J))

    u, dofs, seconds, count = solve(
        domain, method, energy, lambda F, p: p * (ufl.det(F) - 1) - p * p / (2 * lam),
        [(c, lambda x: np.abs(x[0]) < 1e-6) for c in range(3)] +
        [(2, lambda x: (np.abs(x[2]) < 1e-9) | (np.abs(x[2] - thickness) < 1e-9))] * incompressible,
        lambda u, v, F, t: t * load / 16 * v[1] * ds(1), 1)
    X = u.function_space.tabulate_dof_coordinates()
    tip = np.argmin(np.abs(X - [48, 60, 0]).sum(axis=1))
    return dofs, u.x.array.reshape(-1, 3)[tip, 1], seconds, count


if __name__ == "__main__":
    case, method, n = sys.argv[1], sys.argv[2], int(sys.argv[3])
    run = {"tube": lambda: tube(method, n), "cook": lambda: cook(method, n, False),
           "cook-i": lambda: cook(method, n, True)}[case]
    dofs, value, seconds, count = run()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(dofs, repr(float(value)), seconds, peak, count, "dolfinx-" + dolfinx.__version__)
