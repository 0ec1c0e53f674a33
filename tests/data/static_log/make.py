"""Writes static_counts.csv.gz and prints what a navigator must make of it. Needs numpy and scipy; see README.md."""

import gzip
from math import asin, atan2, cos, degrees, pi, radians, sin, sqrt, tan

import numpy as np
from scipy.linalg import expm

A, F, OMEGA, GM = 6378137.0, 1 / 298.257223563, 7.292115e-5, 3.986004418e14
E2, B = F * (2 - F), A * (1 - F)
M = OMEGA**2 * A**2 * B / GM
ARCSEC = pi / 648000
DEGPH, UG = ARCSEC, 9.80665e-6

# The place, the attitude, the sensor errors, the instrument.
LAT, H = radians(47.5), 450.0
ROLL, PITCH, YAW = radians(1.5), radians(-2.0), radians(130.0)
EPS_B = np.array([0.02, -0.01, 0.015]) * DEGPH
NABLA_B = np.array([50.0, -30.0, 20.0]) * UG
RATE, WINDOW, DURATION = 10, 300, 1200
GYRO_COUNT, ACCEL_COUNT = 1e-5 * ARCSEC, 1e-8


def gamma(lat, h):
    s2 = sin(lat) ** 2
    g = 9.7803253359 * (1 + 0.00193185265241 * s2) / sqrt(1 - E2 * s2)
    return g * (1 - 2 / A * (1 + F + M - 2 * F * s2) * h + 3 * h * h / A**2)


def radii(lat):
    w = 1 - E2 * sin(lat) ** 2
    return A * (1 - E2) / w**1.5 + H, A / sqrt(w) + H


def earth_rate(lat):
    return OMEGA * np.array([cos(lat), 0, -sin(lat)])


def dcm(roll, pitch, yaw):
    """C_b^t of the yaw-pitch-roll sequence."""
    cr, sr, cp, sp, cy, sy = cos(roll), sin(roll), cos(pitch), sin(pitch), cos(yaw), sin(yaw)
    return (
        np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
        @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
        @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    )


def euler(c):
    return atan2(c[2, 1], c[2, 2]), -asin(c[2, 0]), atan2(c[1, 0], c[0, 0])


def cross(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def triad(f, w):
    """Orthonormal axes along f, f x w, f x (f x w), as columns."""
    first = f / np.linalg.norm(f)
    second = np.cross(f, w)
    second /= np.linalg.norm(second)
    return np.stack([first, second, np.cross(first, second)], axis=1)


def navigate(c, omega_b, f_b, seconds, step=0.25):
    """Local-level equations with the vertical channel held, by the classic Runge-Kutta method; v_D = 0, h = H."""

    def rates(v, lat, c):
        r_m, r_n = radii(lat)
        earth = earth_rate(lat)
        transport = np.array([v[1] / r_n, -v[0] / r_m, -v[1] * tan(lat) / r_n])
        dv = c @ f_b + np.array([0, 0, gamma(lat, H)]) - np.cross(2 * earth + transport, v)
        dv[2] = 0
        return dv, v[0] / r_m, v[1] / (r_n * cos(lat)), c @ cross(omega_b) - cross(earth + transport) @ c

    y = [np.zeros(3), LAT, 0.0, c]
    for _ in range(round(seconds / step)):
        def at(k, h):
            return [a + h * b for a, b in zip(y, k)] if k is not None else y

        def f(z):
            dv, dlat, dlon, dc = rates(z[0], z[1], z[3])
            return [dv, dlat, dlon, dc]

        k1 = f(y)
        k2 = f(at(k1, step / 2))
        k3 = f(at(k2, step / 2))
        k4 = f(at(k3, step))
        y = [a + step / 6 * (p + 2 * q + 2 * r + s) for a, p, q, r, s in zip(y, k1, k2, k3, k4)]
    return y


def linear(phi, eps, nabla, seconds):
    """Linear error equations at rest (v_N, v_E, phi, dL, dlambda), by the matrix exponential."""
    s, c, t, g = sin(LAT), cos(LAT), tan(LAT), gamma(LAT, H)
    r_m, r_n = radii(LAT)
    f = np.zeros((8, 8))
    f[0, [1, 3]] = -2 * OMEGA * s, g
    f[1, [0, 2]] = 2 * OMEGA * s, -g
    f[2, [1, 3, 5]] = 1 / r_n, -OMEGA * s, -OMEGA * s
    f[3, [0, 2, 4]] = -1 / r_m, OMEGA * s, OMEGA * c
    f[4, [1, 3, 5]] = -t / r_n, -OMEGA * c, -OMEGA * c
    f[5, 0] = 1 / r_m
    f[6, 1] = 1 / (r_n * c)
    f[:5, 7] = nabla[0], nabla[1], -eps[0], -eps[1], -eps[2]
    x = expm(f * seconds) @ np.array([0, 0, *phi, 0, 0, 1])
    return x[5] * r_m, x[6] * r_n * c, x[0], x[1]


c_true = dcm(ROLL, PITCH, YAW)
omega_b = c_true.T @ earth_rate(LAT) + EPS_B
f_b = c_true.T @ np.array([0, 0, -gamma(LAT, H)]) + NABLA_B

# Counts of sensor axes right, front, up; what is left over is carried into the next sample.
sensor = np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1]])
per_second = np.concatenate([sensor @ omega_b / GYRO_COUNT, sensor @ f_b / ACCEL_COUNT])
rows = np.arange(RATE * DURATION + 1)[:, None] / RATE * per_second[None, :]
counts = np.diff(np.round(rows).astype(np.int64), axis=0)
text = "k,right_gyro,front_gyro,up_gyro,right_accel,front_accel,up_accel\n"
text += "".join(f"{k + 1}," + ",".join(map(str, row)) + "\n" for k, row in enumerate(counts))
with open("static_counts.csv.gz", "wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=0) as out:
    out.write(text.encode())

reference = triad(np.array([0, 0, -gamma(LAT, H)]), earth_rate(LAT))
c_hat = reference @ triad(f_b, omega_b).T
eps, nabla, g = c_true @ EPS_B, c_true @ NABLA_B, gamma(LAT, H)
phi = (nabla[1] / g, -nabla[0] / g, eps[1] / (OMEGA * cos(LAT)) - tan(LAT) * nabla[1] / g)
print("mean rate (deg/h), specific force (m/s2)", np.linalg.norm(omega_b) / DEGPH, np.linalg.norm(f_b))
print("TRIAD roll, pitch, yaw (deg)", *(degrees(a) for a in euler(c_hat)))
print("first-order phi (arcsec)", *(a / ARCSEC for a in phi))
v, lat, lon, c = navigate(c_hat, omega_b, f_b, DURATION - WINDOW)
r_m, r_n = radii(LAT)
print("navigated dN, dE (m), v_N, v_E (m/s)", (lat - LAT) * r_m, lon * r_n * cos(LAT), v[0], v[1])
print("navigated roll, pitch, yaw (deg)", *(degrees(a) for a in euler(c)))
print("linear    dN, dE (m), v_N, v_E (m/s)", *linear(phi, eps, nabla, DURATION - WINDOW))
