# SPDX-License-Identifier: Apache-2.0
"""The arm of the tutorial for robotics researchers by the recursive Newton-Euler equations (Luh, Walker and Paul, 1980),
written on their own: a chain of hinges whose links are parallel to the world's axes where all angles are zero."""
import math

GRAVITY = 9.81


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def plus(a, b, factor=1.0):
    return [x + factor * y for x, y in zip(a, b)]


def times(matrix, a):
    return [sum(x * y for x, y in zip(row, a)) for row in matrix]


def cylinder(mass, diameter, length):
    return mass * (diameter**2 / 16 + length**2 / 12), mass * diameter**2 / 8


class Arm:
    """Seven hinges about z and y in turn; all that the model file says, in metres and kilograms."""

    HINGES = (0.16, 0.36, 0.57, 0.78, 0.98, 1.18, 1.27)
    CENTRES = (0.26, 0.465, 0.675, 0.88, 1.08, 1.225, 1.335)

    def __init__(self, tool=2.0):
        sizes = ((6, 0.14, 0.2), (5, 0.13, 0.21), (4, 0.12, 0.21), (3, 0.11, 0.2), (2, 0.1, 0.2), (1.5, 0.09, 0.09))
        self.masses = [size[0] for size in sizes] + [tool]
        self.inertias = [(across, across, along) for across, along in (cylinder(*size) for size in sizes)]
        x, y, z = 0.06**2, 0.03**2, 0.13**2
        self.inertias.append((tool * (y + z) / 12, tool * (x + z) / 12, tool * (x + y) / 12))
        self.start = [math.radians(angle) for angle in (0, 30, 0, 80, 0, -20, 0)]

    def links(self, q):
        """Of each link: rotation, axis and place of its hinge, place of its centre."""
        turn, place, before = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0, 0.0, 0.0], 0.0
        for k, (hinge, centre, angle) in enumerate(zip(self.HINGES, self.CENTRES, q)):
            place = plus(place, [row[2] for row in turn], hinge - before)
            s, c = math.sin(angle), math.cos(angle)
            axis = [row[1 if k % 2 else 2] for row in turn]
            own = [[c, 0, s], [0, 1, 0], [-s, 0, c]] if k % 2 else [[c, -s, 0], [s, c, 0], [0, 0, 1]]
            turn = [[sum(row[i] * own[i][j] for i in range(3)) for j in range(3)] for row in turn]
            before = hinge
            yield turn, axis, place, plus(place, [row[2] for row in turn], centre - hinge)

    def place(self, q):
        """Centre of the tool and direction of its long side."""
        turn, _, _, centre = list(self.links(q))[-1]
        return centre, [row[2] for row in turn]

    def moments(self, q, qd, qdd, gravity=GRAVITY):
        """Moments of the hinges that give these accelerations."""
        links = list(self.links(q))
        w, dw, hinge, a = [0.0] * 3, [0.0] * 3, [0.0] * 3, [0.0, 0.0, gravity]
        force, about = [0.0] * 3, [0.0] * 3  # of all links so far, the moment about the origin
        sums = []
        for k, (turn, axis, place, centre) in enumerate(links):
            arm = plus(place, hinge, -1.0)
            a = plus(plus(a, cross(dw, arm)), cross(w, cross(w, arm)))
            dw = plus(plus(dw, axis, qdd[k]), cross(w, axis), qd[k])
            w, hinge = plus(w, axis, qd[k]), place
            out = plus(centre, place, -1.0)
            f = [self.masses[k] * x for x in plus(plus(a, cross(dw, out)), cross(w, cross(w, out)))]
            inertia = [[sum(turn[i][n] * self.inertias[k][n] * turn[j][n] for n in range(3)) for j in range(3)] for i in range(3)]
            n = plus(plus(times(inertia, dw), cross(w, times(inertia, w))), cross(centre, f))
            sums.append((f, n))
        tau = [0.0] * len(links)
        for k in reversed(range(len(links))):
            force, about = plus(force, sums[k][0]), plus(about, sums[k][1])
            moment = plus(about, cross(links[k][2], force), -1.0)
            tau[k] = sum(x * y for x, y in zip(links[k][1], moment))
        return tau

    def mass_matrix(self, q):
        n, still = len(q), [0.0] * len(q)
        return [self.moments(q, still, [float(i == k) for i in range(n)], 0.0) for k in range(n)]

    def accelerations(self, q, qd, tau):
        """By Cholesky's factors of the mass matrix."""
        n, m = len(q), self.mass_matrix(q)
        x = [t - c for t, c in zip(tau, self.moments(q, qd, [0.0] * len(q)))]
        for k in range(n):
            m[k][k] = math.sqrt(m[k][k] - sum(m[k][j] ** 2 for j in range(k)))
            for i in range(k + 1, n):
                m[i][k] = (m[i][k] - sum(m[i][j] * m[k][j] for j in range(k))) / m[k][k]
            x[k] = (x[k] - sum(m[k][j] * x[j] for j in range(k))) / m[k][k]
        for k in reversed(range(n)):
            x[k] = (x[k] - sum(m[i][k] * x[i] for i in range(k + 1, n))) / m[k][k]
        return x
