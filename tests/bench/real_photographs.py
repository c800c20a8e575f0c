"""Real photographs: Striae beside a plain numpy FTP + scikit-image on the same pixels, in the same run.

david_bust/left.png: depth against two-camera stereo; the peer's whole number of stripes is the one that fits the truth
best (Striae has to find it). lens_fringes: one frame's phase against the four-step phase of all four frames. Both are
judged on the pixels that both have, and each on its own."""
import argparse
import json
import os
import tempfile

import numpy as np

from surfaces import must_run, plain_phase, read_points, skip


def rotation(rodrigues):
    angle = np.linalg.norm(rodrigues)
    if angle == 0:
        return np.eye(3)
    x, y, z = np.asarray(rodrigues) / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def depth_of(order, calibration):
    """Where each pixel's ray meets the plane of its stripe order (pinhole, no distortion: the photograph has none)."""
    camera, projector = calibration["camera"], calibration["projector"]
    rows, cols = np.mgrid[: order.shape[0], : order.shape[1]]
    ray = np.stack([(cols - camera["cx"]) / camera["fx"], (rows - camera["cy"]) / camera["fy"], np.ones(order.shape)], -1)
    turn = rotation(projector["rotation_rodrigues"])
    b = (order - projector["center_order"]) / projector["focal_stripes"]
    normal = turn[1] - b[..., None] * turn[2]  # q.y = b q.z
    return (normal @ np.asarray(projector["center_mm"])) / np.sum(normal * ray, -1)


def figures(name, errors, share):
    e = np.abs(errors)
    print(f"  {name:42} median {np.median(e):7.4f}  90th percentile {np.percentile(e, 90):8.3f}  "
          f"rms {np.sqrt(np.mean(e**2)):7.3f}  on {100 * share:5.1f} %")


def david(striae, data):
    from PIL import Image
    folder = os.path.join(data, "david_bust")
    calibration = json.load(open(os.path.join(folder, "left.json")))
    truth = read_points(os.path.join(folder, "truth_left.ply"))
    with tempfile.TemporaryDirectory() as out:
        ply = os.path.join(out, "s.ply")
        report = json.loads(must_run([striae, "reconstruct", os.path.join(folder, "left.png"), "--calibration",
                                      os.path.join(folder, "left.json"), "--out", ply, "--json"])[4])
        points = read_points(ply)
    grey = np.asarray(Image.open(os.path.join(folder, "left.png")).convert("L"), dtype=float)
    ours = np.full(grey.shape, np.nan)
    ours[points["row"], points["col"]] = points["z"]
    phase, _ = plain_phase(grey.T, report["carrier_period_px"])
    order = np.where(np.ma.getmaskarray(phase), np.nan, phase.filled(0)).T / (2 * np.pi)
    camera = calibration["camera"]
    col = np.round(camera["fx"] * truth["x"] / truth["z"] + camera["cx"]).astype(int)
    row = np.round(camera["fy"] * truth["y"] / truth["z"] + camera["cy"]).astype(int)
    inside = (col >= 0) & (row >= 0) & (col < grey.shape[1]) & (row < grey.shape[0])
    col, row, z = col[inside], row[inside], truth["z"][inside]
    best = None
    for whole in range(-5, 40):
        errors = depth_of(order + whole, calibration)[row, col] - z
        if best is None or np.nanmedian(np.abs(errors)) < np.nanmedian(np.abs(best)):
            best = errors
    mine = ours[row, col] - z
    print("david_bust, depth against stereo, mm:")
    both = np.isfinite(best) & np.isfinite(mine)
    figures("Striae", mine[np.isfinite(mine)], np.isfinite(mine).mean())
    figures("numpy FTP + scikit-image, its best order", best[np.isfinite(best)], np.isfinite(best).mean())
    figures("Striae, pixels of both", mine[both], both.mean())
    figures("numpy FTP + scikit-image, pixels of both", best[both], both.mean())


def lens(striae, data):
    from PIL import Image
    folder = os.path.join(data, "lens_fringes")
    frames = [np.asarray(Image.open(os.path.join(folder, f"lens_crop_{k:03}.jpg")).convert("L"), dtype=float) for k in (0, 90, 180, 270)]
    truth = np.arctan2(frames[1] - frames[3], frames[0] - frames[2])
    with tempfile.TemporaryDirectory() as out:
        tiff = os.path.join(out, "phase.tiff")
        report = json.loads(must_run([striae, "phase", os.path.join(folder, "lens_crop_000.jpg"), "--out", tiff, "--json"])[4])
        ours = np.asarray(Image.open(tiff), dtype=float)
    peer, _ = plain_phase(frames[0].T, report["carrier_period_px"])
    peer = np.where(np.ma.getmaskarray(peer), np.nan, peer.filled(0)).T

    def errors(phase, where):
        """Up to one constant, which is the median's on the pixels `where`."""
        turned = np.exp(1j * (phase - truth))
        turned *= np.conj(turned[where].mean() / abs(turned[where].mean()))
        return np.angle(turned * np.exp(-1j * np.median(np.angle(turned[where]))))

    both = np.isfinite(ours) & np.isfinite(peer)
    a, b = errors(ours, np.isfinite(ours)), errors(peer, np.isfinite(peer))
    print("lens_fringes, phase of one frame against the four-step phase, rad:")
    figures("Striae", a[np.isfinite(a)], np.isfinite(a).mean())
    figures("numpy FTP + scikit-image", b[np.isfinite(b)], np.isfinite(b).mean())
    figures("Striae, pixels of both", errors(ours, both)[both], both.mean())
    figures("numpy FTP + scikit-image, pixels of both", errors(peer, both)[both], both.mean())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--striae", required=True)
    parser.add_argument("--data", required=True)
    options = parser.parse_args()
    if not os.path.exists(os.path.join(options.data, "david_bust", "left.png")):
        skip(f"no real photographs in {options.data}")
    try:
        import skimage.restoration  # noqa: F401
    except ImportError:
        skip("no scikit-image (Debian: python3-skimage)")
    david(options.striae, options.data)
    lens(options.striae, options.data)


if __name__ == "__main__":
    main()
