"""Finite elements of an edge crack in a plane, kept to make edge_crack_fe.json again: `python edge_crack_fe.py`.

Independent of the package: plane strain, 8-node quadrilaterals on a grid graded towards the tip and sheared along the
crack, quarter-point nodes at the tip, crack faces as two rows of nodes. Stress intensity is read off the displacement
between the faces, extrapolated to the tip. Half-planes reach 60 crack lengths, where they carry the tractions that a
line load has without a crack (Flamant); layers end at 1200 on a fixed edge and are loaded on the crack's faces. Faces
that touch: pair forces by projected Gauss-Seidel on the compliance between the faces, Coulomb's bound node by node.
"""

import json
from pathlib import Path

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

E, NU = 1.0, 0.3
REACH = 60.0
GAUSS = np.polynomial.legendre.leggauss(3)


def graded(first, growth, end):
    """Coordinates from 0 to end, the first step `first`."""
    count = int(np.ceil(np.log(1 + end * (growth - 1) / first) / np.log(growth)))
    steps = first * growth ** np.arange(count)
    return np.concatenate([[0.0], np.cumsum(steps) * end / steps.sum()])


class Plane:
    """A cracked plane: depth 1 of the crack's tip, its slope dx/dz, moduli by depth, layers end at interfaces."""

    def __init__(self, slope=0.0, layers=((REACH, 1.0),), first=2e-3, growth=1.12, free=True):
        reach = sum(one for one, _ in layers)
        side = graded(first, growth, reach)
        xs = np.concatenate([-side[:0:-1], side])
        up, edges = 1 - graded(first, growth, 1.0)[::-1], np.cumsum([one for one, _ in layers])
        down = 1 + graded(first, growth, reach - 1)
        for edge in edges[:-1]:
            down[np.abs(down - edge).argmin()] = edge
        zs = np.concatenate([up, down[1:]])
        self.tip, self.middle = len(up) - 1, len(side) - 1
        nx, nz = len(xs) - 1, len(zs) - 1
        # Nodes on the doubled grid; those above the tip in the middle column twice.
        number = np.full((2 * nz + 1, 2 * nx + 1), -1)
        rows, cols = np.mgrid[0 : 2 * nz + 1, 0 : 2 * nx + 1]
        there = ~((rows % 2 == 1) & (cols % 2 == 1))
        number[there] = np.arange(there.sum())
        fine_x, fine_z = (np.interp(np.arange(2 * len(one) - 1) / 2, np.arange(len(one)), one) for one in (xs, zs))
        x, z = np.meshgrid(fine_x, fine_z)
        t, m = 2 * self.tip, 2 * self.middle
        x[t, m + 1], x[t, m - 1] = fine_x[m + 2] / 4, fine_x[m - 2] / 4
        z[t + 1, m], z[t - 1, m] = 1 + (fine_z[t + 2] - 1) / 4, 1 - (1 - fine_z[t - 2]) / 4
        self.left = number[:t, m]
        extra = np.arange(t) + there.sum()
        self.right, self.tip_node = extra, number[t, m]
        self.depth = z[:t, m]
        where = np.concatenate([np.stack([x[there], z[there]], 1), np.stack([0 * self.depth, self.depth], 1)])
        self.slope, where[:, 0] = slope, where[:, 0] + slope * where[:, 1]
        self.nodes = where
        i, j = np.mgrid[0:nz, 0:nx]
        i, j = 2 * i.ravel(), 2 * j.ravel()
        corner = [(0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0)]
        cells = np.stack([number[i + a, j + b] for a, b in corner], axis=1)
        beside = (j == m) & (i < t)
        for k, (a, b) in enumerate(corner):
            if b == 0:
                at = beside & (i + a < t)
                cells[at, k] = extra[(i + a)[at]]
        self.cells = cells
        modulus = np.array([layers[int(np.searchsorted(edges, 0.5 * (zs[r] + zs[r + 1])))][1] for r in range(nz)])
        self.modulus = np.repeat(modulus, nx)
        self.number, self.size, self.free = number, (nx, nz), free
        self._solve()

    def _solve(self):
        shape = lambda r, s: np.array(  # noqa: E731
            [-(1 - r) * (1 - s) * (1 + r + s) / 4, -(1 + r) * (1 - s) * (1 - r + s) / 4,
             -(1 + r) * (1 + s) * (1 - r - s) / 4, -(1 - r) * (1 + s) * (1 + r - s) / 4,
             (1 - r * r) * (1 - s) / 2, (1 + r) * (1 - s * s) / 2, (1 - r * r) * (1 + s) / 2,
             (1 - r) * (1 - s * s) / 2])  # fmt: skip
        step = 1e-6
        elastic = (1 / ((1 + NU) * (1 - 2 * NU))) * np.array(
            [[1 - NU, NU, 0], [NU, 1 - NU, 0], [0, 0, (1 - 2 * NU) / 2]]
        )
        at = self.nodes[self.cells]
        stiffness = np.zeros((len(self.cells), 16, 16))
        for r, wr in zip(*GAUSS, strict=True):
            for s, ws in zip(*GAUSS, strict=True):
                slope = np.stack(
                    [(shape(r + step, s) - shape(r - step, s)), (shape(r, s + step) - shape(r, s - step))]
                ) / (2 * step)
                jacobian = np.einsum("an,end->ead", slope, at)
                d = np.einsum("eda,an->edn", np.linalg.inv(jacobian), slope)
                b = np.zeros((len(self.cells), 3, 16))
                b[:, 0, 0::2], b[:, 1, 1::2] = d[:, 0], d[:, 1]
                b[:, 2, 0::2], b[:, 2, 1::2] = d[:, 1], d[:, 0]
                area = np.abs(np.linalg.det(jacobian)) * wr * ws * self.modulus
                stiffness += np.einsum("eai,ab,ebj,e->eij", b, elastic, b, area, optimize=True)
        dof = (2 * self.cells[:, :, None] + np.arange(2)).reshape(len(self.cells), 16)
        rows, cols = np.repeat(dof, 16, axis=1).ravel(), np.tile(dof, (1, 16)).ravel()
        count = 2 * len(self.nodes)
        whole = coo_matrix((stiffness.ravel(), (rows, cols)), shape=(count, count)).tocsc()
        edge = np.unique(np.concatenate([self.number[:, 0], self.number[:, -1], self.number[-1]]))
        edge = edge[edge >= 0]
        if self.free:
            fixed = np.array([2 * self.number[-1, 0], 2 * self.number[-1, 0] + 1, 2 * self.number[-1, -1] + 1])
        else:
            fixed = np.concatenate([2 * edge, 2 * edge + 1])
        self.kept = np.setdiff1d(np.arange(count), fixed)
        self.count = count
        self.factors = splu(whole[self.kept][:, self.kept], permc_spec="MMD_AT_PLUS_A")

    def displacement(self, force):
        """Of forces (dof, ...)."""
        found = np.zeros_like(force)
        found[self.kept] = self.factors.solve(np.ascontiguousarray(force[self.kept]))
        return found

    def _along(self, line, traction, force, points=40):
        """Add tractions (2, n) = traction(x, z) along a line of nodes, corner, middle, corner, ..."""
        r, w = np.polynomial.legendre.leggauss(points)
        three = np.stack([-r * (1 - r) / 2, 1 - r * r, r * (1 + r) / 2])
        for k in range(0, len(line) - 2, 2):
            nodes = line[k : k + 3]
            where = three.T @ self.nodes[nodes]
            long = np.linalg.norm(self.nodes[nodes[2]] - self.nodes[nodes[0]]) / 2
            pull = traction(where[:, 0], where[:, 1])
            for axis in range(2):
                np.add.at(force, 2 * nodes + axis, (three * pull[axis] * w).sum(axis=1) * long)

    def surface_load(self, centre, half, shear, shape):
        """Forces of a pressure of mean 1 and shear times it along +x over [centre - half, centre + half]."""

        def pressure(x):
            u = (x - centre) / half
            inside = np.abs(u) < 1
            return np.where(inside, (4 / np.pi) * np.sqrt(np.maximum(1 - u**2, 0)) if shape == "hertz" else 1.0, 0.0)

        force = np.zeros(self.count)
        top = self.number[0].copy()
        m = 2 * self.middle
        for line in (top[: m + 1], np.concatenate([[self.right[0]], top[m + 1 :]])):
            self._along(line, lambda x, z: np.stack([shear * pressure(x), pressure(x)]), force, points=200)
        r, w = np.polynomial.legendre.leggauss(40)
        s, ws = centre + half * r, half * w * pressure(centre + half * r)

        def outside(normal):
            def traction(x, z):
                dx = x[:, None] - s
                radial = -2 / np.pi * (z[:, None] + shear * dx) / (dx**2 + z[:, None] ** 2) ** 2
                xx, zz, xz = ((radial * part * ws).sum(axis=1) for part in (dx**2, z[:, None] ** 2, dx * z[:, None]))
                return np.stack([xx * normal[0] + xz * normal[1], xz * normal[0] + zz * normal[1]])

            return traction

        across = np.array([1.0, -self.slope]) / np.hypot(1, self.slope)
        self._along(self.number[:, 0], outside(-across), force)
        self._along(self.number[:, -1], outside(across), force)
        self._along(self.number[-1], outside(np.array([0.0, 1.0])), force)
        return force

    def face_load(self, normal, shear):
        """Forces of tractions on the faces that the uncracked body would carry: functions of the depth."""
        force = np.zeros(self.count)
        for line, sign in ((self.left, -1.0), (self.right, 1.0)):
            self._along(
                np.append(line, self.tip_node),
                lambda x, z, sign=sign: sign * np.stack([normal(z), shear(z)]),
                force,
            )
        return force

    @property
    def frame(self):
        """Normal of the faces, from the left to the right one, and tangent towards the tip."""
        tangent = np.array([self.slope, 1.0]) / np.hypot(self.slope, 1.0)
        return np.array([[tangent[1], -tangent[0]], tangent])

    def between(self, displacement):
        """Relative displacement (2, n) of the faces, normal and tangential, from the mouth to the tip."""
        u = displacement.reshape(-1, 2)
        return self.frame @ (u[self.right] - u[self.left]).T

    def intensity(self, displacement):
        """K_I, K_II from the faces' displacement on the few elements next to the tip."""
        apart = self.between(displacement)[:, :-2:2][:, -7:]
        r = ((1 - self.depth) * np.hypot(1, self.slope))[:-2:2][-7:]
        told = apart * np.sqrt(2 * np.pi / r) * E / (1 - NU**2) / 8
        return [float(np.polynomial.polynomial.polyfit(r, one, 2)[0]) for one in told]

    def touching(self, displacement, friction):
        """Displacement with faces that neither pass through each other nor slip but against friction."""
        n = len(self.left)
        if not hasattr(self, "unit"):
            self.unit = np.zeros((self.count, 2 * n))
            for axis, vector in enumerate(self.frame):
                for k in range(n):
                    for part in range(2):
                        self.unit[2 * self.right[k] + part, axis * n + k] = vector[part]
                        self.unit[2 * self.left[k] + part, axis * n + k] = -vector[part]
            self.moved = self.displacement(self.unit)
            u = self.moved.reshape(-1, 2, 2 * n)
            apart = u[self.right] - u[self.left]
            self.compliance = np.concatenate([np.einsum("d,ndk->nk", one, apart) for one in self.frame])
        apart = self.between(displacement).ravel()
        force = np.zeros(2 * n)
        diagonal = np.diag(self.compliance)
        for _ in range(30_000):
            before = force.copy()
            for k in range(2 * n):
                own = force[k] - (apart[k] + self.compliance[k] @ force) / diagonal[k]
                bound = friction * force[k - n] if k >= n else 0.0
                force[k] = max(own, 0.0) if k < n else min(max(own, -bound), bound)
            if np.abs(force - before).max() <= 1e-9 * np.abs(force).max():
                break
        return displacement + self.moved @ force


