"""The practice set (another program's photographs, another rig) with the own calibration and with the true rig.

For each photograph: depth against its truth at every 8th pixel, untrimmed; coverage of the lit field as the program says
it; how the stripes were counted; points within twice their uncertainty. Exit code 77 (skipped) without the set."""
import argparse
import glob
import json
import os
import tempfile

import numpy as np

from surfaces import must_run, read_points, run, skip

STEP = 8  # the truth's pixels


def depth_errors(ply, truth):
    points = read_points(ply)
    points = points[(points["col"] % STEP == 0) & (points["row"] % STEP == 0)]
    depth = truth[points["row"] // STEP, points["col"] // STEP]
    known = np.isfinite(depth) & (depth > 0)
    u = points["uncertainty"][known] if "uncertainty" in points.dtype.names else None
    return points["z"][known].astype(float) - depth[known], u


def report_line(name, rig, report, errors, u):
    region = report["regions"][0]
    within = "" if u is None else f"{100 * np.mean(np.abs(errors) < 2 * u):6.1f} %"
    print(f"{name:28} {rig:5} {errors.mean():8.3f} {errors.std():8.4f} {np.median(np.abs(errors)):8.4f} "
          f"{np.percentile(np.abs(errors), 90):8.4f} {100 * report['coverage']:7.1f} % {region['order_source']:13}{within}")


def main():
    from PIL import Image
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--striae", required=True)
    parser.add_argument("--data", required=True, help="folder of the practice set")
    parser.add_argument("--kind", choices=["steps", "limbs", "heads"], action="append")
    options = parser.parse_args()
    if not os.path.exists(os.path.join(options.data, "true_small.json")):
        skip(f"no practice set in {options.data}")
    kinds = options.kind or ["steps", "limbs", "heads"]
    photographs = {
        "small": [("steps", "calibration/small_*.jpg"), ("limbs", "wound_*/*.jpg"), ("limbs", "artefacts/plane_small.jpg")],
        "large": [("steps", "calibration/large_*.jpg"), ("heads", "head/*.jpg")]}
    grating = {"small": ("140", "48", "900"), "large": ("67", "97", "1850")}
    with tempfile.TemporaryDirectory() as folder:
        ply = os.path.join(folder, "surface.ply")
        for size, groups in photographs.items():
            own = os.path.join(folder, f"{size}.json")
            stripes, period, distance = grating[size]
            calibration = must_run([options.striae, "calibrate", "--reference", f"{options.data}/calibration/reference_{size}.ply",
                                    "--steps", f"{options.data}/calibration/{size}.csv", "--stripes", stripes, "--period-um", period,
                                    "--distance-mm", distance, "--out", own, "--json"])
            report = json.loads(calibration[4])
            print(f"{size}: calibrated from {len(report['photographs'])} photographs in {calibration[0]:.1f} s: sd {report['sd_mm']:.4f} mm, "
                  f"robust {report['robust_sd_mm']:.4f} mm, coverage {100 * report['coverage']:.1f} %")
            print(f"{'photograph':28} {'rig':5} {'mean':>8} {'sd':>8} {'|median|':>8} {'|p90|':>8} {'covered':>9} {'order':13} within 2u")
            for pattern in (p for kind, p in groups if kind in kinds):
                for image in sorted(glob.glob(os.path.join(options.data, pattern))):
                    truth = np.asarray(Image.open(image.replace(".jpg", ".depth8.tiff")))
                    for rig, file in (("own", own), ("true", os.path.join(options.data, f"true_{size}.json"))):
                        done = run([options.striae, "reconstruct", image, "--calibration", file, "--out", ply, "--json"])
                        name = os.path.relpath(image, options.data)
                        if done[3] != 0:
                            print(f"{name:28} {rig:5} failed with exit code {done[3]}")
                            continue
                        report_line(name, rig, json.loads(done[4]), *depth_errors(ply, truth))


if __name__ == "__main__":
    main()
