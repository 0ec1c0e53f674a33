"""Independent figures for the shipped budgets along a motion.

Reads `truth.csv` and `imu_ideal.csv` of a simulation of the same motion and builds transition matrices by half
differences of a plain local-level mechanization (direction cosines, two-pass midpoint rule) over short pieces of the
trajectory; nothing of the error dynamics of the software is used. Budgets then follow by matrix products: covariance of each
source alone, with a static alignment before (closed form) or with a Kalman filter whose gains come from its own model.

    python3 independent.py airliner FOLDER | missile FOLDER | drone FOLDER
"""
import sys
import numpy as np

A, F, GM, O = 6378137.0, 1 / 298.257223563, 3.986004418e14, 7.292115e-5
E2 = F * (2 - F)
B = A * (1 - F)
GE, GP = 9.7803253359, 9.8321849378
K = B * GP / (A * GE) - 1
M = O * O * A * A * B / GM
DEG, UG = np.pi / 180, 9.80665e-6
DPH, ARCMIN = DEG / 3600, DEG / 60


def gravity(lat, h):
    s2 = np.sin(lat) ** 2
    g0 = GE * (1 + K * s2) / np.sqrt(1 - E2 * s2)
    return g0 * (1 - 2 * h / A * (1 + F + M - 2 * F * s2) + 3 * h * h / A ** 2)


def radii(lat, h):
    w2 = 1 - E2 * np.sin(lat) ** 2
    return A * (1 - E2) / w2 ** 1.5 + h, A / np.sqrt(w2) + h


