"""Does the cost grow with the pixels alone, is the worst case bounded, and are the bytes the same for any threads?

One photograph resized to 3, 6, 12, 24 and 48 megapixels with its calibration scaled alike: CPU time and peak memory for
each pixel must never be over 1.3 times those of a smaller one. Then 12 megapixels of noise, without and with weak stripes below it: it
must end, surface or refusal, within three times a photograph's time. Then the PLY's hash with 1, 2, 3 and 7 threads and
on one processor. Exit code 1 when one of these does not hold, 77 (skipped) without the photograph."""
import argparse
import hashlib
import json
import os
import sys
import tempfile

import numpy as np

from surfaces import must_run, run, skip


def scaled(calibration, factor, size):
    c = json.loads(json.dumps(calibration))
    c["image_size"] = list(size)
    for key in ("fx", "fy"):
        c["camera"][key] *= factor
    for key in ("cx", "cy"):
        c["camera"][key] = (c["camera"][key] + 0.5) * factor - 0.5
    return c


def growth(options, folder, image, calibration):
    from PIL import Image
    print(f"{'megapixels':>10} {'points':>9} {'wall s':>7} {'CPU s':>7} {'MiB':>6} {'ns CPU/px':>10} {'bytes/px':>9}")
    costs = []
    for megapixels in options.megapixels:
        factor = (megapixels * 1e6 / (image.width * image.height)) ** 0.5
        size = (round(image.width * factor), round(image.height * factor))
        path, rig = os.path.join(folder, "resized.jpg"), os.path.join(folder, "rig.json")
        image.resize(size, Image.BICUBIC).save(path, quality=92)
        with open(rig, "w") as file:
            json.dump(scaled(calibration, factor, size), file)
        command = [options.striae, "reconstruct", path, "--calibration", rig, "--out", os.path.join(folder, "s.ply"), "--json"]
        runs = [must_run(command) for _ in range(options.runs)]
        wall, cpu, peak = (min(r[i] for r in runs) for i in range(3))
        pixels = size[0] * size[1]
        costs.append((cpu / pixels * 1e9, peak * 2**20 / pixels))
        print(f"{pixels / 1e6:10.1f} {json.loads(runs[0][4])['points']:9d} {wall:7.2f} {cpu:7.2f} {peak:6.0f} {costs[-1][0]:10.0f} {costs[-1][1]:9.1f}")
    good = True
    for name, values in zip(("CPU time", "memory"), zip(*costs)):
        # A fixed part (libraries, threads, tables) makes small photographs dearer for each pixel: not what is asked here.
        growth = max(after / before for i, before in enumerate(values) for after in values[i + 1:])
        good &= growth < 1.3
        print(f"{name} for each pixel: at most {growth:.2f} times that of any smaller photograph")
    return good


def worst_case(options, folder, image, usual):
    from PIL import Image
    random = np.random.default_rng(1)
    height, width = image.height, image.width
    good = True
    stripes = np.sin(2 * np.pi * np.arange(height) / 18)[:, None]
    for name, share in (("noise alone", 0.0), ("noise, weak stripes (5 %)", 0.05), ("noise, stripes (20 %)", 0.2), ("noise, stripes (45 %)", 0.45)):
        grey = np.clip(128 + 60 * random.standard_normal((height, width)) + 127 * share * stripes, 0, 255).astype(np.uint8)
        path = os.path.join(folder, "noise.png")
        Image.fromarray(grey).save(path, compress_level=1)
        for command in (["reconstruct", path, "--calibration", options.calibration, "--out", os.path.join(folder, "n.ply"), "--json"],
                        ["phase", path, "--out", os.path.join(folder, "n.tiff"), "--json"]):
            wall, cpu, peak, code, _ = run([options.striae, *command])
            good &= code in (0, 1) and cpu < 3 * usual
            print(f"{name:26} {command[0]:12} exit code {code} {wall:7.2f} s wall {cpu:7.2f} s CPU {peak:6.0f} MiB")
    return good


def threads(options, folder):
    hashes = {}
    ply = os.path.join(folder, "t.ply")
    command = [options.striae, "reconstruct", options.image, "--calibration", options.calibration, "--out", ply]
    settings = [(f"{n} threads", [], {"STRIAE_THREADS": str(n)}) for n in (1, 2, 3, 7)] + [("one processor", ["taskset", "-c", "0"], {})]
    for name, before, environment in settings:
        must_run(before + command, environment)
        with open(ply, "rb") as file:
            hashes[name] = hashlib.file_digest(file, "sha256").hexdigest()
        print(f"{name:14} {hashes[name][:16]}")
    return len(set(hashes.values())) == 1


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--striae", required=True)
    parser.add_argument("--image", required=True)
    parser.add_argument("--calibration", required=True)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--megapixels", type=float, nargs="+", default=[3, 6, 12, 24, 48])
    options = parser.parse_args()
    if not os.path.exists(options.image):
        skip(f"no {options.image}")
    try:
        from PIL import Image
    except ImportError:
        skip("no Pillow (Debian: python3-pil)")
    image = Image.open(options.image)
    image.load()
    with open(options.calibration) as file:
        calibration = json.load(file)
    with tempfile.TemporaryDirectory() as folder:
        same = threads(options, folder)
        print("the same bytes for any number of threads" if same else "DIFFERENT bytes for different threads")
        usual = must_run([options.striae, "reconstruct", options.image, "--calibration", options.calibration, "--out", os.path.join(folder, "u.ply")])[1]
        bounded = worst_case(options, folder, image, usual)
        print("the worst case is bounded" if bounded else "the worst case is NOT bounded")
        flat = growth(options, folder, image, calibration)
        print("the cost grows with the pixels alone" if flat else "the cost for each pixel is NOT flat")
    sys.exit(0 if same and bounded and flat else 1)


if __name__ == "__main__":
    main()
