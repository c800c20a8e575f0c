"""JPEG to coloured PLY with Striae, beside numpy + scipy + scikit-image doing the phase alone, in the same run.

Also beside decoding the JPEG and writing the PLY alone: with Pillow (libjpeg) and one write of the finished bytes, and
with the program's own decoder and encoder, which are faster. Each floor starts anew and is timed inside, without its
start or the making of the surface. Runs alternate, so that a busy machine slows all; medians of
wall and CPU time, their ratios pair by pair, and the peak of memory are printed. On a busy machine the ratio of CPU
times says more than that of wall times. Exit code 77 (skipped) where the image or scikit-image is missing."""
import argparse
import json
import os
import statistics
import sys
import tempfile

from surfaces import must_run, skip


PILLOW = """
import sys, time
from PIL import Image
ply = open(sys.argv[2], "rb").read()
start = time.perf_counter()
Image.open(sys.argv[1]).convert("RGB").load()
with open(sys.argv[3], "wb") as out:
    out.write(ply)
print(time.perf_counter() - start)
"""


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
    floors = {"Pillow's decoding and one write": [], "Striae's own decoder and encoder": []}
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
            again = os.path.join(folder, "again.ply")
            floor_commands = [[sys.executable, "-c", PILLOW, options.image, ply, again]]
            if options.floor:
                floor_commands.append([options.floor, options.image, ply, again, 1])
            for floor, command_of_floor in zip(floors.values(), floor_commands):
                floor.append((ours[0], float(must_run(command_of_floor)[4])))
                os.remove(again)
    print(f"{document['points']} points; stages (s): " + ", ".join(f"{k} {v:.2f}" for k, v in document["seconds"].items()))
    ours = rows.pop("Striae, JPEG to PLY with faces")
    for name, runs in (("Striae, JPEG to PLY with faces", ours), *rows.items()):
        wall, cpu, peak = (statistics.median(r[i] for r in runs) for i in range(3))
        line = f"{name:36} {wall:7.2f} s wall {cpu:7.2f} s CPU {peak:7.0f} MiB"
        if runs is not ours:
            ratios = [statistics.median(p[i] / o[i] for o, p in zip(ours, runs)) for i in (0, 1)]
            line += f"   Striae is {ratios[0]:.1f} times faster (wall), {ratios[1]:.1f} (CPU)"
        print(line)
    for name, pairs in floors.items():
        if pairs:
            floor, ratio = (statistics.median(values) for values in ([f for _, f in pairs], [o / f for o, f in pairs]))
            print(f"decode + PLY write alone, {name}: {floor:.3f} s; the whole program takes {ratio:.1f} times as long")


if __name__ == "__main__":
    main()