def rot(v):
    """exp([v x]) for a stack of vectors."""
    n2 = np.sum(v * v, -1)
    n = np.sqrt(n2)
    a = np.where(n2 > 1e-16, np.sin(n) / np.where(n > 0, n, 1), 1 - n2 / 6)
    b = np.where(n2 > 1e-8, (1 - np.cos(n)) / np.where(n2 > 0, n2, 1), 0.5 - n2 / 24)
    s = np.zeros(v.shape + (3,))
    s[..., 0, 1], s[..., 0, 2], s[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    s[..., 1, 0], s[..., 2, 0], s[..., 2, 1] = v[..., 2], -v[..., 1], v[..., 0]
    return np.eye(3) + a[..., None, None] * s + b[..., None, None] * (s @ s)


def step(lat, lon, h, v, c, dth, dv, dt, held):
    mid = (lat, h, v)
    for _ in range(2):
        la, hh, vv = mid
        rm, rn = radii(la, hh)
        s, co = np.sin(la), np.cos(la)
        wie = np.stack([O * co, 0 * s, -O * s], -1)
        wen = np.stack([vv[..., 1] / rn, -vv[..., 0] / rm, -vv[..., 1] * s / co / rn], -1)
        grav = np.zeros_like(v)
        grav[..., 2] = gravity(la, hh)
        half = rot(-0.5 * dt * (wie + wen)) @ c
        push = np.einsum('...ij,...j', half, dv + 0.5 * np.cross(dth, dv))
        new = v + push + dt * (grav - np.cross(2 * wie + wen, vv))
        if held:
            new[..., 2] = 0
        mean = 0.5 * (v + new)
        mid = (lat + 0.5 * dt * mean[..., 0] / rm, h - 0.5 * dt * mean[..., 2], mean)
    lat2, lon2, h2 = lat + dt * mean[..., 0] / rm, lon + dt * mean[..., 1] / (rn * co), h - dt * mean[..., 2]
    c2 = rot(-dt * (wie + wen)) @ c @ rot(dth)
    return lat2, lon2, h2, new, c2


def pieces(folder, held):
    """Transition (9 x 9) and answer to unit sensor errors (9 x 24) of each piece between rows of the truth."""
    truth = np.loadtxt(f'{folder}/truth.csv', delimiter=',', skiprows=1)
    imu = np.loadtxt(f'{folder}/imu_ideal.csv', delimiter=',', skiprows=1)
    n = len(truth) - 1
    per = len(imu) // n
    dt = imu[0, 0]
    dth, dv = imu[:, 1:4].reshape(n, per, 3), imu[:, 4:7].reshape(n, per, 3)
    size = np.r_[[10.0] * 3, [0.1] * 3, [1e-4] * 3, [1e-5] * 3, [1e-2] * 3, [1e-3] * 18]
    count = len(size)
    sgn = np.r_[np.ones(count), -np.ones(count)]
    x = np.concatenate([np.diag(size), -np.diag(size)])  # runs x parameters
    runs = 2 * count
    tile = lambda a: np.repeat(a[:, None], runs, 1)
    lat0, lon0, h0 = truth[:n, 1], truth[:n, 2], truth[:n, 3]
    rm, rn = radii(lat0, h0)
    lat = lat0[:, None] + x[:, 0] / rm[:, None]
    lon = lon0[:, None] + x[:, 1] / (rn * np.cos(lat0))[:, None]
    h = h0[:, None] - (0 if held else 1) * x[:, 2] + 0 * lat
    v = tile(truth[:n, 4:7]) + x[None, :, 3:6]
    if held:
        v[..., 2] = 0
    r, p, y = truth[:n, 7], truth[:n, 8], truth[:n, 9]
    z = np.zeros(n)
    c = rot(np.stack([z, z, y], -1)) @ rot(np.stack([z, p, z], -1)) @ rot(np.stack([r, z, z], -1))
    c = rot(-x[:, 6:9])[None] @ tile(c)
    off = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)]
    mg, ma = np.zeros((runs, 3, 3)), np.zeros((runs, 3, 3))
    for k in range(3):
        mg[:, k, k], ma[:, k, k] = x[:, 15 + k], x[:, 24 + k]
    for k, (i, j) in enumerate(off):
        mg[:, i, j], ma[:, i, j] = x[:, 18 + k], x[:, 27 + k]
    for k in range(per):
        a, f = dth[:, k][:, None], dv[:, k][:, None]
        a = a + x[None, :, 9:12] * dt + np.einsum('rij,nj->nri', mg, dth[:, k])
        f = f + x[None, :, 12:15] * dt + np.einsum('rij,nj->nri', ma, dv[:, k])
        lat, lon, h, v, c = step(lat, lon, h, v, c, a, f, dt, held)
        if held:
            h = np.broadcast_to(h0[:, None], h.shape)
    half = lambda a: 0.5 * (a[:, :count] - a[:, count:])
    lat1, h1 = truth[1:, 1], truth[1:, 3]
    rm, rn = radii(lat1, h1)
    d = np.zeros((n, 9, count))
    d[:, 0] = half(lat) * rm[:, None]
    d[:, 1] = half(lon) * (rn * np.cos(lat1))[:, None]
    d[:, 2] = -half(h)
    d[:, 3:6] = np.swapaxes(half(v), 1, 2)
    # C(+) C(-)' = exp(-[2 phi x])
    t = c[:, :count] @ np.swapaxes(c[:, count:], -1, -2)
    d[:, 6], d[:, 7], d[:, 8] = (-(t[..., i, j] - t[..., j, i]) / 4 for i, j in [(2, 1), (0, 2), (1, 0)])
    d /= size
    return truth, d[:, :, :9], d[:, :, 9:], per * dt


GYRO, ACCEL = [0, 1, 2], [3, 4, 5]
LABELS = ['xy', 'xz', 'yx', 'yz', 'zx', 'zy']
OFF = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)]


def constants(bias, scale, mis):
    """Name, number of the sensor parameter and standard deviation."""
    out = []
    for inst, first, b, s, m in [('gyro', 0, bias[0], scale[0], mis[0]), ('accel', 1, bias[1], scale[1], mis[1])]:
        out += [(f'{inst}.bias.constant.{a}', 3 * first + k, b) for k, a in enumerate('xyz')]
        out += [(f'{inst}.scale_factor.constant.{a}', 6 + 9 * first + k, s) for k, a in enumerate('xyz')]
        out += [(f'{inst}.misalignment.constant.{a}', 9 + 9 * first + k, m) for k, a in enumerate(LABELS)]
    return [c for c in out if c[2] > 0]


