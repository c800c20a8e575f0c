"""Wounds through the whole chain, against bars: photographs by the virtual rig, own calibration, surface, measurement.

Bodies, wounds and rigs are made by wound_bodies.py; no parameter of a rig is told to the program. Photographs, surfaces
(cut out around the wound; --discard deletes them when measured) and outlines are kept in --cache, results.jsonl there has
a line for each scene. Prints the table of the bars; exit code 1 when one is missed and --strict is given, 77 (skipped)
without numpy."""
import argparse
import json
import os
import shutil
import sys

try:
    import numpy as np
except ImportError:
    print("skipped: no numpy")
    sys.exit(77)

import wound_bodies as bodies
from surfaces import must_run, read_vertices, run
from wound_table import print_table

OUTLINE_JITTER_MM = 0.5


def unknown_rig(seed):
    """A rig for 1 m: focal length within 1 %, principal point 25 px, projector 5 mm and a fifth of a degree."""
    rng = np.random.default_rng(1000 + seed)
    off = lambda most: rng.uniform(-most, most)
    f = 9570 * (1 + off(0.01))
    centre = [3 + off(5), -112 + off(5), 44 + off(5)]
    down = float(np.arctan2(-centre[1], 1000 - centre[2]))
    return {"format": "striae-calibration/1", "image_size": [4288, 2848],
            "camera": {"fx": f, "fy": f * (1 + off(0.001)), "cx": 2144 + off(25), "cy": 1424 + off(25), "k1": -0.04 + off(0.03),
                       "k2": 0.02 + off(0.03), "p1": off(2e-4), "p2": off(2e-4)},
            "projector": {"model": "pinhole", "center_mm": centre, "rotation_rodrigues": [down + off(0.0035), off(0.005), off(0.005)],
                          "focal_stripes": 523 * (1 + off(0.02)), "center_order": 69.5 + off(1.5), "k1": -0.02 + off(0.015)},
            "grating": {"stripes": 140, "direction": "horizontal"}, "working_distance_mm": [850, 1150]}


class Rig:
    def __init__(self, options, seed):
        self.folder = os.path.join(options.cache, f"rig-{seed}")
        self.true, self.own = os.path.join(self.folder, "true.json"), os.path.join(self.folder, "own.json")
        self.parameters = unknown_rig(seed)
        if os.path.exists(self.own):
            return
        os.makedirs(self.folder, exist_ok=True)
        with open(self.true, "w") as file:
            json.dump(self.parameters, file)
        steps = os.path.join(self.folder, "steps")
        must_run([options.maker, "simulate", "steps", "--rig", self.true, "--out", steps, "--steps", "9", "--step-mm", "25",
                  "--seed", seed])
        must_run([options.maker, "calibrate", "--reference", f"{steps}/reference.ply", "--steps", f"{steps}/steps.csv", "--stripes",
                  "140", "--period-um", "48", "--distance-mm", "900", "--out", self.own])
        shutil.rmtree(steps)


def draw_wound(seed, kind):
    """Depth and radius: volumes evenly over the decades from 0.1 to 30 mL (heel: to 5), 1.5 to 15 mm deep."""
    rng = np.random.default_rng(seed)
    while True:
        depth, volume = np.exp(rng.uniform(np.log(1.5), np.log(15))), 10 ** rng.uniform(-1, np.log10(5 if kind == "heel" else 30))
        body = {"limb": rng.uniform(45, 62), "calf": rng.uniform(52, 68), "heel": rng.uniform(40, 46), "flat": 0}[kind]
        radius = np.sqrt(1000 * volume / (1.3 * np.pi * 0.55 * depth))
        if 4 < radius < 32 and depth < 1.0 * radius and (kind == "flat" or 1.6 * radius < 0.75 * body):
            return depth, radius, body


def place(points, rng):
    """Hand-held: within 10 degrees and 30 mm."""
    turn = bodies.rotation(*rng.uniform(-10, 10, 3))
    return lambda p: p @ turn.T + np.array([0, 0, 1000]) + shift, turn, (shift := rng.uniform(-30, 30, 3))


def cut_surface(path, outline, target):
    """Keeps the points within 480 pixels (50 mm) of the outline."""
    header, points = read_vertices(path)
    low, high = outline.min(0) - 480, outline.max(0) + 480
    kept = points[(points["col"] > low[0]) & (points["col"] < high[0]) & (points["row"] > low[1]) & (points["row"] < high[1])]
    lines = [f"element vertex {len(kept)}" if line.startswith("element vertex") else line for line in header
             if not line.startswith(("element face", "property list"))]
    with open(target, "wb") as file:
        file.write(("\n".join(lines + ["end_header", ""])).encode())
        kept.tofile(file)


