"""Closed solutions that the cases are compared with. Units of the caller; E* is the plane strain modulus of a pair.

Sources: [J] K. L. Johnson, Contact Mechanics, Cambridge University Press 1985. [T] S. Timoshenko and J. Goodier, Theory of Elasticity,
McGraw-Hill 1951. [C] M. Ciavarella, D. Hills and G. Monno, The influence of rounded edges on indentation by a flat punch, Proc. IMechE C
212 (1998). [S] D. Spence, An eigenvalue problem for elastic contact with finite friction, Proc. Camb. Phil. Soc. 73 (1973). [W] H.
Westergaard, Bearing pressures and cracks, J. Appl. Mech. 6 (1939).
"""

import math

import numpy as np


def pair_modulus(e1, nu1, e2, nu2):
    """E*: 1 / E* = (1 - nu1^2) / E1 + (1 - nu2^2) / E2."""
    return 1 / ((1 - nu1**2) / e1 + (1 - nu2**2) / e2)


def root(x):
    """sqrt(x) where x > 0, else 0."""
    return np.sqrt(np.maximum(x, 0))


# Hertz [J, 4.2 and appendix 3].


def hertz_line(force, radius, modulus):
    """Half width a and peak pressure p0 for a force a length."""
    a = math.sqrt(4 * force * radius / (math.pi * modulus))
    return a, 2 * force / (math.pi * a)


def hertz_point(force, radius, modulus):
    """Radius a, peak pressure p0 and approach of distant points."""
    a = (3 * force * radius / (4 * modulus)) ** (1 / 3)
    return a, 3 * force / (2 * math.pi * a**2), a**2 / radius


def hertz_pressure(r, a, p0):
    return p0 * root(1 - (np.asarray(r) / a) ** 2)


def mcewen(x, z, a, p0):
    """Stresses XX, ZZ, XZ at depth z under a line contact [McEwen, Phil. Mag. 40 (1949); J, 4.49]."""
    x, z = np.asarray(x, float), np.asarray(z, float)
    q = a**2 - x**2 + z**2
    s = np.sqrt(q**2 + 4 * x**2 * z**2)
    m, n = root((s + q) / 2), root((s - q) / 2) * np.sign(x)
    with np.errstate(invalid="ignore", divide="ignore"):
        f = np.where(m**2 + n**2 > 0, (z**2 + n**2) / (m**2 + n**2), 0)
        g = np.where(m**2 + n**2 > 0, (m**2 - z**2) / (m**2 + n**2), 0)
    return -p0 / a * (m * (1 + f) - 2 * z), -p0 / a * m * (1 - f), -p0 / a * n * g


def under_point_contact(z, a, p0, nu):
    """Stresses RR = TT and ZZ on the axis at depth z [J, 3.45]."""
    t = np.asarray(z, float) / a
    with np.errstate(divide="ignore"):
        angle = np.where(t > 0, np.arctan(1 / np.where(t > 0, t, 1)), math.pi / 2)
    ring = 1 / (2 * (1 + t**2))
    return p0 * (-(1 + nu) * (1 - t * angle) + ring), -2 * p0 * ring


def shortening_under_point_contact(depth, a, p0, e, nu):
    """Displacement of the middle of the contact towards the point of the axis at `depth`."""
    z = np.linspace(0, depth, 4001)
    rr, zz = under_point_contact(z, a, p0, nu)
    return -float(np.trapz((zz - 2 * nu * rr) / e, z))


def roller_compression(force, radius, a, e, nu):
    """How much nearer the contact of a cylinder comes to its middle plane, pressed between two plates [J, 5.57: half of it]."""
    return force * (1 - nu**2) / (math.pi * e) * (2 * math.log(4 * radius / a) - 1)


# Friction.


