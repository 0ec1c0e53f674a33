"""Times allantools.oadev against this crate on the same series, in one run, and compares the numbers. See README.md."""

import pathlib
import platform
import subprocess
import sys
import tempfile
import time

import allantools
import numpy

ROOT = pathlib.Path(__file__).resolve().parents[4]
RATE = 100.0
REPEATS = 5


def ours(path, factors):
    command = ["cargo", "run", "--release", "--quiet", "-p", "schuler-allan", "--example", "time_oadev", "--"]
    command += [str(path), str(RATE), *map(str, factors)]
    lines = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    times = dict(line.split()[1:] for line in lines if line.startswith("time "))
    deviations = [float(line.split()[2]) for line in lines if line.startswith("deviation ")]
    return {way: float(seconds) for way, seconds in times.items()}, deviations


def best(work):
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        result = work()
        times.append(time.perf_counter() - start)
    return min(times), result


def main():
    n = int(float(sys.argv[1])) if len(sys.argv) > 1 else 1_000_000
    generator = numpy.random.default_rng(1)
    rate = generator.normal(size=n) + 0.001 * numpy.cumsum(generator.normal(size=n))
    factors = [2**k for k in range(64) if 2 * 2**k <= n]
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "rate.npy"
        numpy.save(path, rate)
        times, deviations = ours(path, factors)
    taus = [m / RATE for m in factors]
    seconds, (_, theirs, _, _) = best(
        lambda: allantools.oadev(rate, rate=RATE, data_type="freq", taus=taus)
    )
    worst = max(abs(a / b - 1) for a, b in zip(deviations, theirs))
    print(f"{n} samples, {len(factors)} octaves, best of {REPEATS}, one thread each, {platform.machine()}")
    print(f"allantools {allantools.__version__}, numpy {numpy.__version__}: {1e9 * seconds / n:.1f} ns a sample")
    for way, ns in times.items():
        print(f"{way}: {1e9 * ns / n:.2f} ns a sample, {seconds / ns:.0f} times as fast")
    print(f"largest relative difference of the overlapping deviations: {worst:.1e}")
    if seconds < 10 * times["overlapping"] or worst > 1e-9:
        sys.exit("less than ten times as fast, or other numbers")


main()
