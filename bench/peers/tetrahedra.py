# SPDX-License-Identifier: MIT
"""tetrahedra.py SURFACE.off PEER [LIMIT]: fills a closed surface with a peer's tetrahedra; LIMIT in seconds (20).

PEER: tetgen (tetgen -pYq1.4), gmsh (Delaunay, optimised), hxt (Gmsh's HXT, optimised), netgen (optimised), or the path
of fill_off, which is ours. All keep the triangles of the surface. Prints one line: peer-version, outcome, CPU seconds of
the meshing alone, tetrahedra, smallest dihedral angle, share of tetrahedra below 18 degrees, mean ratio, peak memory
above that of an idle peer [MB].
outcome: ok, error (it says so), crash (a signal), timeout, wrong (inverted cells, other volume, other border), absent.

tetrahedra.py --table FOLDER PEER...: runs the peers on all FOLDER/<family>-<number>.off (of soak_surfaces) and prints a
table of their outcomes, a row a family; each run goes to stderr.
"""
import glob
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

PEERS = ("tetgen", "gmsh", "hxt", "netgen")


def read_off(path):
    import numpy as np
    with open(path) as file:
        words = file.read().split()
    nodes, cells = int(words[1]), int(words[2])
    end = 4 + 3 * nodes
    return (np.array(words[4:end], float).reshape(-1, 3),
            np.array(words[end:end + 4 * cells], int).reshape(-1, 4)[:, 1:])


def megabytes():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def read_tetgen(base):
    import numpy as np
    points = np.loadtxt(base + ".1.node", skiprows=1, comments="#", ndmin=2)
    cells = np.loadtxt(base + ".1.ele", skiprows=1, comments="#", dtype=int, ndmin=2)
    return points[:, 1:4], cells[:, 1:5] - int(points[0, 0])


def run_ours(path, program):
    with tempfile.TemporaryDirectory() as folder:
        base = os.path.join(folder, "s")
        done = subprocess.run([program, path, base], capture_output=True, text=True)
        if done.returncode < 0:
            os.kill(os.getpid(), -done.returncode)
        if done.returncode != 0:
            sys.exit(1)
        figures = dict(line.split() for line in done.stdout.splitlines())
        return "tunica", float(figures["seconds"]), *read_tetgen(base), float(figures["peak"])


def run_tetgen(path):
    version = re.search(r"Version (\S+)", subprocess.run(["tetgen", "-h"], capture_output=True, text=True).stdout)
    # The peak of a process starts at that of the one that made it: a small one in between.
    measure = ("import os, sys; p = os.spawnvp(os.P_NOWAIT, 'tetgen', ['tetgen', '-pYq1.4', sys.argv[1]]); "
               "_, end, use = os.wait4(p, 0); print('peak', use.ru_maxrss, end)")
    tiny = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"
    with tempfile.TemporaryDirectory() as folder:
        base = os.path.join(folder, "s")
        with open(base + ".off", "w") as file:
            file.write(tiny)
        out, peak, end = [], [], 0
        for k in range(2):  # an idle one first
            if k == 1:
                shutil.copy(path, base + ".off")
            out = subprocess.run([sys.executable, "-S", "-c", measure, base + ".off"], capture_output=True,
                                 text=True).stdout
            kilobytes, end = map(int, re.search(r"peak (\d+) (\d+)", out).groups())
            peak.append(kilobytes / 1024)
        if end & 127:
            os.kill(os.getpid(), end & 127)
        if end != 0 or not os.path.exists(base + ".1.ele"):
            sys.exit(1)

        def seconds(label):
            return float(re.search(label + r" seconds:\s+(\S+)", out).group(1))

        return ("tetgen-" + (version.group(1) if version else "1"), seconds("Total running") - seconds("Output"),
                *read_tetgen(base), peak[1] - peak[0])


def run_gmsh(path, algorithm):
    import gmsh
    import numpy as np
    x, triangles = read_off(path)
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.Algorithm3D", algorithm)
    gmsh.option.setNumber("Mesh.Optimize", 1)
    gmsh.model.addDiscreteEntity(2, 1)
    gmsh.model.mesh.addNodes(2, 1, list(range(1, len(x) + 1)), x.ravel())
    gmsh.model.mesh.addElementsByType(1, 2, [], (triangles + 1).ravel())
    gmsh.model.geo.addSurfaceLoop([1], 1)
    gmsh.model.geo.addVolume([1], 1)
    gmsh.model.geo.synchronize()
    before, start = megabytes(), time.process_time()
    gmsh.model.mesh.generate(3)
    seconds, peak = time.process_time() - start, megabytes() - before
    tags, points, _ = gmsh.model.mesh.getNodes()
    cells = gmsh.model.mesh.getElementsByType(4)[1].reshape(-1, 4).astype(int)
    number = np.zeros(int(tags.max()) + 1, int)
    number[tags.astype(int)] = np.arange(len(tags))
    return "gmsh-" + gmsh.__version__, seconds, points.reshape(-1, 3), number[cells], peak