def show(name, p):
    s = np.sqrt(np.maximum(np.diag(p), 0))
    print(f'{name:34s} n {s[0]:.6g} e {s[1]:.6g} d {s[2]:.6g} horizontal {np.hypot(s[0], s[1]):.6g} m, heading {s[8]/ARCMIN:.6g} arcmin')


def free(phi, gamma, dt, sources):
    """Rows: (name, P0, column of parameter or None, density by axis or None)."""
    total = 0
    for name, p, column, white in sources:
        if column is not None:
            x = p.copy()
            for f, g in zip(phi, gamma):
                x = f @ x + g[:, column[0]] * column[1]
            p = np.outer(x, x)
        else:
            for f, g in zip(phi, gamma):
                p = f @ p @ f.T
                if white is not None:
                    w = g[:, white[0]]
                    p = p + np.outer(w, w) * (white[1] ** 2 / dt)
        show(name, p)
        total = total + p
    show('total', total)


def airliner(folder):
    truth, phi, gamma, dt = pieces(folder, True)
    window = 600.0
    lat, h, yaw = truth[0, 1], truth[0, 3], truth[0, 9]
    g, s, co = gravity(lat, h), np.sin(lat), np.cos(lat)
    c = rot(np.array([0, 0, yaw]))
    w_b, f_b = c.T @ np.array([O * co, 0, -O * s]), np.array([0, 0, -g])

    def law(eps_b, nab_b):
        e, a = c @ eps_b, c @ nab_b
        return np.r_[np.zeros(6), a[1] / g, -a[0] / g, e[1] / (O * co) - s / co * a[1] / g]

    rows = []
    for name, k, sd in constants((0.01 * DPH, 50 * UG), (5e-6, 100e-6), (10e-6, 25e-6)):
        err = [np.zeros(3), np.zeros(3)]
        if k < 6:
            err[k // 3][k % 3] = sd
        else:
            inst, k2 = divmod(k - 6, 9)
            i, j = (k2, k2) if k2 < 3 else OFF[k2 - 3]
            err[inst][i] = sd * (w_b, f_b)[inst][j]
        rows.append((name, law(*err), (k, sd), None))
    for inst, first, density in [('gyro', 0, 0.002 * DEG / 60), ('accel', 3, 10 * UG)]:
        for k in range(3):
            unit = np.eye(3)[k] * density / np.sqrt(window)
            p0 = law(unit, 0 * unit) if first == 0 else law(0 * unit, unit)
            rows.append((f'{inst}.bias.white.{"xyz"[k]}', np.outer(p0, p0), None, (first + k, density)))
    free(phi, gamma, dt, rows)


def missile(folder):
    truth, phi, gamma, dt = pieces(folder, False)
    rows = [(name, np.zeros(9), (k, sd), None)
            for name, k, sd in constants((1 * DPH, 1000 * UG), (300e-6, 300e-6), (200e-6, 200e-6))]
    for inst, first, density in [('gyro', 0, 0.1 * DEG / 60), ('accel', 3, 50 * UG)]:
        rows += [(f'{inst}.bias.white.{"xyz"[k]}', np.zeros((9, 9)), None, (first + k, density)) for k in range(3)]
    start = [5.0] * 3 + [0.2] * 3 + [3e-4] * 2 + [1e-3]
    names = [f'initial.{w}' for w in 'position.n position.e position.d velocity.n velocity.e velocity.d tilt.n tilt.e heading.d'.split()]
    rows += [(name, np.diag(np.eye(9)[k]) * sd ** 2, None, None) for k, (name, sd) in enumerate(zip(names, start))]
    free(phi, gamma, dt, rows)


def drone(folder):
    truth, phi, gamma, dt = pieces(folder, False)
    bias, white, gm, scale = (0.1 * DEG, 10e3 * UG), (0.3 * DEG / 60, 100 * UG), (20 * DPH, 100 * UG), (500e-6, 500e-6)
    tau = 100.0
    keep = np.exp(-dt / tau)
    per = int(round(1 / dt))
    pos, vel = np.array([1.5, 1.5, 3.0]), np.array([0.1] * 3)
    start = np.r_[pos, vel, [1 * DEG] * 2, 5 * DEG]
    # Truth: 9, bias 6, Gauss-Markov 6, scale 6. Filter: the first 21.
    n, m = 27, 21
    p0 = np.r_[start, [bias[0]] * 3, [bias[1]] * 3, [gm[0]] * 3, [gm[1]] * 3, [scale[0]] * 3, [scale[1]] * 3] ** 2
    nav = 'position.n position.e position.d velocity.n velocity.e velocity.d tilt.n tilt.e heading.d'.split()
    names = [f'initial.{w}' for w in nav]
    for what in ['bias.constant', 'bias.gauss_markov', 'scale_factor.constant']:
        names += [f'{i}.{what}.{a}' for i in ['gyro', 'accel'] for a in 'xyz']
    noises = [f'{i}.bias.white.{a}' for i in ['gyro', 'accel'] for a in 'xyz']
    meas = [f'aiding.{w}.{a}' for w in ['position', 'velocity'] for a in 'ned']
    drive = np.r_[np.zeros(9 + 6), p0[15:21] * (1 - keep ** 2), np.zeros(6)]

    def walk(which):
        on = lambda name: which is None or which == name
        px = np.diag([v if on(k) else 0 for v, k in zip(p0, names)])
        joint = np.zeros((n + m, n + m))
        joint[:n, :n] = px
        pf = np.diag(p0[:m])
        h = np.zeros((6, n + m))
        for k in range(6):
            h[k, k], h[k, n + k] = 1, -1
        for k, (f, g) in enumerate(zip(phi, gamma)):
            ft = np.eye(n)
            ft[:9, :9], ft[:9, 9:15], ft[:9, 15:21] = f, g[:, :6], g[:, :6]
            ft[:9, 21:24], ft[:9, 24:27] = g[:, 6:9], g[:, 15:18]
            ft[15:21, 15:21] *= keep
            both = np.zeros((n + m, n + m))
            both[:n, :n], both[n:, n:] = ft, ft[:m, :m]
            q, qf = np.zeros((n, n)), np.zeros((n, n))
            for j in range(6):
                w = np.outer(g[:, j], g[:, j]) * white[j // 3] ** 2 / dt
                qf[:9, :9] += w
                if on(noises[j]):
                    q[:9, :9] += w
            qf += np.diag(drive)
            q += np.diag([v if on(name) else 0 for v, name in zip(drive, names)])
            joint = both @ joint @ both.T
            joint[:n, :n] += q
            pf = ft[:m, :m] @ pf @ ft[:m, :m].T + qf[:m, :m]
            t = (k + 1) * dt
            if (k + 1) % per == 0 and not (120.5 <= t < 181):
                r = np.r_[pos, vel] ** 2
                hf = np.eye(6, m)
                gain = pf @ hf.T @ np.linalg.inv(hf @ pf @ hf.T + np.diag(r))
                keepf = np.eye(m) - gain @ hf
                pf = keepf @ pf @ keepf.T + gain @ np.diag(r) @ gain.T
                # x^ := x^ + K (H x + v - H x^)
                u = np.eye(n + m)
                u[n:] += gain @ h
                joint = u @ joint @ u.T
                rt = np.diag([v if on(name) else 0 for v, name in zip(r, meas)])
                joint[n:, n:] += gain @ rt @ gain.T
        d = np.zeros((9, n + m))
        d[:, :9], d[:, n:n + 9] = np.eye(9), -np.eye(9)
        return d @ joint @ d.T, pf[:9, :9]

    total, own = walk(None)
    show('total', total)
    show('total, as the filter believes', own)
    for name in sys.argv[3:]:
        show(name, walk(name)[0])


if __name__ == '__main__':
    {'airliner': airliner, 'missile': missile, 'drone': drone}[sys.argv[1]](sys.argv[2])
