"""Static alignment by a ten-state filter under wrong statistics, plain and with strategies: rms heading error.

    python3 fading.py [RUNS] [CASES]

Open loop, linear, one exact step a second (Van Loan); states [dv_N dv_E phi nab_N nab_E eps]; all runs at once.
"""
import sys
import numpy as np
from scipy.linalg import expm
from scipy.stats import chi2

DEG = np.pi / 180
ARCMIN, DPH, UG, OMEGA, LAT, R_M, R_N = DEG / 60, DEG / 3600, 9.80665e-6, 7.292115e-5, 45 * DEG, 6367381.8, 6388838.3
G, S, C = 9.806197, np.sin(LAT), np.cos(LAT)
NOISE, WINDOW = 0.02, 30
PRIOR = np.array([0.1, 0.1, 0.1 * DEG, 0.1 * DEG, DEG, 50 * UG, 50 * UG] + [0.01 * DPH] * 3)
DENSITY = np.array([10 * UG] * 2 + [0.003 * DEG / 60] * 3 + [0] * 5)


def step(density):
    f = np.zeros((10, 10))
    f[0, 3], f[0, 5], f[1, 2], f[1, 6] = G, 1, -G, 1
    f[0, 1], f[1, 0] = -2 * OMEGA * S, 2 * OMEGA * S
    f[2:5, 2:5] = -OMEGA * np.array([[0, S, 0], [-S, 0, -C], [0, C, 0]])
    f[2:5, 7:10] = -np.eye(3)
    f[2, 1], f[3, 0], f[4, 1] = 1 / R_N, -1 / R_M, -S / C / R_N
    e = expm(np.block([[-f, np.diag(density**2)], [np.zeros((10, 10)), f.T]]))
    phi = e[10:, 10:].T
    return phi, phi @ e[:10, 10:]


def held(p, before, prior):
    """Eigenvalues in units of the prior: not above one, unless the matrix had more in that direction before."""
    unit = np.outer(prior, prior)
    values, u = np.linalg.eigh(p / unit)
    had = np.einsum('kij,kil,klj->kj', u, before / unit, u)
    values = np.minimum(values, np.maximum(1, had))
    return (u * values[:, None, :]) @ u.transpose(0, 2, 1) * unit