def run_netgen(path):
    import netgen.meshing as ng
    import numpy as np
    x, triangles = read_off(path)
    ng.SetMessageImportance(0)
    mesh = ng.Mesh()
    mesh.dim = 3
    ids = [mesh.Add(ng.MeshPoint(ng.Pnt(*map(float, p)))) for p in x]
    face = mesh.Add(ng.FaceDescriptor(bc=1, domin=1, surfnr=1))
    for t in triangles:
        mesh.Add(ng.Element2D(face, [ids[n] for n in t]))
    before, start = megabytes(), time.process_time()
    mesh.GenerateVolumeMesh(ng.MeshingParameters(grading=0.3, optsteps3d=3))
    seconds, peak = time.process_time() - start, megabytes() - before
    points = np.array([p.p for p in mesh.Points()])
    cells = np.array([[v.nr - 1 for v in e.vertices] for e in mesh.Elements3D()], int).reshape(-1, 4)
    return "netgen-6.2", seconds, points, cells, peak


def judge(path, x, cells):
    """ok or wrong, smallest dihedral [degrees], share below 18, mean ratio."""
    import numpy as np
    surface, triangles = read_off(path)
    p = x[cells]
    six = np.einsum("ij,ij->i", np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), p[:, 3] - p[:, 0])
    turned = six.sum() < 0  # the peers' orders of nodes differ
    six = -six if turned else six
    s = surface[triangles] - surface[triangles[0, 0]]
    enclosed = np.einsum("ij,ij->i", np.cross(s[:, 0], s[:, 1]), s[:, 2]).sum()
    faces = np.sort(np.concatenate([cells[:, f] for f in ([0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3])]), axis=1)
    _, count = np.unique(faces, axis=0, return_counts=True)
    fine = (six > 0).all() and abs(six.sum() - enclosed) < 1e-6 * enclosed and (count == 1).sum() == len(triangles)
    opposite = [np.cross(p[:, a] - p[:, c], p[:, b] - p[:, c]) for a, b, c in
                ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))]
    angles = [np.arctan2(np.linalg.norm(np.cross(m, n), axis=1), -np.einsum("ij,ij->i", m, n))
              for i, m in enumerate(opposite) for n in opposite[:i]]
    least = np.degrees(np.min(angles, axis=0))
    edges = sum(((p[:, i] - p[:, j]) ** 2).sum(axis=1) for i in range(4) for j in range(i))
    ratio = 12 * np.cbrt(9 * (np.maximum(six, 0) / 6) ** 2) / edges
    return "ok" if fine else "wrong", least.min(), (least < 18).mean(), ratio.mean()


def child(path, peer):
    try:
        if peer == "tetgen":
            name, seconds, x, cells, peak = run_tetgen(path)
        elif peer == "netgen":
            name, seconds, x, cells, peak = run_netgen(path)
        elif peer not in PEERS:
            name, seconds, x, cells, peak = run_ours(path, peer)
        else:
            name, seconds, x, cells, peak = run_gmsh(path, 1 if peer == "gmsh" else 10)
            name += "-" + peer
    except ImportError:
        sys.exit(3)
    if len(cells) == 0:
        sys.exit(1)
    outcome, least, share, ratio = judge(path, x, cells)
    print("result", name, outcome, "%.6g %d %.4g %.3g %.4f %.0f" % (seconds, len(cells), least, share, ratio, peak))


def run(path, peer, limit):
    """The line of a peer, always: it runs in a process of its own."""
    if shutil.which(peer) is None and (peer == "tetgen" or peer not in PEERS):
        return [peer, "absent"]
    process = subprocess.Popen([sys.executable, __file__, "--child", path, peer], stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, text=True, start_new_session=True)
    try:
        out, _ = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        process.communicate()
        return [peer, "timeout"]
    for line in out.splitlines():
        if line.startswith("result "):
            return line.split()[1:]
    return [peer, {3: "absent"}.get(process.returncode, "crash" if process.returncode < 0 else "error")]


def table(folder, peers):
    ends = {}
    for path in sorted(glob.glob(os.path.join(folder, "*.off"))):
        family = os.path.basename(path).rsplit("-", 1)[0].replace("_", " ")
        for peer in peers:
            words = run(path, peer, 20)
            ends.setdefault(family, {}).setdefault(peer, []).append(words[1])
            print(os.path.basename(path), peer, *words[1:], file=sys.stderr, flush=True)
    names = [peer if peer in PEERS else "tunica" for peer in peers]
    print("| family | surfaces | " + " | ".join(names) + " |")
    print("|---" * (2 + len(peers)) + "|")
    for family, of in ends.items():
        cells = []
        for peer in peers:
            kinds = [k for k in ("ok", "error", "crash", "timeout", "wrong", "absent") if k in of[peer]]
            cells.append(", ".join("%d %s" % (of[peer].count(k), k) for k in kinds))
        print("| %s | %d | %s |" % (family, len(of[peers[0]]), " | ".join(cells)))


if sys.argv[1] == "--child":
    child(sys.argv[2], sys.argv[3])
elif sys.argv[1] == "--table":
    table(sys.argv[2], sys.argv[3:])
else:
    print(*run(sys.argv[1], sys.argv[2], float(sys.argv[3]) if len(sys.argv) > 3 else 20))
