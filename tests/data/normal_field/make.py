"""Writes points.csv: positions on WGS 84 and the exact normal field there, to 40 digits.

Independent of the Rust code: the potential in closed form (with the arctangent), its gradient by
mpmath's numeric differentiation at 40 digits, geodetic to Cartesian by the definition.
"""
from mpmath import atan, cos, diff, mp, mpf, nstr, pi, sin, sqrt

mp.dps = 60
a, f = mpf(6378137), 1 / mpf("298.257223563")
GM, omega = mpf("3.986004418e14"), mpf("7.292115e-5")
b, e2 = a * (1 - f), f * (2 - f)
E = a * sqrt(e2)


def q(u):
    return ((1 + 3 * u**2 / E**2) * atan(E / u) - 3 * u / E) / 2


def potential(x, y, z):
    """Gravity potential: gravitation and centrifugal part."""
    d = x * x + y * y + z * z - E**2
    u2 = (d + sqrt(d * d + 4 * E**2 * z * z)) / 2
    u = sqrt(u2)
    v = GM / E * atan(E / u) + omega**2 * a**2 / 2 * q(u) / q(b) * (z * z / u2 - mpf(1) / 3)
    return v + omega**2 * (x * x + y * y) / 2


def position(lat, lon, h):
    n = a / sqrt(1 - e2 * sin(lat) ** 2)
    return [(n + h) * cos(lat) * cos(lon), (n + h) * cos(lat) * sin(lon), ((1 - e2) * n + h) * sin(lat)]


def gravity(lat, lon, h):
    """North and down components."""
    r = position(lat, lon, h)
    g = [diff(potential, tuple(r), tuple(int(i == k) for i in range(3))) for k in range(3)]
    north = [-sin(lat) * cos(lon), -sin(lat) * sin(lon), cos(lat)]
    down = [-cos(lat) * cos(lon), -cos(lat) * sin(lon), -sin(lat)]
    return [sum(p * q for p, q in zip(axis, g)) for axis in (north, down)]


def row(lat_deg, lon_deg, h):
    # The doubles that a reader of the table will use, not the exact decimal fractions.
    lat, lon, h = mpf(float(lat_deg * pi / 180)), mpf(float(lon_deg * pi / 180)), mpf(h)
    # A central difference with a step of 1e-10 is exact to 1e-20.
    step = mpf(10) ** -10
    dlat = [(p - q) / (2 * step) for p, q in zip(gravity(lat + step, lon, h), gravity(lat - step, lon, h))]
    step *= a
    dh = [(p - q) / (2 * step) for p, q in zip(gravity(lat, lon, h + step), gravity(lat, lon, h - step))]
    values = [v if abs(v) > mpf(10) ** -25 else mpf(0) for v in gravity(lat, lon, h)]
    values = position(lat, lon, h) + values + [v if abs(v) > mpf(10) ** -19 else mpf(0) for v in dlat + dh]
    return [repr(float(lat)), repr(float(lon)), repr(float(h))] + [nstr(v, 25) for v in values]


points = [(la, lo, h) for la in (-90, -89.9999, -60, -33, -1e-4, 0, 15, 45, 75, 89.9, 90)
          for lo, h in ((0, 0), (121.5, -10000), (-77, 1000), (179.9, 12000), (-150, 400000), (30, 10000000))]
with open("points.csv", "w") as out:
    out.write("lat_rad,lon_rad,h_m,x_m,y_m,z_m,g_n_mps2,g_d_mps2,dgn_dlat,dgd_dlat,dgn_dh,dgd_dh\n")
    for p in points:
        out.write(",".join(row(*map(mpf, p))) + "\n")
