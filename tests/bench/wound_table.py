"""The table of the bars for measured scenes, and which of them are missed."""
import numpy as np

QUANTITIES = ("volume", "area", "depth_max", "perimeter")
SMALL_ML, SHALLOW_MM, LARGE_CM2, FINE_POINTS = 0.5, 2.5, 4, 70


def percent(values, f):
    return f"{100 * f(np.abs(values)):6.2f} %" if len(values) else "     -"


def pick(group, name, k=0):
    return np.array([error[name][k] for _, error in group])


def bar(text, value, limit, missed):
    """Prints one line and keeps it where the bar is missed."""
    holds = value is None or value <= limit
    print(f"{text}: {'holds' if holds else 'DOES NOT HOLD'}")
    if not holds:
        missed.append(text)


def worst(values):
    return float(np.max(np.abs(values))) if len(values) else None


def middle(values):
    return float(np.median(np.abs(values))) if len(values) else None


def volumes(done, missed):
    deep = [(t, e) for t, e in done if t["mean_depth_mm"] > SHALLOW_MM and t["volume_ml"] >= SMALL_ML]
    rest = [(t, e) for t, e in done if not (t["mean_depth_mm"] > SHALLOW_MM and t["volume_ml"] >= SMALL_ML)]
    doubtful = [row for row in deep if row[1]["skin_flagged"]]
    sure = [row for row in deep if not row[1]["skin_flagged"]]
    v, d = pick(sure, "volume"), pick(sure, "depth_max")
    bar(f"volume, mean depth over 2.5 mm ({len(v)}): median {percent(v, np.median)} (bar 1.5)", middle(v), 0.015, missed)
    bar(f"  worst {percent(v, np.max)} (bar 4)", worst(v), 0.04, missed)
    bar(f"greatest depth of these: median {percent(d, np.median)}, worst {percent(d, np.max)} (bar 3)", worst(d), 0.03, missed)
    print(f"  and {len(doubtful)} flagged for their skin: volume worst {percent(pick(doubtful, 'volume'), np.max)}, "
          f"depth worst {percent(pick(doubtful, 'depth_max'), np.max)}")
    s = pick(rest, "volume")
    off_mm3 = np.array([abs(e["volume"][0]) * t["volume_ml"] * 1000 for t, e in rest])
    over = np.array([max(0.0, abs(e["volume"][0]) / max(0.08, 0.030 / t["volume_ml"])) for t, e in rest])
    bar(f"volume, shallow or under 0.5 mL ({len(s)}): median {percent(s, np.median)}, worst {percent(s, np.max)}, median "
        f"{np.median(off_mm3) if len(off_mm3) else 0:.1f} mm3 (bar: median 8 %, or 30 mm3 where larger)", middle(over), 1, missed)


def areas(done, missed):
    """Every class against 3 %; what must hold is that nothing is further off than that or than the jitter explains."""
    for name, keep in (("all", lambda t: True), (f"over {LARGE_CM2} cm2, of 72 points", lambda t: t["area_cm2"] > LARGE_CM2 and t["points"] >= FINE_POINTS),
                       (f"over {LARGE_CM2} cm2, of fewer", lambda t: t["area_cm2"] > LARGE_CM2 and t["points"] < FINE_POINTS),
                       ("small, of 72 points", lambda t: t["area_cm2"] <= LARGE_CM2 and t["points"] >= FINE_POINTS),
                       ("small, of fewer", lambda t: t["area_cm2"] <= LARGE_CM2 and t["points"] < FINE_POINTS)):
        a = pick([(t, e) for t, e in done if keep(t)], "area")
        bar(f"area, {name} ({len(a)}): median {percent(a, np.median)}, worst {percent(a, np.max)} (bar 3)", worst(a), 0.03, [])
    expected = np.array([t["jitter_area_sd"] for t, _ in done])
    if len(expected) == 0:
        return
    print(f"  what the jitter alone does to the polygons' areas: sd up to {percent(expected, np.max)}")
    over = np.abs(pick(done, "area")) / np.maximum(0.03, 3 * expected)
    bar(f"area, all: worst over the larger of 3 % and 3 sd of the jitter {worst(over):.2f} (bar 1)", worst(over), 1, missed)


def coverage(done, missed):
    for name in QUANTITIES:
        r = pick(done, name, 1)
        if len(r) == 0:
            continue
        within = np.mean(np.abs(r) < 2)
        bar(f"{name}: within 2 u {100 * within:.1f} %, rms e/u {np.sqrt(np.mean(r * r)):.2f}"
            f" (bar 90-98{', above it' if within > 0.98 else ''})", 0.90 - within, 0, missed)


def print_table(rows):
    """Prints all; returns the bars that are missed. rows: (truth, errors or None)."""
    done = [(t, e) for t, e in rows if e]
    missed = []
    print(f"\n{len(rows)} scenes, {len(rows) - len(done)} refused or without surface, "
          f"{sum(e['volume'][2] for _, e in done)} with a flagged volume")
    volumes(done, missed)
    areas(done, missed)
    coverage(done, missed)
    return missed
