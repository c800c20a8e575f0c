"""JPEG to coloured PLY with Striae, beside numpy + scipy + scikit-image doing the phase alone, in the same run.

Also beside decoding the JPEG and writing the PLY alone. Runs alternate, so that a busy machine slows all; medians of
wall and CPU time, their ratios pair by pair, and the peak of memory are printed. On a busy machine the ratio of CPU
times says more than that of wall times. Exit code 77 (skipped) where the image or scikit-image is missing."""
import argparse
import json
import os
import statistics
import sys
import tempfile

from surfaces import must_run, skip


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--striae", required=True)
    parser.add_argument("--image", required=True)
    parser.add_argument("--calibration", required=True)
    parser.add_argument("--floor", help="the program decode_and_write")
    parser.add_argument("--runs", type=int, default=5)
    options = parser.parse_args()
    if not os.path.exists(options.image):
        skip(f"no {options.image}")
    try:
        import skimage.restoration  # noqa: F401
    except ImportError:
        skip("no scikit-image (Debian: python3-skimage)")
    peer = os.path.join(os.path.dirname(os.path.abspath(__file__)), "numpy_phase.py")
    rows = {"Striae, JPEG to PLY with faces": [], "numpy + scikit-image, phase, plain": [],
            "numpy + scikit-image, phase, tuned": []}
    inner = []
    with tempfile.TemporaryDirectory() as folder:
        ply = os.path.join(folder, "surface.ply")
        command = [options.striae, "reconstruct", options.image, "--calibration", options.calibration, "--out", ply, "--json"]
        for _ in range(options.runs):
            if os.path.exists(ply):
                os.remove(ply)  # to take a file of 150 MB off the disk takes longer than to write it
            ours = must_run(command)
            document = json.loads(ours[4])
            period = document["carrier_period_px"]
            rows["Striae, JPEG to PLY with faces"].append(ours)
            for kind in ("plain", "tuned"):
                rows[f"numpy + scikit-image, phase, {kind}"].append(must_run([sys.executable, peer, options.image, period, kind]))
            if options.floor:
                # A process of its own reads the surface first, so what it prints is taken and not its own time.
                floor = must_run([options.floor, options.image, ply, os.path.join(folder, "again.ply"), 3])
                inner.append(float(floor[4]))
    print(f"{document['points']} points; stages (s): " + ", ".join(f"{k} {v:.2f}" for k, v in document["seconds"].items()))
    ours = rows.pop("Striae, JPEG to PLY with faces")
    for name, runs in (("Striae, JPEG to PLY with faces", ours), *rows.items()):
        wall, cpu, peak = (statistics.median(r[i] for r in runs) for i in range(3))
        line = f"{name:36} {wall:7.2f} s wall {cpu:7.2f} s CPU {peak:7.0f} MiB"
        if runs is not ours:
            ratios = [statistics.median(p[i] / o[i] for o, p in zip(ours, runs)) for i in (0, 1)]
            line += f"   Striae is {ratios[0]:.1f} times faster (wall), {ratios[1]:.1f} (CPU)"
        print(line)
    if inner:
        ratio = statistics.median(o[0] / f for o, f in zip(ours, inner))
        print(f"decode + PLY write alone: {statistics.median(inner):.3f} s wall; the whole program takes {ratio:.1f} times as long")


if __name__ == "__main__":
    main()
