"""Writes allantools.csv and allantools_edf.csv beside itself. See README.md for the series."""

import pathlib

import allantools
import numpy

N, RATE = 5000, 100.0
OUT = pathlib.Path(__file__).parent


def series():
    n, r, out = 42, 0.0, []
    for _ in range(N):
        w = n / 2147483647 - 0.5
        r += w / 16
        out.append(w + r)
        n = n * 16807 % 2147483647
    return numpy.array(out)


def main():
    rate = series()
    head = f"# allantools {allantools.__version__}, numpy {numpy.__version__}, make_allantools.py\n"
    factors = [1, 2, 3, 4, 7, 8, 10, 16, 32, 50, 64, 100, 128, 256, 500, 512, 1000, 1024, 1500]
    taus = [m / RATE for m in factors]
    with open(OUT / "allantools.csv", "w") as f:
        f.write(head + "estimator,m,deviation\n")
        for name in ["adev", "oadev", "mdev", "hdev", "ohdev", "totdev"]:
            t, dev, _, _ = getattr(allantools, name)(rate, rate=RATE, data_type="freq", taus=taus)
            for tau, d in zip(t, dev):
                f.write(f"{name},{round(tau * RATE)},{d:.17e}\n")
    with open(OUT / "allantools_edf.csv", "w") as f:
        f.write(head + "estimator,alpha,m,edf\n")
        for name, d, overlapping, modified in [
            ("adev", 2, False, False),
            ("oadev", 2, True, False),
            ("mdev", 2, True, True),
            ("hdev", 3, False, False),
            ("ohdev", 3, True, False),
        ]:
            for alpha in [0, -1, -2]:
                for m in [1, 2, 5, 10, 20, 100, 500, 1000]:
                    edf = allantools.ci.edf_greenhall(alpha, d, m, N + 1, overlapping, modified)
                    f.write(f"{name},{alpha},{m},{edf:.9e}\n")


main()
