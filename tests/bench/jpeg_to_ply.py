"""JPEG to coloured PLY with Striae, beside numpy + scipy + scikit-image doing the phase alone, in the same run.

Runs alternate, so that a busy machine slows both; medians, their ratio, and the peak of memory are printed.
Exit code 77 (skipped) where the image or scikit-image is missing."""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time


def run(command):
    """Wall seconds, CPU seconds, peak MiB and standard output of a program."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    out = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{command[0]} failed with {process.returncode}")
    return time.perf_counter() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, out


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--striae", required=True)
    parser.add_argument("--image", required=True)
    parser.add_argument("--calibration", required=True)
    parser.add_argument("--runs", type=int, default=5)
    options = parser.parse_args()
    if not os.path.exists(options.image):
        print(f"skipped: no {options.image}")
        sys.exit(77)
    try:
        import skimage.restoration  # noqa: F401
    except ImportError:
        print("skipped: no scikit-image (Debian: python3-skimage)")
        sys.exit(77)
    peer_script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "numpy_phase.py")
    ours, peers, document = [], [], None
    with tempfile.TemporaryDirectory() as folder:
        ply = os.path.join(folder, "surface.ply")
        command = [options.striae, "reconstruct", options.image, "--calibration", options.calibration, "--out", ply, "--json"]
        for _ in range(options.runs):
            ours.append(run(command))
            document = json.loads(ours[-1][3])
            peers.append(run([sys.executable, peer_script, options.image, str(document["carrier_period_px"])]))
    for name, runs in (("striae, JPEG to PLY with faces", ours), ("numpy + scikit-image, phase alone", peers)):
        wall, cpu, peak = (statistics.median(r[i] for r in runs) for i in range(3))
        print(f"{name:36} {wall:7.2f} s wall {cpu:7.2f} s CPU {peak:7.0f} MiB")
    print("stages (s): " + ", ".join(f"{k} {v:.2f}" for k, v in document["seconds"].items()))
    ratio = statistics.median(p[0] / o[0] for o, p in zip(ours, peers))
    print(f"ratio {ratio:.2f} (median of {options.runs} pairs; above 1: Striae is faster)")


if __name__ == "__main__":
    main()