def run(case, strategy, runs, cap='prior', seed=1):
    """rms of phi_D (arcmin), its standard deviation, mean NEES of heading."""
    rng = np.random.default_rng(seed)
    phi, q_true = step(DENSITY)
    scale = np.sqrt(np.where(np.diag(q_true) > 0, np.diag(q_true), 1))
    values, u = np.linalg.eigh(q_true / np.outer(scale, scale))
    root = scale[:, None] * u * np.sqrt(np.maximum(values, 0))
    own, q, r = PRIOR.copy(), q_true, np.full((runs, 2), NOISE**2)
    if case == 'wrong_r':
        r = r * 0.01
    if case == 'wrong_q':
        q = step(DENSITY * 0.1)[1]
    if case == 'wrong_p0':
        own[2:5] *= [0.1, 0.1, 0.05]
    prior = own if cap == 'own' else PRIOR
    x = rng.standard_normal((runs, 10)) * np.r_[0, 0, PRIOR[2:]]
    p = np.broadcast_to(np.diag(own**2), (runs, 10, 10))
    xh, v, said = np.zeros((runs, 10)), None, np.broadcast_to(r, (WINDOW, runs, 2)).copy()
    nus, nises = np.zeros((WINDOW, runs, 2)), np.zeros((WINDOW, runs))
    threshold = chi2.ppf(0.995 if case == 'wrong_p0' else 0.999, 2 * WINDOW)
    keep = np.exp(-0.1)
    colour = NOISE * rng.standard_normal((runs, 2))
    for k in range(300 if case == 'velocity_burst' else 600):
        if case == 'base_moved' and k == 300:
            x = x + np.r_[0, 0, 0.02 * DEG, 0.02 * DEG, 0.5 * DEG, [0] * 5]
        x = x @ phi.T + rng.standard_normal((runs, 10)) @ root.T
        noise = NOISE * rng.standard_normal((runs, 2)) * (20 if case == 'velocity_burst' and 200 <= k < 260 else 1)
        if case == 'coloured_noise':
            colour = noise = keep * colour + np.sqrt(1 - keep**2) * noise
        xh = xh @ phi.T
        p = before = phi @ p @ phi.T
        nu = x[:, :2] + noise - xh[:, :2]
        carried = p[:, [0, 1], [0, 1]]
        predicted = carried + np.diag(q)[:2]
        s = (p + q)[:, :2, :2] + r[:, :, None] * np.eye(2)
        nus[k % WINDOW], used = nu, r
        nises[k % WINDOW] = np.einsum('ki,ki->k', nu, np.linalg.solve(s, nu[:, :, None])[:, :, 0])
        fires = (nises.sum(0) > threshold) & (k >= WINDOW - 1)
        c = (nus**2).mean(0)
        if isinstance(strategy, float):
            p = p * strategy
        elif strategy == 'single factor':
            wanted = c.sum(1) - np.trace(q[:2, :2]) - r.sum(1)
            p = p * np.where(fires, np.maximum(1, wanted / carried.sum(1)), 1)[:, None, None]
        elif strategy == 'multiple fading':
            factors = np.where(fires[:, None], np.sqrt(np.maximum(1, (c - r) / predicted)), 1)
            shared = p[:, :, :2] ** 2 / carried[:, None, :]
            of = np.where(shared[:, :, 1] >= shared[:, :, 0], factors[:, 1:], factors[:, :1])
            p = p * of[:, :, None] * of[:, None, :]
        elif strategy == 'strong tracking':
            v = nu**2 if v is None else (0.95 * v + nu**2) / 1.95
            excess = v.sum(1) - np.trace(q[:2, :2]) - 2 * r.sum(1)
            p = p * np.maximum(1, excess / carried.sum(1))[:, None, None]
        elif strategy == 'adaptive noise':
            mean = np.clip(said.mean(0), 1e-4 * r, 1e4 * r)
            said[k % WINDOW] = mean + (mean / (predicted + mean)) ** 2 * (nu**2 - predicted - mean)
            used = np.clip(said.mean(0), 1e-4 * r, 1e4 * r)
        if cap != 'none' and p is not before:
            p = held(p, before, prior)
        p = p + q
        s = p[:, :2, :2] + used[:, :, None] * np.eye(2)
        gain = np.linalg.solve(s, p[:, :2, :]).transpose(0, 2, 1)
        xh = xh + np.einsum('kij,kj->ki', gain, nu)
        a = np.eye(10) - np.pad(gain, ((0, 0), (0, 0), (0, 8)))
        p = a @ p @ a.transpose(0, 2, 1) + (gain * used[:, None, :]) @ gain.transpose(0, 2, 1)
    square = (x[:, 4] - xh[:, 4]) ** 2
    rms = np.sqrt(square.mean())
    return rms / ARCMIN, square.std() / np.sqrt(runs) / (2 * rms) / ARCMIN, (square / p[:, 4, 4]).mean()


if __name__ == '__main__':
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    cases = sys.argv[2:] or ['wrong_p0', 'wrong_r', 'wrong_q', 'base_moved', 'velocity_burst', 'coloured_noise']
    for case in cases:
        ways = [('plain', 'prior'), (1.01, 'prior'), (1.01, 'none'), ('single factor', 'prior'), ('multiple fading', 'prior'),
                ('strong tracking', 'prior'), ('adaptive noise', 'prior')]
        if case == 'wrong_p0':
            ways += [(1.01, 'own'), ('single factor', 'own'), ('multiple fading', 'own')]
        for strategy, cap in ways:
            rms, sd, nees = run(case, strategy, runs, cap)
            print(f"{case}: {strategy}, cap {cap}: {rms:.3g} +- {sd:.2g} arcmin, NEES {nees:.3g}", flush=True)