def main():
    """All cases, and the file."""
    told = {"about": __doc__.splitlines()[0], "poisson": NU, "surface": [], "closed": [], "layers": []}
    for degrees in (0.0, 30.0):
        plane = Plane(np.tan(np.radians(degrees)))
        for shape, half, shear in (("hertz", 1.0, 0.0), ("hertz", 1.0, 0.4), ("strip", 2.0, 0.4)):
            for centre in (-4.0, -2.5, -1.2, 0.0, 0.8, 1.6, 2.5, 4.0):
                free = plane.displacement(plane.surface_load(centre, half, shear, shape))
                row = {"degrees": degrees, "shape": shape, "half": half, "shear": shear, "centre": centre}
                told["surface"].append({**row, "k": plane.intensity(free)})
                if shear and half == 1.0:
                    for friction in (0.0, 0.3):
                        shut = plane.touching(free, friction)
                        told["closed"].append({**row, "friction": friction, "k": plane.intensity(shut)})
                print(told["surface"][-1], flush=True)
    one = lambda z: np.ones_like(z)  # noqa: E731
    none = np.zeros_like
    for thickness, below in ((1.5, 0.1), (1.25, 0.02), (1.25, 5.0)):
        plane = Plane(layers=((thickness, 1.0), (20 * REACH, below)), free=False)
        for name, normal, shear in (("normal", one, none), ("shear", none, one), ("ramp", lambda z: z, none)):
            k = plane.intensity(plane.displacement(plane.face_load(normal, shear)))
            told["layers"].append({"thickness": thickness, "below": below, "load": name, "k": k})
            print(told["layers"][-1], flush=True)
    Path(__file__).with_suffix(".json").write_text(json.dumps(told, indent=0) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