def jittered(outline, mm_per_px, seed, coarse=None):
    """Every point moved by 0.5 mm (one sd a coordinate); drawn coarsely (by default every other one) points are 2 mm apart."""
    rng = np.random.default_rng(seed)
    if seed % 2 if coarse is None else coarse:
        keep = [outline[0]]
        for p in outline[1:]:
            if np.hypot(*(p - keep[-1])) * mm_per_px > 2:
                keep.append(p)
        outline = np.array(keep)
    return outline + rng.normal(0, OUTLINE_JITTER_MM / mm_per_px, outline.shape)


def scene(options, rig, name, wound, pose_seed, oedema=0.0):
    """Renders and reconstructs once; returns folder and truth."""
    folder = os.path.join(options.cache, name)
    if os.path.exists(os.path.join(folder, "truth.json")):
        with open(os.path.join(folder, "truth.json")) as file:
            return folder, json.load(file)
    os.makedirs(folder, exist_ok=True)
    kind, seed, depth, radius, body = wound
    points, triangles, colour, line, truth = bodies.make(kind, seed, depth, radius, body, oedema)
    rng = np.random.default_rng(pose_seed)
    move, _, _ = place(points, rng)
    outline = bodies.project(rig.parameters["camera"], move(line))
    mesh, out = os.path.join(folder, "body.ply"), os.path.join(folder, "rendered")
    bodies.write_ply(mesh, move(points), triangles, colour)
    must_run([options.maker, "simulate", "mesh", mesh, "--in-camera", "--rig", rig.true, "--out", out, "--seed", pose_seed % 100000])
    whole = os.path.join(folder, "whole.ply")
    wall, _, _, code, said = run([options.maker, "reconstruct", f"{out}/mesh.jpg", "--calibration", rig.own, "--out", whole, "--json",
                                  "--distance-mm", str(round(float(move(line)[:, 2].mean())))])
    truth |= {"outline_px": outline.tolist(), "mm_per_px": float(move(line)[:, 2].mean() / rig.parameters["camera"]["fx"]),
              "failed": code != 0, "photo": "mesh.jpg"}
    if code == 0:
        cut_surface(whole, outline, os.path.join(folder, "surface.ply"))
        os.remove(whole)
    shutil.move(f"{out}/mesh.jpg", os.path.join(folder, "mesh.jpg"))
    shutil.rmtree(out)
    os.remove(mesh)
    with open(os.path.join(folder, "truth.json"), "w") as file:
        json.dump(truth, file)
    return folder, truth


def measure(options, folder, polygon, tag):
    path = os.path.join(folder, f"outline-{tag}.json")
    with open(path, "w") as file:
        json.dump({"polygon_px": polygon.tolist()}, file)
    return measure_with(options, folder, path)


def measure_with(options, folder, path):
    process = run([options.striae, "measure", "wound", os.path.join(folder, "surface.ply"), "--outline", path, "--json"])
    return (json.loads(process[4]) if process[3] == 0 else None), process[0]


def compare(report, truth):
    """Relative errors and errors over standard uncertainties."""
    values = {m["name"]: m for m in report["measurements"]}
    result = {}
    for name, key in (("volume", "volume_ml"), ("area", "area_cm2"), ("depth_max", "depth_mm"),
                      ("perimeter", "perimeter_mm")):
        m = values[name]
        result[name] = (m["value"] / truth[key] - 1, (m["value"] - truth[key]) / m["uncertainty"], m["status"] == "flagged")
    result["skin_flagged"] = any(word in values["volume"].get("reason", "") for word in ("skin", "models"))
    return result


def jitter_area_sd(polygon, mm_per_px, area_cm2):
    """What independent shakes of the points do to a polygon's area, relative: each point's share is half the chord beside it."""
    half = np.hypot(*(np.roll(polygon, 1, 0) - np.roll(polygon, -1, 0)).T) * mm_per_px / 2
    return float(OUTLINE_JITTER_MM * np.sqrt(np.sum(half**2)) / 100 / area_cm2)


def keep(options, name, truth, report, needed=False):
    """One line a scene, so that nothing is lost when a long run ends early; the surface goes with --discard unless needed again."""
    with open(os.path.join(options.cache, "results.jsonl"), "a") as file:
        file.write(json.dumps({"name": name, "truth": {k: v for k, v in truth.items() if k != "outline_px"}, "report": report}) + "\n")
    if not needed:
        discard(options, os.path.join(options.cache, name))


def discard(options, folder):
    if options.discard:
        shutil.rmtree(folder, ignore_errors=True)


KINDS = ["limb", "calf", "flat", "limb", "heel"]