def cattaneo(r, a, c, limit):
    """Tangential traction, limit = coefficient * p0 [Cattaneo 1938, Mindlin 1949; J, 7.26 and 7.41]."""
    return limit * (root(1 - (np.asarray(r) / a) ** 2) - c / a * root(1 - (np.asarray(r) / c) ** 2))


def elliptic(k):
    """Complete elliptic integral of the first kind, modulus k, by the arithmetic-geometric mean."""
    a, b = 1.0, math.sqrt(1 - k * k)
    while abs(a - b) > 1e-15 * a:
        a, b = (a + b) / 2, math.sqrt(a * b)
    return math.pi / (2 * a)


def bisect(f, low, high):
    """The zero of f between low and high, where its signs differ."""
    sign = math.copysign(1, f(low))
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if math.copysign(1, f(middle)) == sign else (low, middle)
    return (low + high) / 2


def spence_stick(coefficient, nu):
    """c/a under a rigid flat punch with friction, plane strain, the pressure taken as the frictionless one:
    K(sqrt(1 - k^2)) / K(k) = (1 - 2 nu) / (2 (1 - nu) coefficient), k = c/a [S; J, 5.5(c)]."""
    wanted = (1 - 2 * nu) / (2 * (1 - nu) * coefficient)
    return bisect(lambda k: elliptic(math.sqrt(1 - k * k)) / elliptic(k) - wanted, 1e-5, 1 - 1e-9)


# Rings [T, 28].


def press_fit_pressure(interference, a, b, c, e, nu, plane):
    """Shaft of radii a, b in a hub of radii b, c, the same material; plane: "plane_stress" or "plane_strain"."""
    if plane == "plane_strain":
        e, nu = e / (1 - nu**2), nu / (1 - nu)
    return interference / b * e / ((c * c + b * b) / (c * c - b * b) + nu + (b * b + a * a) / (b * b - a * a) - nu)


def ring_constants(inner, outer, p_inner, p_outer):
    """A, B of sigma_r = A - B / r^2, sigma_t = A + B / r^2."""
    d = outer**2 - inner**2
    return (p_inner * inner**2 - p_outer * outer**2) / d, (p_inner - p_outer) * inner**2 * outer**2 / d


def ring_displacement(r, constants, e, nu, plane):
    if plane == "plane_strain":
        e, nu = e / (1 - nu**2), nu / (1 - nu)
    a, b = constants
    return ((1 - nu) * a * r + (1 + nu) * b / r) / e


def ring_stress(x, constants, nu, plane):
    """Points x 3 x 3 at places x (..., 3); the axis of the ring is z."""
    a, b = constants
    radius = np.hypot(x[..., 0], x[..., 1])
    er = x[..., :2] / radius[..., None]
    s = np.zeros(x.shape[:-1] + (3, 3))
    s[..., :2, :2] = (a + b / radius**2)[..., None, None] * np.eye(2) - 2 * (b / radius**2)[..., None, None] * er[..., :, None] * er[..., None, :]
    s[..., 2, 2] = 2 * nu * a if plane == "plane_strain" else 0
    return s


def sphere_stress(x, inner, outer, pressure):
    """Of a hollow sphere under internal pressure, points x 3 x 3 [T, 142]."""
    radius = np.linalg.norm(x, axis=-1)
    er = x / radius[..., None]
    d = outer**3 - inner**3
    a, b = pressure * inner**3 / d, pressure * inner**3 * outer**3 / d
    radial, hoop = a - b / radius**3, a + b / (2 * radius**3)
    return hoop[..., None, None] * np.eye(3) + (radial - hoop)[..., None, None] * er[..., :, None] * er[..., None, :]


def sphere_displacement(r, inner, outer, pressure, e, nu):
    d = outer**3 - inner**3
    a, b = pressure * inner**3 / d, pressure * inner**3 * outer**3 / d
    return ((1 - 2 * nu) * a * r + (1 + nu) * b / (2 * r**2)) / e


# Punches on a half-plane.


