"""Scenes of the head table: pairs of photographs whose true rotation is known, and the rig that takes them.

Photographs and surfaces are made once and kept in the cache folder; what is measured on them is not."""
import hashlib
import json
import os
import shutil

import numpy as np

import head_bodies
from surfaces import must_run, run

PIVOT_MM = np.array([0, -55.0, 2000])  # as the procedural bust's: the light's upper edge crosses the forehead


class Rig:
    """A rig that the code knows only by its own calibration: off the nominal one as another workshop's would be.
    `known`: the code is given the true rig instead."""

    def __init__(self, camera, cache, seed, known=False):
        self.camera, self.folder = camera, os.path.join(cache, f"rig{seed}" + ("known" if known else ""))
        self.true = os.path.join(self.folder, "true.json")
        self.own = self.true if known else os.path.join(self.folder, "own.json")
        os.makedirs(self.folder, exist_ok=True)
        if os.path.exists(self.own):
            return
        random = np.random.default_rng(seed)
        off = lambda most: float(random.uniform(-most, most))
        focal, center = 1 + off(0.01), [3.8 + off(5), -109.4 + off(5), 44.7 + off(5)]
        json.dump({"format": "striae-calibration/1", "image_size": [4288, 2848],
                   "camera": {"fx": 9331.7 * focal, "fy": 9328.2 * focal, "cx": 2155 + off(25), "cy": 1415 + off(25),
                              "k1": -0.043 + off(0.03), "k2": 0.03 + off(0.03), "p1": off(2e-4), "p2": off(2e-4)},
                   "projector": {"model": "pinhole", "center_mm": center,
                                 "rotation_rodrigues": [float(np.arctan2(-center[1], 2000 - center[2])) + off(0.0035),
                                                        0.0041 + off(0.0035), -0.0027 + off(0.0035)],
                                 "focal_stripes": 259.6 * (1 + off(0.02)), "center_order": 32.87 + off(1.5), "k1": -0.019 + off(0.015)},
                   "grating": {"stripes": 67, "direction": "horizontal"}, "working_distance_mm": [1700, 2300]}, open(self.true, "w"))
        if known:
            return
        steps = os.path.join(self.folder, "steps")
        must_run([camera, "simulate", "steps", "--out", steps, "--range", "large", "--rig", self.true, "--steps", 7, "--step-mm", 50])
        must_run([camera, "calibrate", "--reference", f"{steps}/reference.ply", "--steps", f"{steps}/steps.csv", "--stripes", 67,
                  "--period-um", 97, "--distance-mm", 1850, "--out", self.own, "--json"])
        shutil.rmtree(steps)


def reconstruct(camera, image, calibration, ply):
    """The surface of a photograph, or None where that fails (its reason is kept beside it)."""
    if not os.path.exists(ply) and not os.path.exists(ply + ".failed"):
        if run([camera, "reconstruct", image, "--calibration", calibration, "--out", ply, "--no-faces", "--json"])[3] != 0:
            open(ply + ".failed", "w").close()
    return ply if os.path.exists(ply) else None


class Capture:
    """A photograph taken (or kept) of a scene: its surface's path and the true rotations of torso and head."""

    def __init__(self, ply, torso, head):
        self.ply, self.torso, self.head = ply, torso, head  # head: against the torso, camera axes of a square subject


class Studio:
    """Takes photographs with one rig; names them by what they show."""

    def __init__(self, camera, cache, rig):
        self.camera, self.cache, self.rig = camera, cache, rig

    def _photograph(self, key, command, name):
        """Runs `command` into a folder, keeps the photograph, returns the surface's path (None if it failed)."""
        folder = os.path.join(self.rig.folder, hashlib.sha256(key.encode()).hexdigest()[:16])
        photograph = os.path.join(folder, "photograph.jpg")
        if not os.path.exists(photograph):
            os.makedirs(folder, exist_ok=True)
            scene = os.path.join(folder, "scene")
            must_run([self.camera, "simulate", *command(folder), "--out", scene, "--rig", self.rig.true])
            os.replace(os.path.join(scene, name + ".jpg"), photograph)
            shutil.rmtree(scene)
            open(os.path.join(folder, "scene.txt"), "w").write(key + "\n")
        return reconstruct(self.camera, photograph, self.rig.own, os.path.join(folder, "surface.ply"))

    def bust(self, pose, held, noise, hair="none", shirt="none", more=()):
        """The procedural bust. `pose`, `held` (torso): yaw, pitch, roll in the program's signs; `held` with a shift."""
        options = [f"--yaw={pose[0]}", f"--pitch={pose[1]}", f"--roll={pose[2]}", f"--torso-yaw={held[0]}", f"--torso-pitch={held[1]}",
                   f"--torso-roll={held[2]}", "--torso-shift", *held[3:], "--hair", hair, "--shirt", shirt, "--seed", noise, *more]
        options = [str(o) for o in options]
        ply = self._photograph("bust " + " ".join(options), lambda folder: ["bust", *options], "pose")
        return Capture(ply, from_pose(*held[:3]), from_pose(*pose))

    def body(self, body, name, pose, held, noise, **life):
        """A body of head_bodies; `life`: its breath, shrug, mouth and hair."""
        torso, head = from_pose(*held[:3]), from_pose(*pose)

        def command(folder):
            points, colours = body.posed(head, np.random.default_rng(noise), **life)
            path = os.path.join(folder, "body.obj")
            head_bodies.write_obj(path, points @ torso.T + PIVOT_MM + held[3:], colours, body.faces)
            return ["mesh", path, "--range", "large", "--in-camera", "--seed", str(noise)]

        key = f"{name} {pose} {held} {noise} {sorted(life.items())}"
        return Capture(self._photograph(key, command, "mesh"), torso, head)


def from_pose(yaw, pitch, roll):
    """As `striae simulate`: R = Rz(roll) Ry(yaw) Rx(pitch) in camera axes, positive to the subject's right, chin down, to
    the subject's left."""
    turn = lambda axis, deg: head_bodies.rotation_from_vector(np.radians(deg) * np.eye(3)[axis])
    return turn(2, roll) @ turn(1, yaw) @ turn(0, pitch)


def truth(neutral, pose):
    """What rotation_matrix should be: R = R_torso^T R_head in the neutral capture's camera frame."""
    torso = pose.torso @ neutral.torso.T
    head = pose.torso @ pose.head @ neutral.head.T @ neutral.torso.T
    return torso.T @ head