def bar_scene(options, rigs, i):
    kind = KINDS[i % len(KINDS)]
    return scene(options, rigs[i % len(rigs)], f"scene-{i:03d}", (kind, 100 + i, *draw_wound(100 + i, kind)), 5000 + i)


def bars(options, rigs):
    rows = []
    print(f"{'scene':>12} {'kind':5} {'mL':>6} {'mean':>5} {'max mm':>6} {'cm2':>6} wall | {'volume %':>9} {'e/u':>5} | {'area %':>7} {'e/u':>5} | "
          f"{'depth %':>7} {'e/u':>5} | seconds, flags")
    for i in range(options.first, options.first + options.scenes):
        folder, truth = bar_scene(options, rigs, i)
        label = f"{i:12d} {truth['kind']:5} {truth['volume_ml']:6.2f} {truth['mean_depth_mm']:5.2f} {truth['depth_mm']:6.2f} {truth['area_cm2']:6.2f} {truth['wall']:4.1f} |"
        polygon = jittered(np.array(truth["outline_px"]), truth["mm_per_px"], i)
        truth |= {"points": len(polygon), "jitter_area_sd": jitter_area_sd(polygon, truth["mm_per_px"], truth["area_cm2"])}
        report, seconds = (None, 0) if truth["failed"] else measure(options, folder, polygon, "jittered")
        keep(options, f"scene-{i:03d}", truth, report, needed=i < options.first + options.proposals)
        if report is None:
            print(label, "no surface" if truth["failed"] else "refused", flush=True)
            rows.append((truth, None))
            continue
        e = compare(report, truth)
        flags = {m.get("reason", "") for m in report["measurements"]} - {""}
        print(label, " | ".join(f"{100 * e[n][0]:{w}.2f} {e[n][1]:5.1f}" for n, w in (("volume", 9), ("area", 7), ("depth_max", 7))),
              f"| {seconds:.1f}", "; ".join(flags)[:150], flush=True)
        rows.append((truth, e))
    return rows


