"""Independent figures for the shipped static alignment budgets: a Kalman filter of twelve states (attitude, velocity, gyro
and accelerometer biases) at a known place, its gains kept, and every source sent through them alone.

    python3 alignment.py
"""
import numpy as np
from scipy.linalg import expm

DEG, UG = np.pi / 180, 9.80665e-6
DPH, ARCMIN, OMEGA = DEG / 3600, DEG / 60, 7.292115e-5
NAMES = ['initial.tilt.n', 'initial.tilt.e', 'initial.heading.d', 'initial.velocity.n', 'initial.velocity.e',
         'initial.velocity.d'] + [f'{i}.bias.constant.{a}' for i in ['gyro', 'accel'] for a in 'xyz'] \
    + [f'{i}.bias.white.{a}' for i in ['gyro', 'accel'] for a in 'xyz'] + [f'aiding.velocity.{a}' for a in 'ned']


def skew(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def model(lat, yaw, dt):
    g = 9.7803253359 * (1 + 0.00193185265 * np.sin(lat) ** 2) / np.sqrt(1 - 0.00669437999 * np.sin(lat) ** 2)
    c, s = np.cos(yaw), np.sin(yaw)
    c = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    w = OMEGA * np.array([np.cos(lat), 0, -np.sin(lat)])
    f = np.zeros((12, 12))
    f[0:3, 0:3], f[0:3, 6:9] = -skew(w), -c
    f[3:6, 0:3], f[3:6, 3:6], f[3:6, 9:12] = skew([0, 0, -g]), -2 * skew(w), c
    return expm(f * dt), c


def sizes(tilt, heading, velocity, eb, db, arw, vrw, noise):
    return np.r_[[tilt] * 2, heading, [velocity] * 3, [eb] * 3, [db] * 3, [arw] * 3, [vrw] * 3, [noise] * 3]


def run(title, lat, dt, every, duration, yaw, truth, belief):
    """Covariance of every source of `truth` through the gains of a filter that believes in `belief`."""
    pf = np.diag(belief[:12] ** 2)
    joint = [np.zeros((24, 24)) for _ in truth]
    for k in range(12):
        joint[k][k, k] = truth[k] ** 2
    h = np.zeros((3, 12))
    h[:, 3:6] = np.eye(3)
    known = {}
    for k in range(int(round(duration / dt))):
        angle = yaw((k + 0.5) * dt)
        if angle not in known:
            known[angle] = model(lat, angle, dt)
        phi, c = known[angle]
        drive = np.zeros((12, 6))
        drive[0:3, 0:3], drive[3:6, 3:6] = -c, c
        qf = drive @ np.diag(belief[12:18] ** 2 * dt) @ drive.T
        pf = phi @ pf @ phi.T + qf
        both = np.kron(np.eye(2), phi)
        for j in range(len(joint)):
            joint[j] = both @ joint[j] @ both.T
            if 12 <= j < 18:
                joint[j][:12, :12] += np.outer(drive[:, j - 12], drive[:, j - 12]) * truth[j] ** 2 * dt
        if (k + 1) % every:
            continue
        gain = pf @ h.T @ np.linalg.inv(h @ pf @ h.T + np.diag(belief[18:] ** 2))
        left = np.eye(12) - gain @ h
        pf = left @ pf @ left.T + gain @ np.diag(belief[18:] ** 2) @ gain.T
        u = np.eye(24)
        u[12:, :12], u[12:, 12:] = gain @ h, left
        for j in range(len(joint)):
            joint[j] = u @ joint[j] @ u.T
            if j >= 18:
                joint[j][12:, 12:] += np.outer(gain[:, j - 18], gain[:, j - 18]) * truth[j] ** 2
    d = np.concatenate([np.eye(12), -np.eye(12)], 1)
    rows = [(d @ p @ d.T)[:3, :3] for p in joint]
    total = sum(rows)
    print(f'{title}: heading {np.sqrt(total[2, 2])/ARCMIN:.5f} arcmin, tilt n {np.sqrt(total[0, 0]):.5e} e {np.sqrt(total[1, 1]):.5e} rad')
    print(f'  the filter believes in {np.sqrt(pf[2, 2])/ARCMIN:.5f} arcmin')
    for name, p in sorted(zip(NAMES, rows), key=lambda r: -r[1][2, 2])[:8]:
        print(f'  {name:24s} {100 * p[2, 2] / total[2, 2]:9.4f} % of the heading variance, {np.sqrt(p[2, 2])/ARCMIN:.5f} arcmin')


def turn(t):
    """Half a turn between 140 s and 160 s, smooth."""
    s = min(max((t - 140) / 20, 0), 1)
    return np.pi * s ** 3 * (10 - 15 * s + 6 * s * s)


if __name__ == '__main__':
    # The public demonstration of error distribution (G. Yan, PSINS, after CCC 2018) as it is: 97.35 %.
    demo = sizes(0.1 * DEG, 1 * DEG, 1.0, 0.03 * DPH, 100 * UG, 0.001 * DEG / 60, 10 * UG, 0.01)
    run('as published', 30 * DEG, 0.1, 2, 600, lambda t: 0.0, demo, demo)
    # With 300 s, 5 ug/sqrt(Hz) and 1 mm/s in place of 600 s, 10 ug/sqrt(Hz) and 1 cm/s.
    demo = sizes(0.1 * DEG, 1 * DEG, 1.0, 0.03 * DPH, 100 * UG, 0.001 * DEG / 60, 5 * UG, 0.001)
    run('one position', 30 * DEG, 0.1, 2, 300, lambda t: 0.0, demo, demo)
    run('two positions', 30 * DEG, 0.1, 2, 300, turn, demo, demo)
    truth = sizes(0.1 * DEG, 1 * DEG, 0.1, 0.01 * DPH, 50 * UG, 0.003 * DEG / 60, 10 * UG, 0.01)
    belief = sizes(0.1 * DEG, 1 * DEG, 0.1, 0.002 * DPH, 50 * UG, 0.001 * DEG / 60, 10 * UG, 0.01)
    run('matched filter', 45 * DEG, 0.1, 10, 600, lambda t: 0.0, truth, truth)
    run('wrong list', 45 * DEG, 0.1, 10, 600, lambda t: 0.0, truth, belief)