def flat_punch(x, a, force):
    """Pressure under a rigid flat punch of half width a [J, 2.64]."""
    return force / (math.pi * np.sqrt(a**2 - np.asarray(x) ** 2))


def rounded_punch_force(a, b, radius, modulus):
    """Force a length that spreads the contact of a punch, flat for |x| < b and rounded by `radius` beyond, to |x| < a [C]: from the
    profile h of the punch, P = E* integral over 0 .. a of t h'(t) / sqrt(a^2 - t^2)."""
    start = math.asin(b / a)
    return modulus / radius * (a * a * (math.pi / 2 - start) / 2 - a * b * math.cos(start) / 2)


def rounded_punch_width(force, b, radius, modulus):
    high = 2 * b
    while rounded_punch_force(high, b, radius, modulus) < force:
        high *= 2
    return bisect(lambda a: rounded_punch_force(a, b, radius, modulus) - force, b, high)


def rounded_punch_pressure(x, a, b, radius, modulus):
    """p(x) = (E*/pi) sqrt(a^2 - x^2) PV integral over b .. a of t h'(t) / (sqrt(a^2 - t^2) (t^2 - x^2)), in closed form [C]."""
    x = np.asarray(x, float)
    start, angle = math.asin(b / a), np.arcsin(np.clip(x / a, -1, 1))
    term = lambda t: np.log(np.abs(np.sin((start - t) / 2) / np.cos((start + t) / 2)))
    with np.errstate(divide="ignore", invalid="ignore"):
        left = np.where(x == b, 0, (x - b) * term(angle))
        p = a * np.cos(angle) * (math.pi / 2 - start) - left / 2 + (x + b) / 2 * term(-angle)
    return np.where(np.abs(x) < a, modulus / (math.pi * radius) * p, 0)


def wave(mean, amplitude, length, modulus):
    """Half width of contact of a flat surface and a wave of `amplitude` under a mean pressure [W; J, 13.2]: mean = p* sin^2(pi a / L),
    p* = pi E* amplitude / L."""
    return length / math.pi * math.asin(math.sqrt(mean * length / (math.pi * modulus * amplitude)))


def wave_pressure(x, mean, a, length):
    s = math.sin(math.pi * a / length)
    t = np.asarray(x) * math.pi / length
    return 2 * mean * np.cos(t) / s**2 * root(s**2 - np.sin(t) ** 2)


# Beams.


def cantilever(force, length, height, width, e, nu):
    """End deflection with shear, rectangular section, shear coefficient 10 (1 + nu) / (12 + 11 nu) [Cowper, J. Appl. Mech. 33 (1966)]."""
    area, inertia, shear = width * height, width * height**3 / 12, e / (2 * (1 + nu))
    return force * length**3 / (3 * e * inertia) + force * length / (10 * (1 + nu) / (12 + 11 * nu) * shear * area)


def reentrant_corner():
    """Williams (1952): exponent of the symmetric displacement, r^e, at a free corner of 270 degrees, and its stress for unit strength at
    (r, theta), theta from the axis of symmetry, in plane strain (points x 3 x 3)."""
    exponent, factor = 0.544483736782464, 0.543075578836737
    low, high = exponent - 1, exponent + 1

    def stress(r, theta, poisson):
        scale = exponent * r**low
        s = np.zeros(np.shape(theta) + (3, 3))
        s[..., 0, 0] = scale * ((2 - factor * high) * np.cos(low * theta) - low * np.cos((exponent - 3) * theta))
        s[..., 1, 1] = scale * ((2 + factor * high) * np.cos(low * theta) + low * np.cos((exponent - 3) * theta))
        s[..., 0, 1] = s[..., 1, 0] = scale * (low * np.sin((exponent - 3) * theta) + factor * high * np.sin(low * theta))
        s[..., 2, 2] = poisson * (s[..., 0, 0] + s[..., 1, 1])
        return s

    return exponent, stress