def oedema(options, rigs):
    """Swollen rims of 1 and 2 mm: error with the moved ring against the ring beside the line; flagged or not."""
    print("\nswollen rims: error of the volume, of the naive ring, gap, flags")
    for i in range(options.oedema):
        rim = 1.0 + i % 2
        volume = [1.0, 3.0, 8.0][i // 2 % 3]
        depth = [5.0, 6.0, 8.0][i // 2 % 3]
        radius = np.sqrt(1000 * volume / (1.3 * np.pi * 0.55 * depth))
        wound = (KINDS[i % 3], 900 + i, depth, radius, 55)
        folder, truth = scene(options, rigs[i % len(rigs)], f"oedema-{i:03d}", wound, 7000 + i, rim)
        polygon = jittered(np.array(truth["outline_px"]), truth["mm_per_px"], i)
        report, _ = measure(options, folder, polygon, "jittered")
        keep(options, f"oedema-{i:03d}", truth, report)
        if report is None:
            print(f"  rim {rim} mm, {truth['volume_ml']:.2f} mL: refused")
            continue
        m = report["measurements"][0]
        naive = report["net_volume_at_first_gap_ml"] / truth["volume_ml"] - 1
        print(f"  {truth['kind']:5} rim {rim} mm, width {truth['oedema_width_mm']:.1f}, {truth['volume_ml']:.2f} mL: "
              f"{100 * (m['value'] / truth['volume_ml'] - 1):+7.1f} %, naive {100 * naive:+7.1f} %, e/u "
              f"{(m['value'] - truth['volume_ml']) / m['uncertainty']:+.1f}, gap {report['skin']['gap_mm']}, {m['status']} {m.get('reason', '')[:80]}", flush=True)


def propose(options, folder, hints):
    """The outline that the program proposes, measured: the report or None, and the proposal's file."""
    path = os.path.join(folder, "proposed.json")
    code = run([options.striae, "measure", "boundary", os.path.join(folder, "surface.ply"), *hints, "--out", path])[3]
    return measure_with(options, folder, path)[0] if code == 0 else None, path


def repeats(options, rigs):
    """Ten hand-held captures of one wound, each outlined anew: with 72 points, more coarsely, and moved to the visible edge."""
    cv = lambda x: 100 * np.std(x, ddof=1) / np.mean(x)
    for wound_index in range(options.repeats):
        kind = ["limb", "flat", "heel", "calf"][wound_index % 4]
        depth, radius, body = [(5, 12, 55), (4, 9, 0), (4, 10, 43), (8, 18, 60)][wound_index % 4]
        wound = (kind, 800 + wound_index, depth, radius, body)
        volumes, areas = [], {"72 points": [], "points 2 mm apart": [], "moved to the edge": []}
        for k in range(10):
            folder, truth = scene(options, rigs[0], f"repeat-{wound_index}-{k}", wound, 8000 + 10 * wound_index + k)
            outline, seed = np.array(truth["outline_px"]), 100 * wound_index + k
            fine, _ = measure(options, folder, jittered(outline, truth["mm_per_px"], seed, coarse=False), "jittered")
            coarse, _ = measure(options, folder, jittered(outline, truth["mm_per_px"], seed, coarse=True), "coarse")
            moved, _ = propose(options, folder, ["--photo", os.path.join(folder, "mesh.jpg"), "--outline",
                                                 os.path.join(folder, "outline-coarse.json")])
            keep(options, f"repeat-{wound_index}-{k}", truth, fine)
            for name, report in zip(areas, (fine, coarse, moved)):
                values = {m["name"]: m["value"] for m in report["measurements"]} if report else {}
                areas[name] += [values["area"]] if values else []
                volumes += [values["volume"]] if values and report is fine else []
        print(f"repeatability, {kind}, {truth['volume_ml']:.2f} mL, {truth['area_cm2']:.2f} cm2, {len(volumes)} captures: volume CV "
              f"{cv(volumes):.2f} % (bar 2), mean error {100 * (np.mean(volumes) / truth['volume_ml'] - 1):+.2f} %; area CV (bar 1.5) "
              + ", ".join(f"{name} {cv(values):.2f} %" for name, values in areas.items()), flush=True)


def proposals(options, rigs):
    """What `measure boundary` proposes from a rough box around the first scenes' wounds, with the photograph and without."""
    for name in ("surface alone", "photograph", "photograph and the shaken outline"):
        areas, volumes, spreads, refused = [], [], [], 0
        for i in range(options.first, options.first + options.proposals):
            folder, truth = bar_scene(options, rigs, i)
            outline, rng = np.array(truth["outline_px"]), np.random.default_rng(i)
            off = rng.normal(0, 1.5, 4) / truth["mm_per_px"]  # the box's sides: 3 mm outside, 1.5 mm rough
            box = np.concatenate([outline.min(0) - 3 / truth["mm_per_px"], outline.max(0) + 3 / truth["mm_per_px"]]) + off
            hints = ["--photo", os.path.join(folder, "mesh.jpg")] if "photograph" in name else []
            if "outline" in name:
                measure(options, folder, jittered(outline, truth["mm_per_px"], i), "jittered")
                hints += ["--outline", os.path.join(folder, "outline-jittered.json")]
            else:
                hints += ["--box", *box]
            report, path = propose(options, folder, hints)
            if report is None:
                refused += 1
                continue
            values = {m["name"]: m["value"] for m in report["measurements"]}
            areas.append(values["area"] / truth["area_cm2"] - 1)
            volumes.append(values["volume"] / truth["volume_ml"] - 1)
            with open(path) as file:
                spreads.append(json.load(file)["repeatability"]["area_cv_percent"])
        print(f"proposed boundaries, {name} ({len(areas)}, {refused} refused): area off by median {np.median(np.abs(areas)):.1%}, nine of ten "
              f"below {np.percentile(np.abs(areas), 90):.1%}, worst {np.max(np.abs(areas)):.1%}; volume {np.median(np.abs(volumes)):.1%}, {np.percentile(np.abs(volumes), 90):.1%}; "
              f"pointed at anew, area CV median {np.median(spreads):.2f} %, nine of ten below {np.percentile(spreads, 90):.2f} %", flush=True)
    for i in range(options.first, options.first + options.proposals):
        discard(options, os.path.join(options.cache, f"scene-{i:03d}"))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--striae", required=True, help="program that measures")
    parser.add_argument("--maker", help="program that renders, calibrates and reconstructs (default: the same)")
    parser.add_argument("--cache", required=True, help="folder for scenes")
    parser.add_argument("--scenes", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--rigs", type=int, default=2)
    parser.add_argument("--oedema", type=int, default=0)
    parser.add_argument("--repeats", type=int, default=0, help="wounds photographed ten times each")
    parser.add_argument("--proposals", type=int, default=0, help="of the scenes, how many are outlined by the program itself")
    parser.add_argument("--discard", action="store_true", help="delete each surface when it is measured")
    parser.add_argument("--strict", action="store_true", help="exit code 1 when a bar is missed")
    options = parser.parse_args()
    options.maker = options.maker or options.striae
    rigs = [Rig(options, seed) for seed in range(options.rigs)]
    missed = print_table(bars(options, rigs)) if options.scenes else []
    if options.oedema:
        oedema(options, rigs)
    if options.repeats:
        repeats(options, rigs)
    if options.proposals:
        proposals(options, rigs)
    return 1 if options.strict and missed else 0


if __name__ == "__main__":
    sys.exit(main())
